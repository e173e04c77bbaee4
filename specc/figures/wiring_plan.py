"""The parts of a wiring's layout, and how large boxes are; all in inches, y upwards."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias, final

from specc.figures.text_width import text_width
from specc.wired import Box, Eye, Mouth, Port, Sort, Wired

NAMED: Final = 9.5
"""Points: the size of a box's name."""
CHANNEL: Final = 9.0
"""Points: of a channel's."""
SENSOR: Final = 8.5
"""Points: of a sensor's."""
SMALL: Final = 7.0
"""Points: of the names of ports."""
TINY: Final = 6.0
"""Points: of what is noted of them."""
COLUMN: Final = 0.065
"""Ports stand on multiples of it."""
BETWEEN: Final = 0.28
"""Between two boxes of a floor."""
ROW: Final = 0.135
"""The height of a line within a box."""
NARROWEST: Final = 1.0
"""A box or a sensor is at least so wide."""

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
    """Where everything stands.

    ports: by (box, "above" or "below", name). exits: where readings leave, by (sensor, name).
    """

    width: float
    height: float
    boxes: Mapping[str, Frame]
    mouths: Mapping[str, Frame]
    eyes: Mapping[str, Frame]
    floors: tuple[Frame, ...]
    ports: Mapping[tuple[str, str, str], Place]
    runs: tuple[Run, ...]
    trunks: tuple[Trunk, ...]
    exits: Mapping[tuple[str, str], Place]


def slot(port: Port) -> float:
    """The width that a port's texts need."""
    return max(text_width(port.name, SMALL), text_width(port.note, TINY), 0.1) + 0.19


def claim_slot(port: Port) -> float:
    """The width that a port of a channel needs: its rank and name stand beside one another."""
    return text_width(claim_text(port), SMALL) + 0.2


def claim_text(port: Port) -> str:
    """What a port of a channel is called: `1. avoid`."""
    return f"{port.note} {port.name}".strip()


def box_width(box: Box) -> float:
    """Of a node's box."""
    small = [text_width(text, SMALL) for text in (box.what, box.clock, *box.notes)]
    above = sum(slot(port) for port in (*box.controls, *box.outputs))
    below = sum(slot(port) for port in (*box.senses, *box.tells))
    head = max(text_width(box.name, NAMED, bold=True), *small) + 0.2
    return max(head, above + 0.1, below + 0.1, NARROWEST)


def mouth_width(mouth: Mouth) -> float:
    """Of a channel's box."""
    texts = (
        text_width(mouth.name, CHANNEL, bold=True),
        text_width(how_resolved(mouth), SMALL),
        text_width(f"at rest: {mouth.rest}", TINY),
    )
    return max(sum(claim_slot(port) for port in mouth.claims) + 0.1, max(texts) + 0.3)


def how_resolved(mouth: Mouth) -> str:
    """What a channel's box says of those that reach it."""
    return f"◆ {len(mouth.claims)} reach it: {mouth.what}" if mouth.is_contested else mouth.what


def eyes_width(wired: Wired) -> float:
    """Of the column of sensors: names and notes at the left, readings at the right; 0 of none."""
    widths = (_left_of(eye) + _right_of(eye) + 0.34 for eye in wired.eyes)
    return max([NARROWEST, *widths]) if wired.eyes else 0.0


def _left_of(eye: Eye) -> float:
    name = text_width(eye.name, SENSOR, bold=True)
    if not eye.readings:
        return name
    return max(name, text_width(eye.what, TINY), text_width(eye.clock, TINY))


def _right_of(eye: Eye) -> float:
    if not eye.readings:
        return text_width(unread_text(eye), TINY)
    return max(text_width(name, SMALL) for name in eye.readings)


def unread_text(eye: Eye) -> str:
    """What is said of a sensor that no node reads."""
    return f"{eye.what}, unread"


def names_width(wired: Wired) -> float:
    """Of the names of readings, left of the floors; 0 of none."""
    names = [".".join(net.source) for net in wired.nets if net.sort is Sort.READING]
    return max((text_width(name, TINY) for name in names), default=-0.28) + 0.28


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
