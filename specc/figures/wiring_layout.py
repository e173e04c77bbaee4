"""Where boxes, ports and wires of an architecture stand: floors above one another, lanes between.

Between two floors is a gap in which wires run along lanes; a net has one lane in each gap where it
ends, and an upright trunk beside the floors joins them. Ports above a box stand on even columns
and those below on odd ones, so that no two uprights of a gap lie on each other. All in inches, y
upwards.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import networkx as nx

from specc.figures.wiring_heights import Columns, raised
from specc.figures.wiring_plan import (
    BETWEEN,
    COLUMN,
    End,
    Plan,
    box_width,
    claim_slot,
    eyes_width,
    mouth_width,
    names_width,
    slot,
    span_of,
)
from specc.wired import Box, Sort, Wired

SWEEPS: Final = 6
TRUNK: Final = 0.11


def plan_of(wired: Wired) -> Plan:
    """Lay an architecture out."""
    floors = _ordered(wired)
    beside = names_width(wired)
    left = eyes_width(wired) + 0.25 + TRUNK * _readings(wired) + beside
    widths = [_row_width([box_width(box) for box in floor]) for floor in floors]
    mouths_width = _row_width([mouth_width(mouth) for mouth in wired.mouths])
    inner = max([mouths_width, *widths])
    xs: dict[tuple[str, str, str], float] = {}
    spots: dict[str, tuple[float, float]] = {}
    for floor, width in zip(floors, widths, strict=True):
        at = left + 0.5 * (inner - width)
        for box in floor:
            spots[box.name] = (at, box_width(box))
            xs |= _ports_of_box(box, at)
            at += box_width(box) + BETWEEN
    at = left + 0.5 * (inner - mouths_width)
    for mouth in wired.mouths:
        spots[f"/{mouth.name}"] = (at, mouth_width(mouth))
        names = [(port.name, claim_slot(port)) for port in mouth.claims]
        xs |= _ports(mouth.name, "above", names, at, mouth_width(mouth), 0)
        at += mouth_width(mouth) + BETWEEN
    ends = _ends(wired, xs)
    trunk_x = _trunks(wired, ends, left - beside, left + inner + 0.15)
    lanes, counts = _lanes(wired, ends, trunk_x, xs, len(floors) + 1)
    columns = Columns(floors, spots, xs, ends, trunk_x, lanes, counts, (left, inner))
    return raised(wired, columns)


def _row_width(widths: Sequence[float]) -> float:
    return sum(widths) + BETWEEN * max(len(widths) - 1, 0)


def _readings(wired: Wired) -> int:
    return sum(net.sort is Sort.READING for net in wired.nets)


def _ordered(wired: Wired) -> list[list[Box]]:
    """The boxes of each level, so that those that are wired stand near one another.

    Each is moved to the middle of its neighbours on other floors, a few times (Sugiyama 1981).
    """
    graph = nx.Graph()
    graph.add_nodes_from(box.name for box in wired.boxes)
    for net in wired.nets:
        for target in net.targets:
            if {net.source[0], target[0]} <= set(graph):
                graph.add_edge(net.source[0], target[0])
    top = max(box.level for box in wired.boxes)
    floors = [[box for box in wired.boxes if box.level == level] for level in range(top + 1)]
    for sweep in range(SWEEPS):
        at = {
            box.name: (place + 0.5) / len(floor)
            for floor in floors
            for place, box in enumerate(floor)
        }
        floor = floors[(sweep + 1) % len(floors)]
        others = {box.name for box in floor}

        def middle(box: Box, at: dict[str, float] = at, others: set[str] = others) -> float:
            near = [at[name] for name in graph[box.name] if name not in others]
            return sum(near) / len(near) if near else at[box.name]

        floor.sort(key=middle)
    return floors


def _ports_of_box(box: Box, at: float) -> dict[tuple[str, str, str], float]:
    width = box_width(box)
    above = [(port.name, slot(port)) for port in (*box.controls, *box.outputs)]
    below = [(port.name, slot(port)) for port in (*box.senses, *box.tells)]
    return _ports(box.name, "above", above, at, width, 0) | _ports(
        box.name, "below", below, at, width, 1
    )


def _ports(
    box: str, side: str, names: list[tuple[str, float]], at: float, width: float, odd: int
) -> dict[tuple[str, str, str], float]:
    """The x of ports that share the width of a box."""
    spare = (width - sum(need for _, need in names)) / max(len(names), 1)
    found = {}
    for name, need in names:
        middle = at + 0.5 * (need + spare)
        found[box, side, name] = COLUMN * (2 * round(0.5 * (middle / COLUMN - odd)) + odd)
        at += need + spare
    return found


def _ends(wired: Wired, xs: Mapping[tuple[str, str, str], float]) -> list[list[End]]:
    """For each net where it ends; the sensor of a reading is not among these."""
    level = {box.name: box.level for box in wired.boxes}

    def end(box: str, name: str, *, target: bool, to_mouth: bool) -> End:
        if to_mouth:
            return End(0, (box, "above", name), target)
        above = (box, "above", name) in xs and not (not target and (box, "below", name) in xs)
        return End(level[box] + above, (box, "above" if above else "below", name), target)

    found = []
    for net in wired.nets:
        ends = []
        if net.sort is not Sort.READING:
            ends.append(end(*net.source, target=False, to_mouth=False))
        to_mouth = net.sort is Sort.COMMAND
        ends += [end(*target, target=True, to_mouth=to_mouth) for target in net.targets]
        found.append([e for e in ends if e.port in xs])
    return found


def _trunks(
    wired: Wired, ends: Sequence[Sequence[End]], left: float, right: float
) -> dict[int, float]:
    """The x of the trunk of each net that has one: readings left, others right."""
    found: dict[int, float] = {}
    readings = others = 0
    for index, net in enumerate(wired.nets):
        if net.sort is Sort.READING:
            found[index] = left - TRUNK * (_readings(wired) - readings)
            readings += 1
        elif len({end.gap for end in ends[index]}) > 1:
            found[index] = right + TRUNK * others
            others += 1
    return found


def _lanes(
    wired: Wired,
    ends: Sequence[Sequence[End]],
    trunk_x: Mapping[int, float],
    xs: Mapping[tuple[str, str, str], float],
    gaps: int,
) -> tuple[dict[tuple[int, int], int], list[int]]:
    """The lane of each net in each gap, from below, and how many lanes each gap has.

    Nets that do not lie side by side share a lane: the colours of a graph of intervals.
    """
    lanes: dict[tuple[int, int], int] = {}
    counts = [0] * gaps
    for gap in range(gaps):
        for sorts in ({Sort.COMMAND, Sort.CHOICE}, {Sort.OUTPUT}, {Sort.READING}):
            spans = {
                index: span_of(index, gap, ends, trunk_x, xs)
                for index, net in enumerate(wired.nets)
                if net.sort in sorts and any(end.gap == gap for end in ends[index])
            }
            order = sorted(spans, key=lambda index: (spans[index], index))
            colors = nx.greedy_color(_beside(spans), lambda _graph, _colors, o=order: o)
            for index in order:
                lanes[index, gap] = counts[gap] + colors[index]
            counts[gap] += max(colors.values(), default=-1) + 1
    return lanes, counts


def _beside(spans: Mapping[int, tuple[float, float]]) -> nx.Graph:
    """Which nets cannot share a lane."""
    graph = nx.Graph()
    graph.add_nodes_from(spans)
    graph.add_edges_from(
        (a, b)
        for a in spans
        for b in spans
        if a < b and spans[a][0] < spans[b][1] + 0.1 and spans[b][0] < spans[a][1] + 0.1
    )
    return graph
