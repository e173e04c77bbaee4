"""From a design to one field of the frame: every blank filled.

The field is a sum of coefficients of controls times vectors that depend on the place alone, so
that only what moves within the frame costs the tables an axis.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from compiler.sketch.algebra import over, with_constants
from compiler.sketch.blend import Blend
from compiler.sketch.curves import Curve, curve_through
from compiler.sketch.design import Design, Family, Node, Region, Ring
from compiler.sketch.drawing import Arrow, Orbit, Pair
from compiler.sketch.frame import Frame, Spot
from compiler.sketch.models import (
    ArrowModel,
    FarModel,
    Heading,
    Model,
    NodeModel,
)
from compiler.sketch.ridges import ridge_through
from compiler.sketch.rings import CollarModel, HollowModel, RingModel
from runtime.arrays import Array
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Apply, Expr, Number

POWERS: Final = (4.0, 6.0, 3.0)
REACHES: Final = (2.5, 4.0, 1.8)
CANDIDATES: Final = tuple(zip(POWERS, REACHES, strict=True))
"""How quickly features fade, and how far out the far field begins: ways to fill, best first."""
MOST_CORNERED: Final = 6
"""Of so many controls that times depend on, all corners are looked at."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Filled:
    """The field of a frame: `coefficients` times `vectors(q, settings)` (N, B, 2), 1/s."""

    frame: Frame
    blend: Blend
    controls: tuple[str, ...]

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The coefficients, with numbers for constants."""
        return tuple(with_constants(c, self.frame.constants) for c in self.blend.coefficients)

    def vectors(self, q: Array, settings: Mapping[str, Array]) -> Array:
        """The vectors (N, B, 2) at places (N, 2) of the frame."""
        return self.blend.parts(q, settings)


def filled(design: Design, candidate: int) -> Filled:
    """The design's field, in one of the ways to fill it."""
    power, away = CANDIDATES[candidate]
    builder = _Builder(design, power)
    models = builder.members(design.region)
    if len(models) > 1 and design.region.border is not None:
        sign = -1.0 if design.region.border == "inward" else 1.0
        models = (*models, FarModel(_pace(design), sign, away))
    blend = Blend((*models, *(builder.arrow(arrow) for arrow in design.arrows)), power)
    spots = [node.spot for node in design.nodes]
    spots += [design.frame.spot(arrow.at) for arrow in design.arrows]
    moving = {name for spot in spots for name in spot.controls}
    moving |= {name for node in design.nodes for name in _turning(builder, node)}
    return Filled(design.frame, blend, tuple(n for n in design.frame.box if n in moving))


def _turning(builder: "_Builder", node: Node) -> set[str]:
    headings = builder.headings(node)
    return {name for heading in headings or () for name in heading.controls}


def _pace(design: Design) -> Expr:
    """The rate of the far field: that of the first feature."""
    rates = [node.point.rates[0] for node in design.nodes]
    rates += [family.rings[-1].orbit.strength for family in design.families]
    return [*rates, *(ridge.line.rates[0] for ridge in design.ridges)][0]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Builder:
    """Models for the features of a design."""

    design: Design
    power: float

    def members(self, region: Region) -> tuple[Model, ...]:
        """The models of what stands side by side in a region."""
        return (
            *(self.node(node) for node in region.nodes),
            *(ridge_through(r.through, r.saddle, r.line.rates) for r in region.ridges),
            *(self.family(family) for family in region.families),
        )

    def node(self, node: Node) -> NodeModel:
        """The model of a fixed point."""
        point = node.point
        sign = -1.0 if point.kind == "attractor" else 1.0
        signs = (-1.0, 1.0) if point.kind == "saddle" else (sign, sign)
        return NodeModel(node.spot, signs, point.rates, self.headings(node), point.turns)

    def headings(self, node: Node) -> tuple[Heading, Heading] | None:
        """The directions of a point's two rates; None where all are alike."""
        point, frame = node.point, self.design.frame
        if point.directions is not None:
            first, second = (Heading(frame.vector(d)) for d in point.directions)
            return first, second
        if point.kind != "saddle":
            if point.turns is not None or point.rates[0] == point.rates[1]:
                return None
            return Heading(_axis(frame, 0)), Heading(_axis(frame, 1))
        if node.ends is None:
            return Heading(_axis(frame, 1)), Heading(_axis(frame, 0))
        start, end = (frame.spot(place) for place in node.ends)
        along, across = Heading(end, start), Heading(end, start, square=True)
        return (along, across) if node.inward else (across, along)

    def arrow(self, arrow: Arrow) -> ArrowModel:
        """The model of an arrow."""
        frame = self.design.frame
        first, second = (
            over(with_constants(go, frame.constants), half)
            for go, half in zip(arrow.go, frame.half, strict=True)
        )
        return ArrowModel(frame.spot(arrow.at), (first, second))

    def family(self, family: Family) -> Model:
        """The model of nested orbits, with what they hold."""
        curves = curves_of(family, self.design.frame)
        rings = RingModel(
            centre=family.centre,
            curves=curves,
            attracts=tuple(ring.orbit.attracts for ring in family.rings),
            strengths=tuple(ring.orbit.strength for ring in family.rings),
            paces=tuple(_paces(ring, self.design.frame) for ring in family.rings),
            core=None if family.core is None else self.node(family.core),
            turning=family.core is not None and bool(family.core.point.why),
        )
        if family.inside is None:
            return rings
        members = self.members(family.inside)
        return HollowModel(rings, Blend((CollarModel(rings), *members), self.power))


