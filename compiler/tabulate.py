"""A function on a box becomes a table whose error off the nodes is measured, and small enough.

The axes are refined one by one on random lines parallel to them (a line costs n evaluations where
the grid costs n^d); then the whole table is built and measured on fresh random points that did not
choose the nodes. The bound so measured is an estimate and called so.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias, final

import numpy as np

from compiler.finite import REMEDY, not_finite
from compiler.ranges import Range
from runtime.arrays import Array
from runtime.interpolation import lookup, tabulate
from runtime.table import Axis, Method, Table

Sampler: TypeAlias = Callable[[Array], Array]
"""Points (N, d) to values (N, m)."""

LINES = 24  # parallel lines per axis, half of them on faces of the box, where splines err most
PROBES = 512  # off-node points per line, at most
SPOTS = 20_000  # fresh points for the final measurement, and as many in the outermost cells
WORST = 24  # places around which the largest error is sought again, more densely
MARGIN = 1.1  # measured errors are enlarged by this, since a denser sample finds a little more
ROUNDING = 2.0**-50  # of the largest value: no bound is smaller than what doubles can hold
MOST_NODES = 8_193  # per axis
ROUNDS = 24  # of widening, each by what the error asks for
SEED = 20_260  # the same input gives the same bytes


@final
@dataclass(frozen=True, eq=False, slots=True)
class Tabulated:
    """A table, and the largest errors (m,) of its columns against the function."""

    table: Table
    error: Array
    points: int


@final
class TableError(Exception):
    """The function can't be tabulated as asked: why, along which axis, and what to do."""

    def __init__(self, code: str, axis: str | None, message: str, remedy: str) -> None:
        self.code, self.axis, self.message, self.remedy = code, axis, message, remedy
        super().__init__(message)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Wanted:
    """What is to be tabulated: the function, its box, the tolerance (m,) of each column."""

    sample: Sampler
    ranges: tuple[Range, ...]
    tolerance: Array
    method: Method
    budget: int


def tabulate_function(wanted: Wanted) -> Tabulated:
    """The smallest table found whose measured error stays under the tolerance.

    Raises:
        TableError: it would be too large, the function jumps, or it isn't finite.
    """
    rng = np.random.default_rng(SEED)
    checked = replace(wanted, sample=_finite(wanted))
    axes = tuple(_refined(checked, i, rng) for i in range(len(wanted.ranges)))
    for _ in range(ROUNDS):
        table = _built(checked, axes)
        error, worst, points = _measured(checked, table, rng)
        if np.all(error <= wanted.tolerance):
            return Tabulated(table, error, points)
        axes = _widened(checked, axes, worst, rng)
    raise _too_fine(checked, axes)


def nodes(axis: Axis) -> Array:
    """The places (n,) of the nodes along an axis."""
    return axis.low + axis.step * np.arange(axis.count, dtype=np.float64)


def table_bytes(axes: tuple[Axis, ...], method: Method, columns: int) -> int:
    """The size of a table's coefficients."""
    extra = {Method.LINEAR: (0, 1), Method.CUBIC: (2, 3)}[method]
    return 8 * columns * math.prod(axis.count + extra[axis.periodic] for axis in axes)


def _finite(wanted: Wanted) -> Sampler:
    def sample(points: Array) -> Array:
        values = wanted.sample(points)
        bad = ~np.isfinite(values).all(axis=-1)
        if bad.any():
            place = points[np.argmax(bad)]
            message = not_finite([r.name for r in wanted.ranges], place.tolist())
            raise TableError("S243", None, message, REMEDY)
        return values

    return sample


def _start(span: Range, method: Method) -> int:
    if span.fixed is not None:
        return span.fixed
    if span.periodic:
        return 8
    return 5 if method is Method.CUBIC else 3


def _axis(span: Range, count: int) -> Axis:
    return Axis(span.name, span.low, span.high, count, span.periodic)


