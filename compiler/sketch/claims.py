"""What a sketch says of the topology of its field, as claims: each feature, and no other."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from compiler.declare import Declarations
from compiler.lower_parts import code_of
from compiler.sketch.algebra import plus, scaled, with_constants
from compiler.sketch.curves import Curve
from compiler.sketch.design import Design, Node, Ridge
from compiler.sketch.drawing import Orbit, Pair
from compiler.sketch.fill import curves_of, edge_times
from compiler.sketch.frame import Frame
from compiler.sketch.graphs import graph_through
from compiler.sketch.pacing import TURN
from runtime.arrays import Array
from runtime.claim import Claim, Place, Reach
from runtime.code import Code
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.tree import Expr
from spec_schema.load import Loaded
from spec_schema.places import Path

NEAR: Final = 0.05
"""How far a feature may be from where it was drawn, in half widths of the frame at the defaults."""
PERIOD_WITHIN: Final = 0.05
"""The share that a period may be off: where paces change, one hands over to the next smoothly."""
GRID: Final = 2_000
FEATURES: Final = {
    "attractor": "stable fixed point",
    "repeller": "repeller",
    "saddle": "saddle",
}
"""What each kind of point is called in claims."""
TURNING: Final = {"attractor": "stable focus", "repeller": "unstable focus"}
"""What an added point inside an orbit is called: it turns as the orbit does."""


def sketch_claims(design: Design, loaded: Loaded) -> tuple[Claim, ...]:
    """One claim for each feature, drawn or required, and that there is no other.

    Places are expressions of the controls, so the claims hold whatever those are set to.
    """

    def told(
        text: str,
        feature: str,
        path: Path,
        *,
        count: int = 1,
        places: tuple[Place, ...] = (),
        reaches: tuple[Reach, ...] = (),
        period: Code | None = None,
    ) -> Claim:
        return Claim(
            text=text,
            feature=feature,
            least=count,
            most=count,
            other=count == 0,
            places=places,
            reaches=reaches,
            period=period,
            period_within=PERIOD_WITHIN,
            share=None,
            goes_to="",
            called="",
            over=(),
            settings=(),
            sketched=True,
            origin=loaded.origin(path),
        )

    found = []
    for node in design.nodes:
        feature = FEATURES[node.point.kind]
        places = _places(node.point.at, design.frame)
        found.append(told(_sentence(node), feature, node.point.path, places=places))
    for ridge in design.ridges:
        saddle = design.frame.place(graph_through(ridge.through).nearest(ridge.saddle))
        places = _places(saddle, design.frame)
        found.append(told(_on_ridge(ridge), "saddle", ridge.line.path, places=places))
    for orbit, centre, curve in _orbits(design):
        feature = "stable cycle" if orbit.attracts else "unstable cycle"
        reaches = _reaches(centre, curve, design.frame)
        text = _named(f"one {feature}", orbit.name, orbit.why)
        period = None if orbit.why else code_of(_period(orbit))
        found.append(told(text, feature, orbit.path, reaches=reaches, period=period))
    rest = ("fixed point", "cycle")
    whole: Path = ("field", "sketch")
    return (*found, *(told(f"no other {feature}", feature, whole, count=0) for feature in rest))


def additions(design: Design, declared: Declarations) -> Iterator[str]:
    """What index theory demanded beside the drawing, a sentence for each, with the reason."""
    cores = [family.core for family in design.families]
    for node in design.nodes:
        point = node.point
        if point.why:
            turns = any(node is core for core in cores)
            feature = (TURNING if turns else FEATURES)[point.kind]
            at = _spelled(point.at, design.frame, declared)
            yield f"added: one {feature} '{point.name}' at {at}, because {point.why}"
    for orbit, _, _ in _orbits(design):
        if orbit.why:
            feature = "stable cycle" if orbit.attracts else "unstable cycle"
            yield f"added: one {feature} '{orbit.name}', because {orbit.why}"


def _spelled(at: Pair, frame: Frame, declared: Declarations) -> str:
    """A place in the user's units, at the controls' defaults."""
    found = []
    for name, expr in zip(frame.over, at, strict=True):
        unit = declared.variable(name).unit
        value = _now(with_constants(expr, frame.constants), frame) / unit.scale
        found.append(f"{name} = {value:.4g}" + ("" if unit.text == "1" else f" {unit.text}"))
    return ", ".join(found) + (" (at the controls' defaults)" if frame.moving else "")


def _sentence(node: Node) -> str:
    return _named(f"one {FEATURES[node.point.kind]}", node.point.name, node.point.why)


def _on_ridge(ridge: Ridge) -> str:
    return _named("one saddle", ridge.line.name, "")


def _named(what: str, name: str, why: str) -> str:
    return f"{what} ({name}; required: {why})" if why else f"{what} ({name})"


def _places(at: Pair, frame: Frame) -> tuple[Place, ...]:
    return tuple(
        Place(state, code_of(expr), NEAR * _now(half, frame))
        for state, expr, half in zip(frame.over, at, frame.half, strict=True)
    )


def _now(expr: Expr, frame: Frame) -> float:
    """The value at the controls' defaults."""
    return evaluate(expr, frame.samples[0])


def _orbits(design: Design) -> Iterator[tuple[Orbit, Array, Curve]]:
    for family in design.families:
        for ring, curve in zip(family.rings, curves_of(family, design.frame), strict=True):
            yield ring.orbit, family.centre, curve


def _reaches(centre: Array, curve: Curve, frame: Frame) -> tuple[Reach, ...]:
    theta = np.linspace(0.0, TURN, GRID)
    r, _ = curve.radii(theta)
    points = centre + r[:, np.newaxis] * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    low, high = frame.place(points.min(axis=0)), frame.place(points.max(axis=0))
    return tuple(
        Reach(state, code_of(a), code_of(b), NEAR * _now(half, frame))
        for state, a, b, half in zip(frame.over, low, high, frame.half, strict=True)
    )


def _period(orbit: Orbit) -> Expr:
    if orbit.period is not None:
        return orbit.period
    first, *others = edge_times(orbit)
    total = first
    for edge in others:
        total = plus(total, edge)
    return scaled(1.0, total)
