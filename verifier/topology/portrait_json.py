"""A portrait as plain data in the user's units; eigenvalues in 1/s, of a map per step."""

import math
from collections.abc import Sequence

import numpy as np

from runtime.arrays import Array
from verifier.topology.features import AxisRange, FixedPoint, Grid, Held, Portrait, Trajectory

FIELD_STRIDE = 4
"""Every which node of the portrait's grid is written."""


def as_json(portrait: Portrait) -> dict[str, object]:
    """What `specc portrait --format json` prints."""
    axes = portrait.axes
    parts: list[AxisRange | Held] = [*axes, *portrait.held]
    return {
        "behavior": portrait.name,
        "axes": [axis.name for axis in axes],
        "units": {part.name: part.unit.text for part in parts},
        "domain": {a.name: [a.low / a.unit.scale, a.high / a.unit.scale] for a in axes},
        "held": {held.name: _held(held) for held in portrait.held},
        "map": portrait.every > 0.0,
        "fixed_points": [_fixed_point(axes, point) for point in portrait.fixed_points],
        "nullclines": [
            {"of": n.of, "lines": [_points(axes, line) for line in n.lines]}
            for n in portrait.nullclines
        ],
        "trajectories": [_trajectory(axes, path) for path in portrait.trajectories],
        "field": _field(axes, portrait.field),
        "notes": list(portrait.notes),
    }


def _held(held: Held) -> float | str:
    return held.label or held.value / held.unit.scale


def _fixed_point(axes: tuple[AxisRange, ...], point: FixedPoint) -> dict[str, object]:
    formula = point.formula_eigenvalues
    return {
        "at": {a.name: float(v) / a.unit.scale for a, v in zip(axes, point.at, strict=True)},
        "kind": str(point.kind),
        "eigenvalues": _pairs(point.eigenvalues),
        "formula_eigenvalues": None if formula is None else _pairs(formula),
        "drifts": list(point.drifts),
    }


def _pairs(values: Sequence[complex]) -> list[list[float]]:
    return [[value.real, value.imag] for value in values]


def _trajectory(axes: tuple[AxisRange, ...], path: Trajectory) -> dict[str, object]:
    return {
        "course": str(path.course),
        "start": path.start,
        "times": [_short(t) for t in path.times],
        "points": _points(axes, path.points),
    }


def _field(axes: tuple[AxisRange, ...], field: Grid) -> dict[str, object]:
    every = slice(None, None, FIELD_STRIDE)
    rates = field.rates[(every,) * len(axes)]
    return {
        "nodes": {
            a.name: [_short(v / a.unit.scale) for v in nodes[every]]
            for a, nodes in zip(axes, field.nodes, strict=True)
        },
        "rates": {a.name: _nested(rates[..., j] / a.unit.scale) for j, a in enumerate(axes)},
    }


def _nested(values: Array) -> list[object]:
    if values.ndim == 1:
        return [_short(v) for v in values]
    return [_nested(row) for row in values]


def _points(axes: tuple[AxisRange, ...], points: Array) -> list[list[float | None]]:
    shown = points / np.array([axis.unit.scale for axis in axes])
    return [[_short(v) for v in point] for point in shown]


def _short(value: float) -> float | None:
    """Ten digits; None where there is no number, which JSON can't write."""
    return float(f"{value:.10g}") if math.isfinite(value) else None
