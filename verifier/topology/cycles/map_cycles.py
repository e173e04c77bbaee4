"""Periodic orbits of maps: zeros of F^k(x) - x that are none for a divisor of k.

m: number of axes; k: steps of the orbit; L: lanes; G: F^k(x) - x, the short way on periodic axes,
in widths.
"""

from functools import reduce
from itertools import product
from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from verifier.topology.cycles.floquet import AGREEMENT, stability
from verifier.topology.features import Cycle, Stability
from verifier.topology.slices import Slice, jacobians_at, rates_at, shortest, wrapped

LONGEST: Final = 8
"""The most steps of an orbit that is looked for."""

GRID: Final = {1: 4097, 2: 97, 3: 21, 4: 11}
"""Places per axis at which G is looked at, by the number of axes."""

STARTS: Final = 160
"""Places of least |G| from which Newton's method begins, for each k."""

ITERATIONS: Final = 30

ZERO: Final = 1e-11
"""What G must fall below."""

APART: Final = 1e-6
"""Points closer than this, in widths, are one."""

MOST: Final = 40
"""Orbits of one k that are listed; a chaotic map has many."""

SETTLING: Final = 512
"""Steps after which seeds are on an attractor."""

NUDGE: Final = 1e-6
"""How far starts are displaced, in widths, where F^k is differentiated by differences."""

LEAST_DAMPING: Final = 1e-13
"""Beside the size of the squared derivative: keeps singular systems solvable."""

NEUTRAL: Final = 1e-6

CONTINUUM: Final = "orbits close in a whole stretch of the slice: these are not listed as cycles"
CROWD: Final = "a crowd of periodic orbits is there, as in chaos: not all of them are listed"


def find_map_cycles(view: Slice) -> tuple[tuple[Cycle, ...], tuple[str, ...]]:
    """Periodic orbits of 2 to `LONGEST` steps, the shortest first, and notes on the rest."""
    nodes = _nodes(view)
    settled = _settled(view, nodes)
    images = nodes
    found: list[Cycle] = []
    notes: list[str] = []
    for k in range(1, LONGEST + 1):
        images = _next(view, images)
        if k == 1:
            continue
        starts = np.concatenate([_starts(view, nodes, images), settled])
        orbits = _orbits(view, starts, k)
        cycles = [_cycle(view, orbit) for orbit in orbits[:MOST]]
        if any(cycle.stability is Stability.NEUTRAL for cycle in cycles):
            notes.append(CONTINUUM)
        elif len(orbits) > MOST:
            notes.append(CROWD)
        found += [cycle for cycle in cycles if cycle.stability is not Stability.NEUTRAL]
    return tuple(found), tuple(dict.fromkeys(notes))


