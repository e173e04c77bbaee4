"""The first body, arbiter, architecture, world and scenarios: each with all that it names."""

import re
from importlib.resources.abc import Traversable
from posixpath import basename, dirname, join, normpath
from typing import Final

FIRST: Final = {
    "scenario": "scenarios/first_light.yaml",
    "training": "scenarios/first_training.yaml",
    "architecture": "architectures/find_light.yaml",
    "body": "bodies/courier.yaml",
    "arbiter": "arbiters/safe_first.yaml",
    "world": "worlds/office.yaml",
}
"""By template the spec of the library that one begins with: one of each kind, one that trains."""

NEXT: Final = {
    "scenario": "specc check {0}; specc simulate {0}",
    "training": "specc check {0}; specc train {0} -n 600 -o learnt",
    "architecture": "specc check {0}; specc wiring {0}",
}
"""What one does with a new spec where there is more to do than to check it."""

_NAMED: Final = re.compile(r"(?<=[\s:{,])[\w./]+\.yaml")


def set_of(template: str, library: Traversable) -> dict[str, str]:
    """The first spec of a template, then all that it names, by file name and side by side."""
    found: dict[str, str] = {}
    wanted = [FIRST[template]]
    while wanted:
        place = wanted.pop(0)
        if basename(place) in found:
            continue
        text = library.joinpath(place).read_text(encoding="utf-8")
        lines = [line for line in text.splitlines(keepends=True) if not line.startswith("#")]
        text = "".join(lines)
        wanted += [normpath(join(dirname(place), name)) for name in _NAMED.findall(text)]
        found[basename(place)] = _NAMED.sub(lambda match: basename(match[0]), text)
    return found
