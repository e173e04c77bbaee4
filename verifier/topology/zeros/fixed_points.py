"""The fixed points of a slice with their types, and what is proved of them.

m: number of axes; J: Jacobian (m, m) at a point.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from runtime.flow import Source
from verifier.topology.features import (
    Completeness,
    FixedPoint,
    Grid,
    PointKind,
    Standing,
    UndecidedBox,
)
from verifier.topology.slices import Slice, drifts_at, jacobians_at, shortest
from verifier.topology.zeros.classification import classified, eigenvalue_doubt, grows, spectrum
from verifier.topology.zeros.newton import largest_rates, near_misses, zeros_in
from verifier.topology.zeros.proof import Proof, prove
from verifier.topology.zeros.standings import compared
from verifier.topology.zeros.stillness import still_axes

CROWD: Final = 12
"""More degenerate points than these are samples of a curve or an area of fixed points."""

SPACING: Final = 0.04
"""How far apart, as a share of the widths, the samples of such a curve are kept."""

SHARP: Final = 1e-7
"""Bounds of a derivative that are closer than this share of its size give its value."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Scene:
    """What every point is looked at with: typical rates (m,), and one per domain, 1/s."""

    view: Slice
    largest: Array
    rate: float


def find_fixed_points(
    view: Slice, grid: Grid, *, compare: bool = True
) -> tuple[tuple[FixedPoint, ...], Completeness, tuple[str, ...]]:
    """The fixed points in order of their coordinates, how complete they are, and notes.

    The proved zeros come with those in undecided boxes that Newton's method finds, and with places
    where the tables are so near to zero that their error leaves it open.
    compare: whether zeros of tables are held against those of the formula.
    """
    scale, still = largest_rates(grid), still_axes(grid)
    if np.any(still):
        return (), _of_still(view, still), ()
    if not np.all(scale > 0.0):
        return (), _nothing_known(view), ()
    # The largest rate as a share of the domain; of a map, which has no time, 1.
    rate = 1.0 if view.is_map else float(np.nanmax(np.abs(grid.rates) / view.width))
    scene = _Scene(view, scale, rate)
    proof = prove(view)
    standings, lost = _standings(view, proof, compare=compare)
    points = _proved(scene, proof, standings)
    loose = zeros_in(view, proof.undecided, scale)
    known = np.concatenate([proof.zeros, loose])
    doubtful = np.concatenate([loose, near_misses(view, grid, known, scale)])
    kept, notes = _thinned(view, [*points, *_degenerate(scene, doubtful)])
    ordered = tuple(sorted(kept, key=lambda point: tuple(point.at)))
    return ordered, Completeness(proof.complete, proof.undecided, lost, proof.about), notes


def _of_still(view: Slice, still: Booleans) -> Completeness:
    """Of a field that does not move along some axes: where it moves along none."""
    names = tuple(axis.name for axis, is_still in zip(view.axes, still, strict=True) if is_still)
    if np.all(still):
        return replace(_nothing_known(view), still=names)
    proof = prove(view, still=still)
    nothing = frozen(np.empty((0, len(view.axes))))
    return Completeness(proof.complete, proof.undecided, nothing, proof.about, names)


def _nothing_known(view: Slice) -> Completeness:
    """Of a field without values, or that never moves: any point may be a zero."""
    everywhere = UndecidedBox(frozen(view.low), frozen(view.low + view.width))
    nothing = frozen(np.empty((0, len(view.axes))))
    return Completeness(complete=False, undecided=(everywhere,), lost=nothing, about="")


def _standings(view: Slice, proof: Proof, *, compare: bool) -> tuple[tuple[Standing, ...], Array]:
    if view.formula is None or not compare:
        nothing = frozen(np.empty((0, len(view.axes))))
        return tuple(Standing.UNCOMPARED for _ in proof.zeros), nothing
    return compared(view, proof, prove(view, source=Source.FORMULA))


