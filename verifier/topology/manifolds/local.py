"""Where the one-dimensional manifolds of a saddle begin: its eigenvectors, bent to second order.

m: number of axes; e: differences from the saddle as shares of the axes' widths. A branch is
e(s) = s v + s² w, where v is an eigenvector (λ) and (2 λ - J) w = H(v, v) / 2 for a flow; for a
map (λ² - J) w = H(v, v) / 2 (the parameterization method: Cabré, Fontich, de la Llave 2005).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, frozen
from verifier.topology.features import FixedPoint, PointKind
from verifier.topology.slices import Slice, jacobians_at, rates_at

DISTANCES: Final = 0.02 * 0.5 ** np.arange(14.0)
"""Where branches may begin, as shares of the widths; the farthest that is exact enough is taken."""

EXACT: Final = 1e-10
"""How far, as a share of the widths, the beginning may lie beside the manifold."""

PROBE: Final = 1e-3
"""The step of the second differences that H is worked out from."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Branch:
    """The beginning of a branch: `at` (m,), `distance` from its saddle, in shares.

    saddle: index into the fixed points. eigenvalue: of the branch (1/s, or a multiplier).
    """

    saddle: int
    stable: bool
    eigenvalue: float
    distance: float
    at: Array
    direction: Array
    bend: Array

    def point(self, s: Array, at: Array, width: Array) -> Array:
        """Points (k, m) of the branch of the saddle `at`, at parameters s (k,)."""
        e = s[:, None] * self.direction + (s * s)[:, None] * self.bend
        return np.asarray(at + e * width)


def branches_of(view: Slice, fixed_points: Sequence[FixedPoint]) -> tuple[Branch, ...]:
    """Both sides of every manifold of one dimension of every saddle, within the domain."""
    return tuple(
        branch
        for index, point in enumerate(fixed_points)
        if is_saddle(view, point)
        for column, stable in _single_directions(view, point)
        for branch in _sides(view, index, point, column, stable=stable)
    )


def is_saddle(view: Slice, point: FixedPoint) -> bool:
    """Whether some directions grow and others shrink; with more than two axes they may turn."""
    if point.kind in {PointKind.DEGENERATE, PointKind.CENTER} or not point.eigenvalues:
        return False
    growth = growths(view, point)
    return bool(growth.min() < 0.0 < growth.max())


def growths(view: Slice, point: FixedPoint) -> Array:
    """Re(λ) of a flow, log|λ| of a map, for each eigenvalue (m,)."""
    values = np.array(point.eigenvalues)
    if not view.is_map:
        return np.asarray(values.real, dtype=np.float64)
    return np.asarray(np.log(np.maximum(np.abs(values), 1e-300)), dtype=np.float64)


def _single_directions(view: Slice, point: FixedPoint) -> list[tuple[int, bool]]:
    """Columns of the eigenvectors that are alone on their side, and whether that is the stable."""
    growth = growths(view, point)
    sides = ((np.flatnonzero(growth > 0.0), False), (np.flatnonzero(growth < 0.0), True))
    return [(int(columns[0]), stable) for columns, stable in sides if len(columns) == 1]


def _sides(
    view: Slice, index: int, point: FixedPoint, column: int, *, stable: bool
) -> list[Branch]:
    eigenvalue = point.eigenvalues[column].real
    v = np.array([row[column].real for row in point.vectors]) / view.width
    v /= np.linalg.norm(v)
    w = _bend(view, point.at, v, eigenvalue)
    found: list[Branch] = []
    for direction in (v, -v):
        e = DISTANCES[:, None] * direction + DISTANCES[:, None] ** 2 * w
        starts = point.at + e * view.width
        beside = _beside(view, starts, direction, w, eigenvalue)
        known = np.flatnonzero(np.isfinite(beside))
        if not known.size:
            continue
        exact = known[beside[known] <= EXACT]
        k = int(exact[0] if exact.size else known[-1])
        found.append(
            Branch(
                saddle=index,
                stable=stable,
                eigenvalue=eigenvalue,
                distance=float(DISTANCES[k]),
                at=frozen(starts[k]),
                direction=frozen(direction),
                bend=frozen(w),
            )
        )
    return found


def _bend(view: Slice, at: Array, v: Array, eigenvalue: float) -> Array:
    """The second-order part (m,) of a branch; zero where the field is not known on both sides."""
    J = jacobians_at(view, at[None])[0] * view.width / view.width[:, None]
    probes = at + np.array([-1.0, 0.0, 1.0])[:, None] * PROBE * v * view.width
    before, here, after = rates_at(view, probes) / view.width
    second = (after - 2.0 * here + before) / PROBE**2
    multiple = eigenvalue**2 if view.is_map else 2.0 * eigenvalue
    try:
        w = np.linalg.solve(multiple * np.eye(len(v)) - J, 0.5 * second)
    except np.linalg.LinAlgError:
        return np.zeros_like(v)
    return w if np.all(np.isfinite(w)) else np.zeros_like(v)


def _beside(view: Slice, starts: Array, v: Array, w: Array, eigenvalue: float) -> Array:
    """About how far (k,) beside the manifold `starts` lie, from what is missing to invariance."""
    s = DISTANCES[:, None]
    moved = rates_at(view, starts) / view.width
    if view.is_map:
        image = eigenvalue * s
        expected = (image - s) * v + (image**2 - s**2) * w
        return np.asarray(np.linalg.norm(moved - expected, axis=-1))
    expected = eigenvalue * s * (v + 2.0 * s * w)
    return np.asarray(np.linalg.norm(moved - expected, axis=-1) / abs(eigenvalue))
