"""A portrait as plain data in the user's units; eigenvalues in 1/s, of a map per step."""

import math
from collections.abc import Sequence

import numpy as np

from runtime.arrays import Array
from runtime.program import Unit
from verifier.topology.features import (
    AxisRange,
    Basins,
    Cycle,
    FixedPoint,
    Grid,
    Held,
    Portrait,
    Separatrix,
    Trajectory,
)
from verifier.topology.names import attractor_names

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
        "domain": {a.name: [_in_unit(end, a.unit) for end in (a.low, a.high)] for a in axes},
        "held": {held.name: _held(held) for held in portrait.held},
        "map": portrait.every > 0.0,
        "complete": portrait.completeness.complete,
        "proof_of": portrait.completeness.about or None,
        "still": list(portrait.completeness.still),
        "fixed_points": [_fixed_point(axes, point) for point in portrait.fixed_points],
        "undecided": [
            {"low": _named(axes, box.low), "high": _named(axes, box.high)}
            for box in portrait.completeness.undecided
        ],
        "lost": [_named(axes, zero) for zero in portrait.completeness.lost],
        "cycles": [_cycle(axes, cycle) for cycle in portrait.cycles],
        "separatrices": [_separatrix(axes, branch) for branch in portrait.separatrices],
        "rests": [_named(axes, place) for place in portrait.rests],
        "basins": None if portrait.basins is None else _basins(portrait, portrait.basins),
        "switching": [
            {"from": s.mode, "to": s.target, "lines": [_points(axes, line) for line in s.lines]}
            for s in portrait.switching
        ],
        "nullclines": [
            {"of": n.of, "lines": [_points(axes, line) for line in n.lines]}
            for n in portrait.nullclines
        ],
        "trajectories": [_trajectory(axes, path) for path in portrait.trajectories],
        "field": _field(axes, portrait.field),
        "notes": list(portrait.notes),
    }


def _held(held: Held) -> float | str:
    return held.label or _in_unit(held.value, held.unit)


def _in_unit(value: float, unit: Unit) -> float:
    """A value in the user's unit, without the last digit, which is rounding: 60 deg are 60."""
    return float(f"{value / unit.scale:.15g}")


def _fixed_point(axes: tuple[AxisRange, ...], point: FixedPoint) -> dict[str, object]:
    formula = point.formula_eigenvalues
    return {
        "at": _named(axes, point.at),
        "kind": str(point.kind),
        "proved": point.proved,
        "kind_proved": point.kind_proved,
        "within": _named(axes, point.radius) if point.proved else None,
        "standing": str(point.standing),
        "eigenvalues": _pairs(point.eigenvalues),
        "formula_eigenvalues": None if formula is None else _pairs(formula),
        "drifts": list(point.drifts),
    }


def _cycle(axes: tuple[AxisRange, ...], cycle: Cycle) -> dict[str, object]:
    return {
        "period": cycle.period,
        "stable": cycle.is_attracting,
        "stability": str(cycle.stability),
        "multipliers": _pairs(cycle.multipliers),
        "cross_checked": _pairs(cycle.cross_checked),
        "doubtful": cycle.doubtful,
        "turns": {a.name: n for a, n in zip(axes, cycle.turns, strict=False) if a.periodic},
        "times": [_short(t) for t in cycle.times],
        "points": _points(axes, cycle.points),
        "modes": list(cycle.modes),
    }


def _separatrix(axes: tuple[AxisRange, ...], branch: Separatrix) -> dict[str, object]:
    """A branch; `to` indexes the fixed points or the cycles, whichever it reaches."""
    return {
        "saddle": branch.saddle,
        "stable": branch.stable,
        "reaches": str(branch.reaches),
        "to": branch.to if branch.to >= 0 else None,
        "times": [_short(t) for t in branch.times],
        "points": _points(axes, branch.points),
    }


def _basins(portrait: Portrait, basins: Basins) -> dict[str, object]:
    """Shares, and the cells' labels: an index of `attractors`, -1 leaves, -2 not followed."""
    return {
        "attractors": [
            {
                "of": "cycles" if a.is_cycle else "fixed_points",
                "index": a.index,
                "name": name,
                "share": a.share,
                "within": a.within,
            }
            for a, name in zip(basins.attractors, attractor_names(portrait), strict=True)
        ],
        "leaves": basins.leaves,
        "leaves_within": basins.leaves_within,
        "open": basins.open,
        "open_within": basins.open_within,
        "centres": {
            a.name: [_short(v / a.unit.scale) for v in centres]
            for a, centres in zip(portrait.axes, basins.centres, strict=True)
        },
        "labels": basins.labels.tolist(),
    }


def _named(axes: tuple[AxisRange, ...], point: Array) -> dict[str, float]:
    return {a.name: _in_unit(float(v), a.unit) for a, v in zip(axes, point, strict=True)}


def _pairs(values: Sequence[complex]) -> list[list[float]]:
    return [[value.real, value.imag] for value in values]


def _trajectory(axes: tuple[AxisRange, ...], path: Trajectory) -> dict[str, object]:
    return {
        "course": "seed",  # why it is shown; there is one reason
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
