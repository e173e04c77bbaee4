"""The orbits of a drawing as closed curves of the frame, and which is right around which."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from compiler.sketch.drawing import Drawing, Orbit
from compiler.sketch.frame import Frame, SketchRefusedError
from compiler.sketch.polygons import cross_each_other, crosses_itself, encloses
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
    curves = [_still(orbit, frame) for orbit in drawing.orbits]
    for orbit, curve in zip(drawing.orbits, curves, strict=True):
        if crosses_itself(curve):
            message = f"'{orbit.name}' crosses itself, and a trajectory never does"
            raise SketchRefusedError("S266", orbit.path, message, "sort its vertices")
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


def _parent(i: int, curves: Sequence[Array]) -> int:
    around = [j for j, curve in enumerate(curves) if j != i and encloses(curve, curves[i][0])]
    depth = {j: sum(encloses(other, curves[j][0]) for other in curves) for j in around}
    return max(around, key=lambda j: depth[j], default=-1)


def _still(orbit: Orbit, frame: Frame) -> Array:
    """The vertices (V, 2) of an orbit, whose shape must not depend on the controls."""
    spots = [frame.spot(pair) for pair in orbit.through]
    for i, spot in enumerate(spots):
        if spot.controls:
            message = (
                f"the shape of '{orbit.name}' changes with {', '.join(spot.controls)}: its box "
                "moves and stretches with the controls, and this vertex does not go along"
            )
            remedy = (
                "place it at a fixed share between the outermost places of the sketch: "
                "`x2 + 0.3*(x1 - x2)`"
            )
            raise SketchRefusedError("S265", (*orbit.path, "through", i), message, remedy)
    return np.stack([spot.at for spot in spots])
