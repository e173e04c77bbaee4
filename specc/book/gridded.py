"""A function of some quantities as a table: nodes go where it bends, until straight is enough."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans

FINE: Final = 2e-3
"""What a table may be off by, of the largest value in it, as its own bending tells."""
LARGEST: Final = 50_000
"""Nodes of a table at most."""
FIRST: Final = 5
"""Nodes along an axis at first."""
ROUNDS: Final = 24
"""So often nodes are added at most."""
PROBES: Final = 4000
"""Random places at which the error is measured."""
NARROWEST: Final = 1e-4
"""Of an axis: narrower intervals are not halved, as at a jump."""
SEED: Final = 36


@final
@dataclass(frozen=True, slots=True)
class Axis:
    """What a table runs over: from `low` to `high`, or the places 0 to `high` of some values."""

    low: float
    high: float
    is_discrete: bool = False

    def first_nodes(self) -> Array:
        """All places of values; of a range a few, evenly spaced."""
        if self.is_discrete:
            return np.arange(self.high + 1.0)
        return np.linspace(self.low, self.high, FIRST)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Grid:
    """Nodes (n1,), ... of each axis and the values (n1, ...) there.

    error, size: the largest difference from the function, and its largest value, at `PROBES`
    random places.
    """

    nodes: tuple[Array, ...]
    values: Array
    error: float
    size: float


Axes: TypeAlias = tuple[Axis, ...]
Nodes: TypeAlias = tuple[Array, ...]
Values: TypeAlias = Callable[[Array], Array]
"""Those (N,) of a function at points (N, d)."""


def gridded(at: Values, axes: Axes) -> Grid:
    """The function as a table, fine enough or as large as it may be."""
    nodes: Nodes = tuple(axis.first_nodes() for axis in axes)
    values = _tabulated(at, nodes)
    for _ in range(ROUNDS):
        finer = _finer(axes, nodes, values) or _finer_where_off(at, axes, nodes, values)
        if finer is None:
            break
        nodes, values = finer, _tabulated(at, finer)
    _, off, size = _probed(at, axes, nodes, values, SEED + 1)
    return Grid(nodes, values, float(off.max(initial=0.0)), size)


def _tabulated(at: Values, nodes: Nodes) -> Array:
    mesh = np.meshgrid(*nodes, indexing="ij") if nodes else []
    points = np.stack([m.ravel() for m in mesh], axis=-1) if nodes else np.zeros((1, 0))
    return at(points).reshape([len(own) for own in nodes])


def _finer(axes: Axes, nodes: Nodes, values: Array) -> Nodes | None:
    """More nodes where the values bend, along the axis that bends most; None where enough."""
    allowed = FINE * float(np.nanmax(np.abs(values), initial=0.0)) / max(len(axes), 1)
    bends = [
        np.zeros(len(own)) if axis.is_discrete else _bending(own, values, k)
        for k, (axis, own) in enumerate(zip(axes, nodes, strict=True))
    ]
    for k in sorted(range(len(axes)), key=lambda k: -bends[k].max()):
        if bends[k].max() <= allowed:
            return None
        finer = (*nodes[:k], _split(nodes[k], bends[k] > allowed), *nodes[k + 1 :])
        is_more = len(finer[k]) > len(nodes[k])
        if is_more and np.prod([len(own) for own in finer]) <= LARGEST:
            return finer
    return None


def _finer_where_off(at: Values, axes: Axes, nodes: Nodes, values: Array) -> Nodes | None:
    """More nodes around places where the table is off though it does not bend: beside a kink."""
    points, off, size = _probed(at, axes, nodes, values, SEED)
    bad = points[off > FINE * size]
    finer = []
    for k, (axis, own) in enumerate(zip(axes, nodes, strict=True)):
        if axis.is_discrete:
            finer.append(own)
            continue
        cells = np.clip(np.searchsorted(own, bad[:, k], side="right") - 1, 0, len(own) - 2)
        wide = np.diff(own) > NARROWEST * (own[-1] - own[0])
        hit = np.zeros(len(own) - 1, dtype=np.bool_)
        hit[cells] = True
        finer.append(np.sort(np.concatenate([own, 0.5 * (own[1:] + own[:-1])[hit & wide]])))
    counts = [len(own) for own in finer]
    is_more = counts != [len(own) for own in nodes]
    return tuple(finer) if is_more and np.prod(counts) <= LARGEST else None


def _bending(nodes: Array, values: Array, axis: int) -> Array:
    """At each inner node (n,) what is lost beside it by going straight: a quarter of its bend."""
    rows = np.moveaxis(values, axis, 0).reshape(len(nodes), -1)
    share = ((nodes[1:-1] - nodes[:-2]) / (nodes[2:] - nodes[:-2]))[:, np.newaxis]
    straight = (1.0 - share) * rows[:-2] + share * rows[2:]
    off = np.nan_to_num(np.abs(rows[1:-1] - straight), nan=0.0).max(axis=1)
    return np.concatenate([[0.0], off / 4.0, [0.0]])


def _split(nodes: Array, bent: Booleans) -> Array:
    """The nodes with a new one in the middle of each interval beside a bent one."""
    wide = np.diff(nodes) > NARROWEST * (nodes[-1] - nodes[0])
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    return np.sort(np.concatenate([nodes, middles[(bent[1:] | bent[:-1]) & wide]]))


def _probed(
    at: Values, axes: Axes, nodes: Nodes, values: Array, seed: int
) -> tuple[Array, Array, float]:
    """Random places (N, d), how far the table is off there (N,), and the largest value seen."""
    chance = np.random.default_rng(seed)
    columns = [
        chance.integers(0, len(own), PROBES).astype(float)
        if axis.is_discrete
        else chance.uniform(own[0], own[-1], PROBES)
        for axis, own in zip(axes, nodes, strict=True)
    ]
    points = np.stack(columns, axis=-1) if columns else np.zeros((1, 0))
    exact = at(points)
    off = np.nan_to_num(np.abs(interpolated(nodes, values, points) - exact), nan=0.0)
    return points, off, float(np.nan_to_num(np.abs(exact), nan=0.0).max())


def interpolated(nodes: Nodes, values: Array, points: Array) -> Array:
    """The table (N,) at points (N, d), linear between its nodes, as `read_table` has it."""
    found = np.broadcast_to(values, (len(points), *values.shape))
    rows = np.arange(len(points))
    for k, own in enumerate(nodes):
        place = np.interp(points[:, k], own, np.arange(len(own)))
        i = np.minimum(place.astype(int), len(own) - 2)
        share = (place - i).reshape(-1, *[1] * (found.ndim - 2))
        found = found[rows, i] + share * (found[rows, i + 1] - found[rows, i])
    return found