def _refined(wanted: Wanted, i: int, rng: np.random.Generator) -> Axis:
    """Axis i with enough nodes that lines along it are interpolated to the tolerance."""
    span = wanted.ranges[i]
    lines = _lines(wanted.ranges, rng)
    order = 4 if wanted.method is Method.CUBIC else 2
    share = 0.6 / len(wanted.ranges)
    count = _start(span, wanted.method)
    history: list[_LineError] = []
    while True:
        axis = _axis(span, count)
        found = _line_error(wanted, i, axis, lines, rng)
        history.append(found)
        if found.ratio <= share or span.fixed is not None:
            return axis
        if _is_jump(history):
            raise _jump(span, found.place)
        growth = min(4.0, max(1.3, (1.2 * found.ratio / share) ** (1 / order)))
        count = math.ceil((count - 1) * growth) + 1
        if count > MOST_NODES or 8 * count * wanted.tolerance.size > wanted.budget:
            raise _too_fine(wanted, (_axis(span, count),))


def _lines(ranges: tuple[Range, ...], rng: np.random.Generator) -> Array:
    """Base points (LINES, d) of lines; each coordinate of the second half lies on a face."""
    low = np.array([r.low for r in ranges])
    high = np.array([r.high for r in ranges])
    base = rng.uniform(low, high, (LINES, len(ranges)))
    face = np.where(rng.random(base.shape) < 0.5, low, high)
    inner = np.arange(LINES)[:, None] < LINES // 2
    return np.where(inner | (rng.random(base.shape) < 0.3), base, face)


@final
@dataclass(frozen=True, slots=True)
class _LineError:
    """The largest error / tolerance along an axis over all lines, where, and how widespread.

    spread: the share of the probed places where the error is above a quarter of the largest.
    """

    count: int
    ratio: float
    place: float
    spread: float


def _line_error(
    wanted: Wanted, i: int, axis: Axis, lines: Array, rng: np.random.Generator
) -> _LineError:
    probes = rng.uniform(axis.low, axis.high, min(PROBES, 6 * axis.count))
    at_nodes = _along(wanted.sample, lines, i, nodes(axis))
    line_table = tabulate(at_nodes.reshape(axis.count, -1), (axis,), wanted.method)
    exact = _along(wanted.sample, lines, i, probes)
    error = np.abs(lookup(line_table, probes[:, None]).reshape(exact.shape) - exact)
    ratio = (error / wanted.tolerance).max(axis=(1, 2))
    largest = float(ratio.max())
    spread = float(np.mean(ratio > 0.25 * largest))
    return _LineError(axis.count, largest, float(probes[ratio.argmax()]), spread)


def _along(sample: Sampler, lines: Array, i: int, at: Array) -> Array:
    """Values (len(at), LINES, m) at the places `at` along axis i of every line."""
    points = np.repeat(lines[None], len(at), axis=0)
    points[..., i] = at[:, None]
    return sample(points.reshape(-1, lines.shape[1])).reshape(len(at), len(lines), -1)


def _is_jump(history: list[_LineError]) -> bool:
    """Eight times the nodes have not even halved the error, and it sits in few places.

    Errors everywhere are no jump but waves that the nodes are still too coarse for.
    """
    last = history[-1]
    earlier = [e.ratio for e in history if 8 * e.count <= last.count and e.count >= 16]
    return bool(earlier) and last.ratio > 0.5 * min(earlier) and last.spread < 0.1


def _built(wanted: Wanted, axes: tuple[Axis, ...]) -> Table:
    columns = wanted.tolerance.size
    if table_bytes(axes, wanted.method, columns) > wanted.budget:
        raise _too_fine(wanted, axes)
    shape = tuple(axis.count for axis in axes)
    values = np.empty((math.prod(shape), columns))
    places = [nodes(axis) for axis in axes]
    for start in range(0, len(values), 200_000):
        index = np.unravel_index(np.arange(start, min(start + 200_000, len(values))), shape)
        points = np.stack([at[k] for at, k in zip(places, index, strict=True)], axis=-1)
        values[start : start + len(points)] = wanted.sample(points)
    return tabulate(values.reshape(*shape, columns), axes, wanted.method)


def _measured(wanted: Wanted, table: Table, rng: np.random.Generator) -> tuple[Array, Array, int]:
    """Largest error per column (m,) with margin, the worst point (d,), and how many points."""
    points = np.concatenate([_spread(table.axes, rng), _outermost(table.axes, rng)])
    error = np.abs(lookup(table, points) - wanted.sample(points))
    order = (error / wanted.tolerance).max(axis=-1).argsort()[::-1][:WORST]
    near = _around(points[order], table.axes, rng)
    nearby = np.abs(lookup(table, near) - wanted.sample(near))
    largest = np.maximum(error.max(axis=0), nearby.max(axis=0))
    return MARGIN * largest, points[order[0]], len(points) + len(near)


