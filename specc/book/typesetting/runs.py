"""A text of a chapter in runs of one kind: words, code, and links."""

import re
from dataclasses import dataclass
from typing import Final, final

PARTS: Final = re.compile(r"`(?P<code>[^`\n]+)`|\[(?P<words>[^\]\[\n]+)\]\((?P<target>[\w./-]+)\)")


@final
@dataclass(frozen=True, slots=True)
class Run:
    """Words of one kind. to: where they lead, empty for nowhere."""

    text: str
    code: bool = False
    to: str = ""


def runs_of(text: str) -> tuple[Run, ...]:
    """The runs of a text, in order.

    >>> [run.text for run in runs_of("see `x < 1` in [this](page)")]
    ['see ', 'x < 1', ' in ', 'this']
    """
    found, done = [], 0
    for part in PARTS.finditer(text):
        if part.start() > done:
            found.append(Run(text[done : part.start()]))
        done = part.end()
        if part["code"] is not None:
            found.append(Run(part["code"], code=True))
        else:
            inner = runs_of(part["words"])
            found += [Run(run.text, run.code, part["target"]) for run in inner]
    if done < len(text):
        found.append(Run(text[done:]))
    return tuple(found)
