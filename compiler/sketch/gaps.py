"""How close nested orbits come: what makes the table of a sketch large."""

from itertools import pairwise

import numpy as np

from compiler.sketch.design import Design
from compiler.sketch.fill import curves_of
from compiler.sketch.pacing import TURN
from spec_schema.expressions.evaluate import evaluate

RAYS = 720
"""Directions in which the gap between two orbits is measured."""


def narrowest_gap(design: Design) -> str:
    """Words on the two neighboring orbits that come closest; empty where no two are nested."""
    found: list[tuple[float, str]] = []
    theta = np.linspace(0.0, TURN, RAYS)
    for family in design.families:
        curves = zip(family.rings, curves_of(family, design.frame), strict=True)
        for (inner, low), (outer, high) in pairwise(curves):
            gap = float(np.min(high.radii(theta)[0] - low.radii(theta)[0]))
            found.append((gap, f"'{inner.orbit.name}' and '{outer.orbit.name}'"))
    if not found:
        return ""
    gap, names = min(found)
    return f"; of its orbits, {names} come closest: {_spelled(gap, design)} apart"


def _spelled(gap: float, design: Design) -> str:
    """A length of the frame along each axis, in the user's units at the controls' defaults."""
    frame = design.frame
    found = [
        f"{gap * evaluate(half, frame.samples[0]) / unit.scale:.2g}"
        + ("" if unit.text == "1" else f" {unit.text}")
        for half, unit in zip(frame.half, frame.units, strict=True)
    ]
    same = found[0] == found[1]
    return (
        found[0]
        if same
        else f"{found[0]} along '{frame.over[0]}' or {found[1]} along '{frame.over[1]}'"
    )