def _spread(axes: tuple[Axis, ...], rng: np.random.Generator) -> Array:
    return rng.uniform([a.low for a in axes], [a.high for a in axes], (SPOTS, len(axes)))


def _outermost(axes: tuple[Axis, ...], rng: np.random.Generator) -> Array:
    """Points whose every coordinate has an even chance to lie in an outermost cell."""
    points = _spread(axes, rng)
    for i, axis in enumerate(axes):
        inward = rng.uniform(0.0, axis.step, SPOTS)
        edge = np.where(rng.random(SPOTS) < 0.5, axis.low + inward, axis.high - inward)
        points[:, i] = np.where(rng.random(SPOTS) < 0.5, edge, points[:, i])
    return points


def _around(points: Array, axes: tuple[Axis, ...], rng: np.random.Generator) -> Array:
    """Many points within a cell's width of each of `points`, inside the box."""
    step = np.array([axis.step for axis in axes])
    cloud = points[:, None] + rng.uniform(-1.0, 1.0, (len(points), 400, len(axes))) * step
    low, high = [a.low for a in axes], [a.high for a in axes]
    inside: Array = np.clip(cloud, low, high).reshape(-1, len(axes))
    return inside


def _widened(
    wanted: Wanted, axes: tuple[Axis, ...], worst: Array, rng: np.random.Generator
) -> tuple[Axis, ...]:
    """More nodes on the axis along which the lines near the worst point err most."""
    lines = _around(worst[None], axes, rng)[:LINES]
    ratios = [
        _line_error(wanted, i, axis, lines, rng).ratio if wanted.ranges[i].fixed is None else -1.0
        for i, axis in enumerate(axes)
    ]
    i = int(np.argmax(ratios))
    if ratios[i] < 0.0:
        raise _too_few(axes)
    order = 4 if wanted.method is Method.CUBIC else 2
    growth = min(3.0, max(1.3, (2.0 * ratios[i]) ** (1 / order)))
    wider = replace(axes[i], count=math.ceil((axes[i].count - 1) * growth) + 1)
    if wider.count > MOST_NODES:
        raise _too_fine(wanted, (*axes[:i], wider, *axes[i + 1 :]))
    return (*axes[:i], wider, *axes[i + 1 :])


def _jump(span: Range, place: float) -> TableError:
    return TableError(
        "S242",
        span.name,
        f"the field jumps along {span.name} near {place:.4g} (SI), and a table would smear it",
        "make the transition smooth (for example with tanh), move the jump into a factor that "
        "reads only controls, or give each side a field of its own: `field: {modes: ...}`",
    )


def _too_few(axes: tuple[Axis, ...]) -> TableError:
    axis = max(axes, key=lambda a: -a.count)
    return TableError(
        "S244",
        axis.name,
        f"the fixed node counts ({', '.join(f'{a.name}: {a.count}' for a in axes)}) miss the "
        f"tolerance",
        "raise the counts, leave them out so that the compiler chooses, or loosen `tolerance`",
    )


def _too_fine(wanted: Wanted, axes: tuple[Axis, ...]) -> TableError:
    axis = max(axes, key=lambda a: a.count)
    size = table_bytes(axes, wanted.method, wanted.tolerance.size)
    if axis.count > MOST_NODES:
        return TableError(
            "S241",
            axis.name,
            f"the field bends too sharply along {axis.name}: more than {MOST_NODES} nodes would be "
            "needed (a kink, as clip, abs, min and max have, is never met exactly)",
            f"loosen `table: tolerance`, round the kink off (for example with tanh), or shrink the "
            f"domain of {axis.name}",
        )
    return TableError(
        "S241",
        axis.name,
        f"the table would not stay within its budget: axis {axis.name} needs more than "
        f"{axis.count} nodes ({size / 2**20:.3g} MiB so far, the budget is "
        f"{wanted.budget / 2**20:.3g} MiB)",
        f"loosen `table: tolerance`, shrink the domain of {axis.name}, or raise `table: budget`",
    )