def curves_of(family: Family, frame: Frame) -> tuple[Curve, ...]:
    """The curves of a family; an added one runs between its neighbors."""
    found: list[Curve] = []
    for ring in family.rings:
        orbit = ring.orbit
        rays = ring.vertices - family.centre
        vertices = family.centre + ring.share * rays
        if ring.share < 1.0 and found:
            inner, outer = found[-1].radii(_angles(rays))[0], np.linalg.norm(rays, axis=-1)
            mean = inner + ring.share * (outer - inner)
            vertices = family.centre + rays * (mean / outer)[:, np.newaxis]
        rounding = orbit.rounding if orbit.is_polygon else None
        found.append(curve_through(vertices, family.centre, rounding, _examples(orbit, frame)))
    return tuple(found)


def _angles(rays: Array) -> Array:
    found: Array = np.arctan2(rays[:, 1], rays[:, 0])
    return found


def _axis(frame: Frame, axis: int) -> Spot:
    """The direction of an axis."""
    vector: Pair = (Number(1.0 - axis), Number(float(axis)))
    return frame.vector(vector)


def _examples(orbit: Orbit, frame: Frame) -> Array | None:
    """The times (S, V) of the edges, at samples and corners; None where a period is all."""
    if orbit.period is not None:
        return None
    edges = [with_constants(time, frame.constants) for time in edge_times(orbit)]
    reads = sorted({name for edge in edges for name in names_in(edge)})
    corners = product(*(frame.box[name] for name in reads[:MOST_CORNERED]))
    settings = [
        *frame.samples,
        *({**frame.samples[0], **dict(zip(reads, c, strict=False))} for c in corners),
    ]
    seconds = np.array([[evaluate(edge, values) for edge in edges] for values in settings])
    usable = np.all(np.isfinite(seconds) & (seconds > 0.0), axis=1)
    return seconds[usable]


def edge_times(orbit: Orbit) -> tuple[Expr, ...]:
    """The times of an orbit's edges, given or from its speed; of straight edges."""
    if orbit.speed is None:
        return orbit.times
    following = (*orbit.through[1:], orbit.through[0])
    return tuple(
        over(_length(a, b), orbit.speed) for a, b in zip(orbit.through, following, strict=True)
    )


def _length(a: Pair, b: Pair) -> Expr:
    first, second = (Apply("sub", (end, start)) for start, end in zip(a, b, strict=True))
    return Apply("hypot", (first, second))


def _paces(ring: Ring, frame: Frame) -> tuple[Expr, ...]:
    """The coefficients of the edges' angular speeds: one over the time of each, 1/s."""
    orbit = ring.orbit
    if orbit.period is not None:
        return (over(Number(1.0), orbit.period),) * len(ring.vertices)
    del frame
    return tuple(over(Number(1.0), t) for t in edge_times(orbit))
