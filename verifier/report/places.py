"""Places in a spec, `file:line:column`, taken apart for formats that want the parts."""

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True)
class Place:
    """A file and a place in it; line and column are 0 where the whole file is meant."""

    file: str
    line: int
    column: int


def place_of(origin: str) -> Place | None:
    """The place that `origin` names; None for an empty one.

    >>> place_of("specs/a.yaml:12:3"), place_of("C:/a.yaml:12:3").file, place_of("a.yaml").line
    (Place(file='specs/a.yaml', line=12, column=3), 'C:/a.yaml', 0)
    """
    if not origin:
        return None
    file, *numbers = origin.rsplit(":", 2)
    if len(numbers) == 2 and all(number.isdecimal() for number in numbers):
        return Place(file, int(numbers[0]), int(numbers[1]))
    return Place(origin, 0, 0)
