"""What no field of the plane can look like: features outside of the domain, or in one place."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from compiler.declare import Declarations
from compiler.sketch.algebra import with_constants
from compiler.sketch.design import Node, Ridge
from compiler.sketch.drawing import Drawing, Orbit, Point
from compiler.sketch.frame import Frame, SketchRefusedError
from compiler.sketch.loops import Loop
from compiler.sketch.polygons import distance_to, encloses
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.tree import Expr

TOUCHING: Final = 1e-3
"""Half widths of the frame: features closer than this are in the same place."""


def refuse_outside(drawing: Drawing, frame: Frame, declared: Declarations) -> None:
    """Refuse features outside of the domain, and times or rates that are not positive.

    Raises:
        SketchRefusedError: there is one.
    """
    for path, pair in drawing.spots:
        for name, expr in zip(drawing.over, pair, strict=True):
            state = declared.variable(name)
            values = _values(expr, frame)
            if not (state.low <= min(values) and max(values) <= state.high):
                message = f"this place is outside the domain of '{name}' for some controls"
                remedy = "move it inside, or widen the domain"
                raise SketchRefusedError("S264", path, message, remedy)
    for orbit in drawing.orbits:
        named = [("times", i) for i in range(len(orbit.times))] + [("period",), ("speed",)]
        paces: list[Expr | None] = [*orbit.times, orbit.period, orbit.speed]
        for steps, pace in zip(named, paces, strict=True):
            if pace is not None and not min(_values(pace, frame)) > 0.0:
                message = "this is not positive for some controls"
                remedy = "write a time that is always above 0"
                raise SketchRefusedError("S261", (*orbit.path, *steps), message, remedy)


def _values(expr: Expr, frame: Frame) -> list[float]:
    return [evaluate(with_constants(expr, frame.constants), sample) for sample in frame.samples]


def refuse_coincidences(
    nodes: Sequence[Node], ridges: Sequence[Ridge], loops: Sequence[Loop], frame: Frame
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
                    raise _same_place(node.point, other.point)
            for loop in loops:
                inside = encloses(loop.vertices, node.spot.at)
                on_it = distance_to(loop.vertices, at) < TOUCHING
                if on_it or encloses(loop.vertices, at) != inside:
                    raise _on_orbit(node.point, loop.orbit, moves=not on_it)
    for ridge in ridges:
        for loop in loops:
            inner = {encloses(loop.vertices, at) for at in ridge.through}
            if len(inner) > 1:
                message = f"'{ridge.line.name}' and '{loop.orbit.name}' cross"
                remedy = "a separatrix ends before an orbit, or winds onto it: shorten it"
                raise SketchRefusedError("S266", ridge.line.path, message, remedy)


def _same_place(point: Point, other: Point) -> SketchRefusedError:
    message = f"'{point.name}' and '{other.name}' come to the same place for some controls"
    remedy = "keep them apart over the domains of the controls"
    return SketchRefusedError("S266", (*point.path, "at"), message, remedy)


def _on_orbit(point: Point, orbit: Orbit, *, moves: bool) -> SketchRefusedError:
    what = "moves across" if moves else "lies on"
    message = f"'{point.name}' {what} '{orbit.name}', where nothing ever rests"
    remedy = "place it inside or outside, for all controls"
    return SketchRefusedError("S266", (*point.path, "at"), message, remedy)
