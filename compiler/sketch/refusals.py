"""What no field of the plane can look like: features outside of the domain, or in one place."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Final

import numpy as np

from compiler.declare import Declarations
from compiler.sketch.algebra import with_constants
from compiler.sketch.design import Node, Ridge
from compiler.sketch.drawing import Drawing, Orbit, Pair, Point
from compiler.sketch.frame import Frame, SketchRefusedError
from compiler.sketch.loops import Loop
from compiler.sketch.polygons import distance_to, encloses
from compiler.sketch.witness import at_setting, controls_in
from runtime.arrays import Array
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.tree import Expr
from spec_schema.places import Path

TOUCHING: Final = 1e-3
"""Half widths of the frame: features closer than this are in the same place."""
PARALLEL: Final = 1e-6
"""Directions of the frame with a smaller sine between them are one."""
ROUNDING: Final = 1e-12
"""Widths of a domain: a place that is beyond its end by less is on it."""
MOST_CORNERS: Final = 6
"""Of a place that reads more controls than this, not all corners of their domains are tried."""


def refuse_outside(drawing: Drawing, frame: Frame, declared: Declarations) -> None:
    """Refuse features outside of the domain, and times or rates that are not positive.

    Raises:
        SketchRefusedError: there is one.
    """
    for path, pair in drawing.spots:
        for name, expr in zip(drawing.over, pair, strict=True):
            _refuse_beyond(expr, name, path, frame, declared)
    for orbit in drawing.orbits:
        named = [("times", i) for i in range(len(orbit.times))] + [("period",), ("speed",)]
        paces: list[Expr | None] = [*orbit.times, orbit.period, orbit.speed]
        for steps, pace in zip(named, paces, strict=True):
            bad = None if pace is None else _first_not_positive(pace, frame)
            if pace is not None and bad is not None:
                message = f"this is not positive{at_setting([pace], bad, declared)}"
                remedy = "write a time that is always above 0"
                if steps == ("speed",):
                    remedy = "write a speed that is always above 0"
                raise SketchRefusedError("S261", (*orbit.path, *steps), message, remedy)


def _refuse_beyond(expr: Expr, name: str, path: Path, frame: Frame, declared: Declarations) -> None:
    """Refuse a coordinate that is outside of its state's domain somewhere."""
    state = declared.variable(name)
    slack = ROUNDING * (state.high - state.low)
    for setting in _tried(expr, frame, declared):
        value = _value(expr, setting, frame)
        if not state.low - slack <= value <= state.high + slack:
            unit = declared.units[name]
            at, low, high = (v / unit.scale for v in (value, state.low, state.high))
            message = (
                f"this place is outside the domain of '{name}'"
                f"{at_setting([expr], setting, declared)}: {at:.4g} is not in [{low:g}, {high:g}]"
                + ("" if unit.text == "1" else f" {unit.text}")
            )
            raise SketchRefusedError("S264", path, message, "move it inside, or widen the domain")


def _tried(expr: Expr, frame: Frame, declared: Declarations) -> Iterator[Mapping[str, float]]:
    """The defaults, settings at random, and the corners of the domains that `expr` reads."""
    yield from frame.samples
    reads = controls_in([expr], declared)
    ends = [frame.box[name] for name in reads] if len(reads) <= MOST_CORNERS else []
    for corner in product(*ends):
        yield {**frame.samples[0], **dict(zip(reads, corner, strict=False))}


def _first_not_positive(pace: Expr, frame: Frame) -> Mapping[str, float] | None:
    return next((s for s in frame.samples if not _value(pace, s, frame) > 0.0), None)


def _value(expr: Expr, setting: Mapping[str, float], frame: Frame) -> float:
    return evaluate(with_constants(expr, frame.constants), setting)