def _nodes(view: Slice) -> Array:
    """A grid of points (n, ..., n, m), away from seams and from simple fractions."""
    count = GRID[len(view.axes)]
    share = (np.arange(count) + 0.47) / count
    axes = [low + share * width for low, width in zip(view.low, view.width, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def _next(view: Slice, points: Array) -> Array:
    """Points (..., m) one step later, continuous on periodic axes."""
    return np.asarray(points + rates_at(view, points))


def _settled(view: Slice, nodes: Array) -> Array:
    """Points (L, m) on attractors."""
    everywhere = nodes.reshape(-1, len(view.axes))
    points = everywhere[:: max(1, len(everywhere) // 23)]
    for _ in range(SETTLING):
        points = wrapped(view, _next(view, points))
    return points[np.all(np.isfinite(points), axis=-1)]


def _gap(view: Slice, points: Array, images: Array) -> Array:
    return shortest(view, images - points) / view.width


def _starts(view: Slice, nodes: Array, images: Array) -> Array:
    """The nodes (L, m) at which G changes sign, or else is least around, the least first."""
    G = _gap(view, nodes, images)
    size = np.abs(G).max(axis=-1)
    here = _is_least(size)
    if nodes.shape[-1] == 1:
        with np.errstate(invalid="ignore"):
            here[:-1] |= (G[:-1, 0] < 0.0) != (G[1:, 0] < 0.0)
    chosen = np.argwhere(here & np.isfinite(size))
    order = np.argsort(size[tuple(chosen.T)], kind="stable")[: STARTS * nodes.shape[-1]]
    return np.asarray(nodes[tuple(chosen[order].T)])


def _is_least(size: Array) -> Booleans:
    """Where `size` (n, ..., n) is no larger than at any neighbour."""
    filled = np.where(np.isfinite(size), size, np.inf)
    padded = np.pad(filled, 1, constant_values=np.inf)
    least = np.isfinite(filled)
    for offset in product((-1, 0, 1), repeat=size.ndim):
        window = tuple(slice(1 + o, n + 1 + o) for o, n in zip(offset, size.shape, strict=True))
        least &= filled <= padded[window]
    return np.asarray(least)


def _orbits(view: Slice, starts: Array, k: int) -> list[Array]:
    """Orbits (k + 1, m) of exactly k steps near `starts`, each once."""
    points, steps = starts, np.ones(len(starts))
    gap = _gap(view, points, _path(view, points, k)[-1])
    for _ in range(ITERATIONS):
        step = _newton_step(view, points, gap, k) * steps[:, None]
        trial = wrapped(view, points + step * view.width)
        ahead = _gap(view, trial, _path(view, trial, k)[-1])
        with np.errstate(invalid="ignore"):
            better = np.linalg.norm(ahead, axis=-1) < np.linalg.norm(gap, axis=-1)
        points = np.where(better[:, None], trial, points)
        gap = np.where(better[:, None], ahead, gap)
        steps = np.where(better, np.minimum(1.0, 2.0 * steps), 0.5 * steps)
        if np.all((np.abs(gap).max(axis=-1) < ZERO) | (steps < 1e-4)):
            break
    closed = np.abs(gap).max(axis=-1) < ZERO
    paths = np.swapaxes(_path(view, points[closed], k), 0, 1)
    return _distinct(view, [path for path in paths if _is_minimal(view, path)])


def _path(view: Slice, points: Array, k: int) -> Array:
    """Points (k + 1, L, m) of k steps from `points` (L, m)."""
    path = [points]
    for _ in range(k):
        path.append(_next(view, path[-1]))
    return np.array(path)


def _matrices(view: Slice, path: Array) -> Array:
    """The derivatives (..., m, m) of F^k along a path (k + 1, ..., m), in widths."""
    each = jacobians_at(view, path[:-1]) * view.width / view.width[:, None]
    return np.asarray(reduce(lambda before, after: after @ before, each))


def _newton_step(view: Slice, points: Array, gap: Array, k: int) -> Array:
    """Steps (L, m), in widths, that close the linearised gaps; at most a tenth of the domain."""
    J = np.nan_to_num(_matrices(view, _path(view, points, k))) - np.eye(points.shape[-1])
    transposed = np.swapaxes(J, -1, -2)
    normal = transposed @ J
    slack = LEAST_DAMPING * (1.0 + np.trace(normal, axis1=-2, axis2=-1))[:, None, None]
    downhill = transposed @ np.nan_to_num(gap)[..., None]
    step = -np.linalg.solve(normal + slack * np.eye(points.shape[-1]), downhill)[..., 0]
    size = np.linalg.norm(step, axis=-1, keepdims=True)
    return np.asarray(step * np.minimum(1.0, 0.1 / np.maximum(size, 1e-300)))


def _is_minimal(view: Slice, path: Array) -> bool:
    """Whether an orbit (k + 1, m) comes back at its last step only."""
    gaps = np.abs(shortest(view, path[1:-1] - path[0]) / view.width).max(axis=-1)
    return bool(np.all(gaps > APART))


def _distinct(view: Slice, paths: list[Array]) -> list[Array]:
    """One of each group of paths that are the same orbit."""
    kept: list[Array] = []
    for path in paths:
        gaps = [
            np.abs(shortest(view, other[:-1] - path[0]) / view.width).max(axis=-1).min()
            for other in kept
        ]
        if min(gaps, default=1.0) > APART:
            kept.append(path)
    return kept


def _cycle(view: Slice, path: Array) -> Cycle:
    count = len(path) - 1
    path = path + (wrapped(view, path[0]) - path[0])
    values = _eigenvalues(_matrices(view, path))
    second = _eigenvalues(_differenced(view, path[0], count))
    doubtful = any(
        abs(a - b) > AGREEMENT * (1.0 + abs(a)) for a, b in zip(values, second, strict=True)
    )
    every = view.program.field.every
    return Cycle(
        times=frozen(every * np.arange(count + 1)),
        points=frozen(path),
        period=every * count,
        stability=stability(values, NEUTRAL),
        multipliers=values,
        cross_checked=second,
        doubtful=doubtful,
        turns=tuple(int(turn) for turn in np.round((path[-1] - path[0]) / view.width)),
        modes=(),
    )


def _differenced(view: Slice, start: Array, k: int) -> Array:
    """The derivative (m, m) of F^k by central differences, in widths."""
    nudges = NUDGE * np.diag(view.width)
    ends = _path(view, np.concatenate([start + nudges, start - nudges]), k)[-1]
    ahead, behind = np.split(ends, 2)
    return np.asarray((shortest(view, ahead - behind) / (2.0 * NUDGE) / view.width).T)


def _eigenvalues(matrix: Array) -> tuple[complex, ...]:
    if not np.all(np.isfinite(matrix)):
        return (complex(np.nan),) * len(matrix)
    values = np.linalg.eigvals(matrix)
    order = np.lexsort((-values.imag, -np.abs(values)))
    return tuple(complex(value) for value in values[order])
