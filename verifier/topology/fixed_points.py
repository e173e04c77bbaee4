"""The fixed points of a slice with their types.

m: number of axes; J: Jacobian (m, m) at a point.
"""

from itertools import product
from typing import Final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.classification import classified, eigenvalue_doubt, spectrum
from verifier.topology.features import FixedPoint, Grid, PointKind, Standing
from verifier.topology.slices import Slice, drifts_at, jacobians_at, shortest
from verifier.topology.zeros import find_zeros

BLUR: Final = 1e-5
"""A point whose Jacobian is singular within this share of the widths is degenerate."""

CROWD: Final = 12
"""More degenerate points than these are samples of a curve or an area of fixed points."""

SPACING: Final = 0.04
"""How far apart, as a share of the widths, the samples of such a curve are kept."""


def find_fixed_points(view: Slice, grid: Grid) -> tuple[tuple[FixedPoint, ...], tuple[str, ...]]:
    """The fixed points in order of their coordinates, and notes on what they do not tell."""
    zeros = find_zeros(view, grid)
    if not len(zeros):
        return (), ()
    J = jacobians_at(view, zeros)
    formula = None if view.formula is None else jacobians_at(view, zeros, view.formula)
    singular = _is_singular_near(view, zeros)
    drifts = _drifting(view, zeros, grid)
    rate = _typical_rate(view, grid)
    points = []
    for i, at in enumerate(zeros):
        eigenvalues, vectors = spectrum(J[i])
        of_formula = None if formula is None else spectrum(formula[i])[0]
        kind = (
            PointKind.DEGENERATE
            if singular[i]
            else _kind(view, J[i], eigenvalues, of_formula, rate)
        )
        points.append(
            FixedPoint(
                frozen(at),
                kind,
                eigenvalues,
                vectors,
                of_formula,
                drifts[i],
                proved=False,
                kind_proved=False,
                radius=frozen(np.zeros(len(at))),
                standing=Standing.UNCOMPARED,
            )
        )
    return _thinned(view, tuple(points))


def _kind(
    view: Slice,
    J: Array,
    eigenvalues: tuple[complex, ...],
    of_formula: tuple[complex, ...] | None,
    rate: float,
) -> PointKind:
    """The type by the table; by the formula where the table's error leaves it open."""
    if not eigenvalues:
        return PointKind.DEGENERATE
    doubt = eigenvalue_doubt(J, view.resolution)
    kind = classified(eigenvalues, is_map=view.is_map, rate=rate, doubt=doubt)
    if of_formula is None or kind not in {PointKind.CENTER, PointKind.DEGENERATE}:
        return kind
    return classified(of_formula, is_map=view.is_map, rate=rate, doubt=0.0)


def _typical_rate(view: Slice, grid: Grid) -> float:
    """The field's largest rate as a share of the domain, 1/s; 1 for a map."""
    return 1.0 if view.is_map else float(np.nanmax(np.abs(grid.rates) / view.width))


def _is_singular_near(view: Slice, zeros: Array) -> list[bool]:
    """Whether the Jacobian's determinant changes sign within `BLUR` of each zero.

    At a double zero it does, and a zero is never known better than that. So does a Jacobian that
    does not exist, at the edge of where the field does.
    """
    m = len(view.axes)
    corners = np.array(list(product((-1.0, 1.0), repeat=m))) * BLUR * view.width
    around = zeros[:, None, :] + corners
    inside = np.clip(around, view.low, view.low + view.width)
    J = jacobians_at(view, np.where(view.periodic, around, inside))
    sign = np.sign(np.linalg.det(np.nan_to_num(J - (np.eye(m) if view.is_map else 0.0))))
    return [bool(one.min() != one.max()) for one in sign]


def _drifting(view: Slice, zeros: Array, grid: Grid) -> list[tuple[str, ...]]:
    """For each zero the names of the held variables that would move there."""
    states = view.program.states
    names = [s.name for s in states]
    moves = np.abs(drifts_at(view, zeros)) > 1e-9 * float(np.nanmax(np.abs(grid.rates)))
    return [tuple(names[j] for j in np.flatnonzero(row) if j not in view.columns) for row in moves]


def _thinned(
    view: Slice, points: tuple[FixedPoint, ...]
) -> tuple[tuple[FixedPoint, ...], tuple[str, ...]]:
    """All points, but of a continuum of degenerate ones only some, and a note that says so."""
    degenerate = [p for p in points if p.kind is PointKind.DEGENERATE]
    if len(degenerate) <= CROWD:
        return points, ()
    kept: list[FixedPoint] = []
    for point in degenerate:
        gaps = [np.abs(shortest(view, point.at - other.at) / view.width).max() for other in kept]
        if min(gaps, default=1.0) >= SPACING:
            kept.append(point)
    note = f"fixed points fill a curve or an area; {len(kept)} points of it are listed"
    return tuple(p for p in points if p.kind is not PointKind.DEGENERATE or p in kept), (note,)