def refuse_flat_directions(drawing: Drawing, frame: Frame, declared: Declarations) -> None:
    """Refuse a direction that is zero, and two directions on one line.

    Raises:
        SketchRefusedError: a point has such directions.
    """
    for point in drawing.points:
        path = (*point.path, "directions")
        for k, direction in enumerate(point.directions or ()):
            for setting in frame.samples:
                if not np.any(_vector(direction, setting, frame)):
                    when = at_setting(direction, setting, declared)
                    message = f"this direction is zero{when}, and points nowhere"
                    remedy = "write a vector such as [1, 0]"
                    raise SketchRefusedError("S262", (*path, k), message, remedy)
        if point.directions is not None:
            _refuse_parallel(point.directions, path, frame, declared)


def _refuse_parallel(
    directions: tuple[Pair, Pair], path: Path, frame: Frame, declared: Declarations
) -> None:
    for setting in frame.samples:
        first, second = (_vector(direction, setting, frame) for direction in directions)
        area = abs(first[0] * second[1] - first[1] * second[0])
        if area < PARALLEL * np.linalg.norm(first) * np.linalg.norm(second):
            when = at_setting([*directions[0], *directions[1]], setting, declared)
            message = f"the two directions are parallel{when}, and a plane needs two"
            first_axis, second_axis = frame.over
            remedy = (
                f"write two that differ, such as [[1, 0], [0, 1]]: along '{first_axis}' and along "
                f"'{second_axis}'"
            )
            raise SketchRefusedError("S262", path, message, remedy)


def _vector(direction: Pair, setting: Mapping[str, float], frame: Frame) -> Array:
    """A direction (2,) in the frame."""
    return np.array([evaluate(expr, setting) for expr in frame.vector(direction).exprs])


def refuse_coincidences(
    nodes: Sequence[Node],
    ridges: Sequence[Ridge],
    loops: Sequence[Loop],
    frame: Frame,
    declared: Declarations,
) -> None:
    """Refuse two points in one place, a point on an orbit or that moves across one.

    Raises:
        SketchRefusedError: there is one; or a separatrix crosses an orbit.
    """
    for sample in frame.samples:
        places = [np.array([evaluate(e, sample) for e in node.spot.exprs]) for node in nodes]
        for i, (node, at) in enumerate(zip(nodes, places, strict=True)):
            for other, there in zip(nodes[:i], places[:i], strict=True):
                if np.linalg.norm(at - there) < TOUCHING:
                    both = [*node.point.at, *other.point.at]
                    when = at_setting(both, sample, declared)
                    raise _same_place(node.point, other.point, when)
            for loop in loops:
                inside = encloses(loop.vertices, node.spot.at)
                on_it = distance_to(loop.vertices, at) < TOUCHING
                if on_it or encloses(loop.vertices, at) != inside:
                    when = at_setting(node.point.at, sample, declared)
                    raise _on_orbit(node.point, loop.orbit, when, moves=not on_it)
    for ridge in ridges:
        for loop in loops:
            inner = {encloses(loop.vertices, at) for at in ridge.through}
            if len(inner) > 1:
                message = f"'{ridge.line.name}' and '{loop.orbit.name}' cross"
                remedy = "a separatrix ends before an orbit, or winds onto it: shorten it"
                raise SketchRefusedError("S266", ridge.line.path, message, remedy)


def _same_place(point: Point, other: Point, when: str) -> SketchRefusedError:
    message = f"'{point.name}' and '{other.name}' are in the same place{when}, or nearly so"
    remedy = f"keep them apart{' for all controls' if when else ''}, or remove one of them"
    return SketchRefusedError("S266", (*point.path, "at"), message, remedy)


def _on_orbit(point: Point, orbit: Orbit, when: str, *, moves: bool) -> SketchRefusedError:
    what = "has moved across" if moves else "lies on"
    message = f"'{point.name}' {what} '{orbit.name}'{when}, where nothing ever rests"
    remedy = f"place it inside or outside{', for all controls' if when else ''}"
    return SketchRefusedError("S266", (*point.path, "at"), message, remedy)