def _proved(scene: _Scene, proof: Proof, standings: tuple[Standing, ...]) -> list[FixedPoint]:
    if not len(proof.zeros):
        return []
    view = scene.view
    J = _jacobians(view, proof)
    formula = _formula_jacobians(view, proof.zeros)
    drifts = _drifting(scene, proof.zeros)
    points = []
    for i, at in enumerate(proof.zeros):
        eigenvalues, vectors = spectrum(J[i])
        of_formula = None if formula is None else spectrum(formula[i])[0]
        # Where the bounds decide what grows, no rate is too small to count.
        rate = scene.rate if proof.unstable[i] is None else 0.0
        kind = _kind(replace(scene, rate=rate), J[i], eigenvalues, of_formula)
        points.append(
            FixedPoint(
                at=frozen(at),
                kind=kind,
                eigenvalues=eigenvalues,
                vectors=vectors,
                formula_eigenvalues=of_formula,
                drifts=drifts[i],
                proved=True,
                kind_proved=_is_certain(kind, proof.unstable[i], len(at)),
                radius=frozen(proof.radii[i]),
                standing=standings[i],
            )
        )
    return points


def _degenerate(scene: _Scene, places: Array) -> list[FixedPoint]:
    """Points of which nothing is proved."""
    if not len(places):
        return []
    view = scene.view
    J, formula = jacobians_at(view, places), _formula_jacobians(view, places)
    drifts = _drifting(scene, places)
    points = []
    for i, at in enumerate(places):
        eigenvalues, vectors = spectrum(J[i])
        points.append(
            FixedPoint(
                at=frozen(at),
                kind=PointKind.DEGENERATE,
                eigenvalues=eigenvalues,
                vectors=vectors,
                formula_eigenvalues=None if formula is None else spectrum(formula[i])[0],
                drifts=drifts[i],
                proved=False,
                kind_proved=False,
                radius=frozen(np.zeros(len(at))),
                standing=Standing.UNCOMPARED,
            )
        )
    return points


def _jacobians(view: Slice, proof: Proof) -> Array:
    """Derivatives at the zeros: the middle of their bounds where these are close."""
    low, high = proof.slopes.low, proof.slopes.high
    size = np.maximum(np.abs(low), np.abs(high)).max(axis=(-2, -1), keepdims=True)
    close = np.all(high - low <= SHARP * size, axis=(-2, -1), keepdims=True)
    return np.where(close, 0.5 * low + 0.5 * high, jacobians_at(view, proof.zeros))


def _formula_jacobians(view: Slice, places: Array) -> Array | None:
    return None if view.formula is None else jacobians_at(view, places, view.formula)


def _kind(
    scene: _Scene,
    J: Array,
    eigenvalues: tuple[complex, ...],
    of_formula: tuple[complex, ...] | None,
) -> PointKind:
    """The type by the table; by the formula where the table's error leaves it open."""
    if not eigenvalues:
        return PointKind.DEGENERATE
    is_map = scene.view.is_map
    doubt = eigenvalue_doubt(J, scene.view.resolution)
    kind = classified(eigenvalues, is_map=is_map, rate=scene.rate, doubt=doubt)
    if of_formula is None or kind not in {PointKind.CENTER, PointKind.DEGENERATE}:
        return kind
    return classified(of_formula, is_map=is_map, rate=scene.rate, doubt=0.0)


def _is_certain(kind: PointKind, unstable: int | None, m: int) -> bool:
    """Whether the number of directions that grow for certain is that of the type."""
    directions = grows(kind, m)
    return unstable is not None and directions is not None and unstable in directions


def _drifting(scene: _Scene, places: Array) -> list[tuple[str, ...]]:
    """For each place the names of the held variables that would move there."""
    view = scene.view
    names = [s.name for s in view.program.states]
    moves = np.abs(drifts_at(view, places)) > 1e-9 * float(scene.largest.max())
    return [tuple(names[j] for j in np.flatnonzero(row) if j not in view.columns) for row in moves]


def _thinned(view: Slice, points: list[FixedPoint]) -> tuple[list[FixedPoint], tuple[str, ...]]:
    """All points, but of a continuum of degenerate ones only some, and a note that says so."""
    degenerate = [p for p in points if not p.proved]
    if len(degenerate) <= CROWD:
        return points, ()
    kept: list[FixedPoint] = []
    for point in degenerate:
        gaps = [np.abs(shortest(view, point.at - other.at) / view.width).max() for other in kept]
        if min(gaps, default=1.0) >= SPACING:
            kept.append(point)
    note = f"fixed points fill a curve or an area; {len(kept)} points of it are listed"
    return [p for p in points if p.proved or p in kept], (note,)
