"""The parts of a wiring's layout, and how large boxes are; all in inches, y upwards."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias, final

from specc.wired import Box, Mouth, Port

CHARACTER: Final = 0.0665
"""The width of a letter of a port's name."""
COLUMN: Final = 0.05
"""Ports stand on multiples of it."""
BETWEEN: Final = 0.28
"""Between two boxes of a floor."""
ROW: Final = 0.135
"""The height of a line within a box."""
EYE: Final = 1.95
"""The width of a sensor."""

Place: TypeAlias = tuple[float, float]


@final
@dataclass(frozen=True, slots=True)
class Frame:
    """A rectangle: its lower left corner and size."""

    x: float
    y: float
    width: float
    height: float


@final
@dataclass(frozen=True, slots=True)
class Run:
    """A net in one gap: its lane from `left` to `right`, and where uprights meet it.

    joins: (x, y) ends of uprights; an arrow stands at the end of those in `arrows`.
    """

    net: int
    y: float
    left: float
    right: float
    joins: tuple[Place, ...]
    arrows: tuple[Place, ...]


@final
@dataclass(frozen=True, slots=True)
class Trunk:
    """An upright beside the floors that joins the lanes of a net, from a sensor at `start`."""

    net: int
    x: float
    low: float
    high: float
    start: Place | None


@final
@dataclass(frozen=True, slots=True)
class Plan:
    """Where everything stands. ports: by (box, "above" or "below", name)."""

    width: float
    height: float
    boxes: Mapping[str, Frame]
    mouths: Mapping[str, Frame]
    eyes: Mapping[str, Frame]
    floors: tuple[Frame, ...]
    ports: Mapping[tuple[str, str, str], Place]
    runs: tuple[Run, ...]
    trunks: tuple[Trunk, ...]


def slot(port: Port) -> float:
    """The width that a port's texts need."""
    return CHARACTER * max(len(port.name), 0.85 * len(port.note), 2) + 0.16


def claim_slot(port: Port) -> float:
    """The width that a port of a channel needs: its rank and name stand beside one another."""
    return slot(Port(f"{port.note} {port.name}".strip()))


def box_width(box: Box) -> float:
    """Of a node's box."""
    head = max(0.085 * len(box.name), *(CHARACTER * len(t) for t in (box.what, box.clock)))
    notes = [CHARACTER * len(note) for note in box.notes]
    above = sum(slot(port) for port in (*box.controls, *box.outputs))
    below = sum(slot(port) for port in (*box.senses, *box.tells))
    return max(head + 0.2, above + 0.1, below + 0.1, *notes, 1.0)


def mouth_width(mouth: Mouth) -> float:
    """Of a channel's box."""
    texts = (mouth.name, f"◆ 9 reach it: {mouth.what}", f"at rest: {mouth.rest}")
    named = sum(claim_slot(port) for port in mouth.claims)
    return max(named + 0.1, *(CHARACTER * 1.15 * len(text) + 0.3 for text in texts))


def box_height(box: Box) -> float:
    """Of a node's box: two lines of ports above and below, three in the middle, and notes."""
    return ROW * (7 + len(box.notes)) + 0.24


@final
@dataclass(frozen=True, slots=True)
class End:
    """Where a net ends: the gap, the port, and whether an arrow stands there."""

    gap: int
    port: tuple[str, str, str]
    is_target: bool


def span_of(
    index: int,
    gap: int,
    ends: Sequence[Sequence[End]],
    trunk_x: Mapping[int, float],
    xs: Mapping[tuple[str, str, str], float],
) -> tuple[float, float]:
    """From where to where a net's lane goes in a gap."""
    points = [xs[end.port] for end in ends[index] if end.gap == gap]
    points += [trunk_x[index]] if index in trunk_x else []
    return min(points), max(points)
