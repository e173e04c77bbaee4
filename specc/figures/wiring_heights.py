"""The heights of a wiring: floors above one another, with gaps for lanes between."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, final

from specc.figures.wiring_plan import (
    ROW,
    End,
    Frame,
    Place,
    Plan,
    Run,
    Trunk,
    box_height,
    eyes_width,
    span_of,
)
from specc.wired import Box, Eye, Wired

LANE: Final = 0.13
MARGIN: Final = 0.24
"""Between a floor and its nearest lane."""
APART: Final = 0.05
"""Between the line of a reading from its sensor and any lane, at least."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Columns:
    """Everything but heights.

    floors: boxes from below. spots: x and width of each box, and of each channel as `/name`.
    lanes: of (net, gap). counts: lanes of each gap. inside: x and width of the floors.
    """

    floors: Sequence[Sequence[Box]]
    spots: Mapping[str, Place]
    xs: Mapping[tuple[str, str, str], float]
    ends: Sequence[Sequence[End]]
    trunk_x: Mapping[int, float]
    lanes: Mapping[tuple[int, int], int]
    counts: Sequence[int]
    inside: Place


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Storeys:
    """Heights: of channels, boxes and the grounds of floors, where lanes begin, and of all."""

    mouths: Mapping[str, Frame]
    boxes: Mapping[str, Frame]
    bands: tuple[Frame, ...]
    starts: tuple[float, ...]
    height: float


def raised(wired: Wired, columns: Columns) -> Plan:
    """From columns and lanes to heights, from below."""
    storeys = _storeys(wired, columns)
    ports = _standing(columns, storeys)
    eyes = _eyes(wired, storeys.height)
    runs = tuple(
        run for net in range(len(wired.nets)) for run in _runs(net, columns, storeys, ports)
    )
    exits = _exits(wired, eyes, sorted({run.y for run in runs}))
    trunks = tuple(
        _trunk(net, columns, runs, exits.get(wired.nets[net].source)) for net in columns.trunk_x
    )
    left, inner = columns.inside
    width = max([left + inner + 0.2, *(x + 0.1 for x in columns.trunk_x.values())])
    height = max([storeys.height, *(frame.y + frame.height for frame in eyes.values())])
    return Plan(
        width, height, storeys.boxes, storeys.mouths, eyes, storeys.bands, ports, runs, trunks,
        exits,
    )  # fmt: skip


def _storeys(wired: Wired, columns: Columns) -> _Storeys:
    """Channels at the bottom, then gaps and floors by turns."""
    y = ROW * 5 + 0.16
    left, inner = columns.inside
    spots, boxes = columns.spots, dict[str, Frame]()
    mouths = {m.name: Frame(spots[f"/{m.name}"][0], 0.0, spots[f"/{m.name}"][1], y)
              for m in wired.mouths}  # fmt: skip
    bands, starts = [], []
    for gap, count in enumerate(columns.counts):
        starts.append(y + MARGIN)
        is_top = gap == len(columns.floors)
        y += MARGIN * (1 if is_top and not count else 2) + LANE * max(count - 1, 0)
        if is_top:
            break
        height = max(box_height(box) for box in columns.floors[gap])
        for box in columns.floors[gap]:
            boxes[box.name] = Frame(spots[box.name][0], y, spots[box.name][1], height)
        bands.append(Frame(left - 0.12, y - 0.1, inner + 0.24, height + 0.2))
        y += height
    return _Storeys(mouths, boxes, tuple(bands), tuple(starts), y)


def _standing(columns: Columns, storeys: _Storeys) -> dict[tuple[str, str, str], Place]:
    """Where each port stands: on the upper or the lower edge of its box."""
    frames = {**storeys.mouths, **storeys.boxes}
    return {
        (box, side, name): (x, frames[box].y + frames[box].height * (side == "above"))
        for (box, side, name), x in columns.xs.items()
    }


def _runs(
    net: int,
    columns: Columns,
    storeys: _Storeys,
    ports: Mapping[tuple[str, str, str], Place],
) -> Iterator[Run]:
    """The lanes of a net, one in each gap where it ends."""
    for (index, gap), lane in columns.lanes.items():
        if index != net:
            continue
        here = [end for end in columns.ends[net] if end.gap == gap]
        left, right = span_of(net, gap, columns.ends, columns.trunk_x, columns.xs)
        joins = tuple(ports[end.port] for end in here)
        arrows = tuple(ports[end.port] for end in here if end.is_target)
        yield Run(net, storeys.starts[gap] + LANE * lane, left, right, joins, arrows)


def _trunk(index: int, columns: Columns, runs: Sequence[Run], start: Place | None) -> Trunk:
    """The upright that joins the lanes of a net; start: where it leaves a sensor."""
    heights = [run.y for run in runs if run.net == index]
    if start is not None:
        heights.append(start[1])
    return Trunk(index, columns.trunk_x[index], min(heights), max(heights), start)


def _eyes(wired: Wired, height: float) -> dict[str, Frame]:
    """Sensors at the left, in the middle of the height; those that nobody reads below."""
    order = sorted(wired.eyes, key=lambda eye: not eye.readings)
    sizes = [_eye_height(eye) for eye in order]
    gaps = [0.15 if eye.readings else 0.07 for eye in order[1:]]
    width = eyes_width(wired)
    total = sum(sizes) + sum(gaps)
    y = max(0.5 * (height + total), total)
    found = {}
    for eye, size, gap in zip(order, sizes, [0.0, *gaps], strict=True):
        y -= gap + size
        found[eye.name] = Frame(0.0, y, width, size)
    return found


def _eye_height(eye: Eye) -> float:
    return ROW * (2 + len(eye.readings)) + 0.16 if eye.readings else ROW + 0.1


def _exits(
    wired: Wired, eyes: Mapping[str, Frame], lanes: Sequence[float]
) -> dict[tuple[str, str], Place]:
    """Where readings leave their sensors: spread evenly, and then moved off the lanes."""
    found = {}
    for eye in wired.eyes:
        frame = eyes[eye.name]
        for row, name in enumerate(eye.readings):
            even = frame.y + frame.height * (1.0 - (row + 0.5) / len(eye.readings))
            found[eye.name, name] = (frame.x + frame.width, _off(even, lanes))
    return found


def _off(y: float, lanes: Sequence[float]) -> float:
    """The nearest height that no lane is too near to.

    >>> _off(1.0, [0.0, 2.0]), _off(1.01, [1.0, 2.0])
    (1.0, 1.05)
    """
    heights = [y, *(lane + side * APART for lane in lanes for side in (-1.0, 1.0))]
    free = [at for at in heights if all(abs(at - lane) > 0.999 * APART for lane in lanes)]
    return min(free, key=lambda at: abs(at - y), default=y)
