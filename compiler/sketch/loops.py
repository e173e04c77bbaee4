"""The orbits of a drawing as closed curves of the frame, and which is right around which."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from compiler.sketch.drawing import Drawing, Orbit
from compiler.sketch.frame import Frame, SketchRefusedError
from compiler.sketch.moving import refuse_moving
from compiler.sketch.polygons import cross_each_other, crosses_itself, encloses, repeated
from runtime.arrays import Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Loop:
    """An orbit in the frame, and the index of the orbit right around it (-1: none)."""

    orbit: Orbit
    vertices: Array
    parent: int


def loops_of(drawing: Drawing, frame: Frame) -> list[Loop]:
    """The orbits in the frame, with what is right around each.

    Raises:
        SketchRefusedError: one crosses itself or another, or changes its shape with the controls.
    """
    curves = [_still(orbit, drawing, frame) for orbit in drawing.orbits]
    for orbit, curve in zip(drawing.orbits, curves, strict=True):
        again = repeated(curve)
        if again is not None:
            raise _repeated(orbit, curve, again)
        if crosses_itself(curve):
            message = f"'{orbit.name}' crosses itself, and a trajectory never does"
            remedy = "write its vertices in the order in which they are passed"
            raise SketchRefusedError("S266", orbit.path, message, remedy)
    for i, first in enumerate(curves):
        for j in range(i):
            if cross_each_other(first, curves[j]):
                names = f"'{drawing.orbits[j].name}' and '{drawing.orbits[i].name}'"
                message = f"{names} cross: two trajectories would go through one point"
                remedy = "draw one of them inside or beside the other"
                raise SketchRefusedError("S266", drawing.orbits[i].path, message, remedy)
    return [
        Loop(orbit, curve, _parent(i, curves))
        for i, (orbit, curve) in enumerate(zip(drawing.orbits, curves, strict=True))
    ]


def _repeated(orbit: Orbit, curve: Array, again: int) -> SketchRefusedError:
    """The error about a vertex that stands twice."""
    first = next(i for i in range(again) if np.allclose(curve[i], curve[again], atol=1e-9))
    closes = first == 0 and again == len(curve) - 1
    why = ": an orbit closes by itself" if closes else ""
    message = f"'{orbit.name}' has this vertex twice: it repeats number {first + 1}{why}"
    path = (*orbit.path, "through", again)
    return SketchRefusedError("S266", path, message, "remove one of them")


def _parent(i: int, curves: Sequence[Array]) -> int:
    around = [j for j, curve in enumerate(curves) if j != i and encloses(curve, curves[i][0])]
    depth = {j: sum(encloses(other, curves[j][0]) for other in curves) for j in around}
    return max(around, key=lambda j: depth[j], default=-1)


def _still(orbit: Orbit, drawing: Drawing, frame: Frame) -> Array:
    """The vertices (V, 2) of an orbit, whose shape must not depend on the controls."""
    for i, pair in enumerate(orbit.through):
        refuse_moving(
            f"this vertex of '{orbit.name}'", pair, (*orbit.path, "through", i), drawing, frame
        )
    return np.stack([frame.spot(pair).at for pair in orbit.through])
