"""Where the parts of a program come from: the files named in it, and the same under other names.

A program says of every part which file it came from, as its author's shell named that file. Under
names that depend on no shell the same specs give the same bytes, wherever they lie.
"""

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any, Final, TypeVar

from runtime.program import Origin

Part = TypeVar("Part")

PLACE: Final = "origin"
"""The field of every part that holds `file:line:column`, or is empty."""


def files_named(part: Any) -> Iterator[str]:
    """Every file that a program, an architecture or a scenario says it was made of, as named."""
    if isinstance(part, tuple):
        for each in part:
            yield from files_named(each)
    elif isinstance(part, Origin):
        yield part.file
    elif _has_parts(part):
        for field in dataclasses.fields(part):
            value = getattr(part, field.name)
            if field.name == PLACE and value:
                yield _split(value)[0]
            else:
                yield from files_named(value)


def renamed(part: Part, name_of: Callable[[str], str]) -> Part:
    """The same program, architecture or scenario with other names of its files."""
    changed: Any = part
    if isinstance(part, tuple):
        changed = tuple(renamed(each, name_of) for each in part)
    elif isinstance(part, Origin):
        changed = dataclasses.replace(part, file=name_of(part.file))
    elif _has_parts(part):
        changed = _with_parts(part, name_of)
    return changed  # type: ignore[no-any-return]


def _with_parts(part: Any, name_of: Callable[[str], str]) -> Any:
    new: dict[str, Any] = {}
    for field in dataclasses.fields(part):
        value = getattr(part, field.name)
        if field.name == PLACE and value:
            file, rest = _split(value)
            new[field.name] = name_of(file) + rest
        elif isinstance(value, tuple) or _has_parts(value):
            new[field.name] = renamed(value, name_of)
    return dataclasses.replace(part, **new)


def _has_parts(part: Any) -> bool:
    return dataclasses.is_dataclass(part) and not isinstance(part, type)


def _split(origin: str) -> tuple[str, str]:
    """`file:line:column` as the file and the rest."""
    file, line, column = origin.rsplit(":", 2)
    return file, f":{line}:{column}"
