"""Table lookup beside its peers, on one core: `make bench`.

Each peer is taken on its best path: interpn (scalar-valued, so once per column) with contiguous
coordinates, a result that is there already and no checks; scipy's RegularGridInterpolator and
econforge's `interpolation` (where it is installed) on all columns at once. Ours stands beside them
in like circumstances: `lookup` where the peer's result is new memory, else `lookup_into`. Times are
the processor's, so that other work on the machine counts less. Rounds are interleaved; a time is
the median of its rounds, a ratio that of the medians.

Exit status 1 where the numbers disagree, never for speed.
"""
# ruff: noqa: T201 - a bench prints

import os
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from typing import Any, TypeAlias

import numpy as np
from interpn import MultiBsplineRegular, MulticubicRegular, MultilinearRegular
from scipy.interpolate import NdBSpline, RegularGridInterpolator, make_interp_spline

from runtime.arrays import Array
from runtime.interpolation import lookup, lookup_into, tabulate
from runtime.table import Axis, Method

POINTS = 1_000_000
ROUNDS = 9
LONG = 1000.0
"""What takes longer than this (ms) runs three rounds only."""
SIZES = ((2, 65), (3, 33), (4, 17))
CHECKED = 2_000
"""Points at which the cubic is compared with scipy's tensor spline, which is slow."""

Work: TypeAlias = Callable[[], Array]


@dataclass(frozen=True, slots=True)
class Peer:
    """Another library at the same work.

    wanted: our time, at most, as a share of its own. fresh: whether each result is new memory.
    """

    name: str
    work: Work
    wanted: float
    fresh: bool


@dataclass(frozen=True, slots=True)
class Problem:
    """A smooth field with d components, tabulated on n^d nodes, wanted at random points."""

    method: Method
    axes: tuple[Axis, ...]
    nodes: list[Array]
    values: Array
    points: Array

    @property
    def name(self) -> str:
        return f"{self.method} {len(self.axes)}-D {self.axes[0].count}^{len(self.axes)}"


def main() -> int:
    """Run every contest and print a line for each peer."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    print(f"{POINTS:,} random points, as many columns as axes, {ROUNDS} rounds, one core\n")
    print(
        "work               ours ms  peer               peer ms   ratio  wanted      peer's error"
    )
    agree = True
    for d, n in SIZES:
        for method in Method:
            agree &= contest(problem_of(method, d, n))
    print("\nthe numbers agree" if agree else "\nTHE NUMBERS DISAGREE")
    return 0 if agree else 1


def contest(problem: Problem) -> bool:
    """Print times and ratios; whether the numbers are right."""
    table = tabulate(problem.values, problem.axes, problem.method)
    out = np.empty_like(problem.points)

    def reusing() -> Array:
        lookup_into(table, problem.points, out)
        return out

    ours = {True: partial(lookup, table, problem.points), False: reusing}
    peers = linear_peers(problem) if problem.method is Method.LINEAR else cubic_peers(problem)
    difference, allowed = difference_of(problem, reusing, peers)
    times = race([*ours.values(), *(peer.work for peer in peers)])
    for peer, spent in zip(peers, times[2:], strict=True):
        our_time = dict(zip(ours, times, strict=False))[peer.fresh]
        ratio = our_time / spent
        met = "yes" if ratio <= peer.wanted else "NO"
        print(
            f"{problem.name:16} {our_time:9.1f}  {peer.name:17} {spent:8.1f} {ratio:7.3f}"
            f"   {peer.wanted:.3f} {met:>3}   {error_of(problem, peer.work):13.1e}"
        )
    print(f"{'':16} our error {error_of(problem, reusing):.1e}, difference {difference:.1e}")
    return difference <= allowed


def race(works: list[Work]) -> list[float]:
    """Median times in ms; rounds are interleaved, after one for warming up."""
    times: list[list[float]] = [[] for _ in works]
    for turn in range(ROUNDS + 1):
        for work, spent in zip(works, times, strict=True):
            if turn > 3 and spent[0] > LONG:
                continue
            start = time.process_time()
            work()
            spent.append(1000.0 * (time.process_time() - start))
    return [statistics.median(spent[1:]) for spent in times]


def problem_of(method: Method, d: int, n: int) -> Problem:
    """The problem in d dimensions."""
    rng = np.random.default_rng(d)
    axes = tuple(Axis(f"x{i}", -1.0, 1.0 + 0.1 * i, n, periodic=False) for i in range(d))
    nodes = [np.linspace(axis.low, axis.high, n) for axis in axes]
    points = np.stack([rng.uniform(axis.low, axis.high, POINTS) for axis in axes], axis=-1)
    values = field(np.stack(np.meshgrid(*nodes, indexing="ij"), axis=-1))
    return Problem(method, axes, nodes, np.ascontiguousarray(values), points)


def field(x: Array) -> Array:
    """A smooth vector field (..., d) at x (..., d)."""
    return np.sin(2.0 * x + np.roll(x, 1, axis=-1)) + 0.3 * x.prod(axis=-1, keepdims=True)


def error_of(problem: Problem, work: Work) -> float:
    """How far from the field itself: a fast method that is wrong has won nothing."""
    return float(np.abs(work() - field(problem.points)).max())


def difference_of(problem: Problem, ours: Work, peers: list[Peer]) -> tuple[float, float]:
    """How far from those who compute the same function, and how far is allowed."""
    if problem.method is Method.LINEAR:
        return max(float(np.abs(ours() - peer.work()).max()) for peer in peers), 1e-12
    exact = tensor_spline(problem)(problem.points[:CHECKED])
    return float(np.abs(ours()[:CHECKED] - exact).max()), 1e-11


def linear_peers(problem: Problem) -> list[Peer]:
    """Those that interpolate linearly."""
    scipy = RegularGridInterpolator(problem.nodes, problem.values)
    return [
        Peer("interpn", each_column(problem, MultilinearRegular), 1 / 2, fresh=False),
        Peer("scipy", partial(scipy, problem.points), 1 / 15, fresh=True),
        *econforge(problem),
    ]


def cubic_peers(problem: Problem) -> list[Peer]:
    """Those that interpolate by cubics; interpn has two kinds."""
    share = 1 / 4 if len(problem.axes) == 4 else 1 / 2
    return [
        Peer("interpn Hermite", each_column(problem, MulticubicRegular), share, fresh=False),
        Peer("interpn B-spline", each_column(problem, MultiBsplineRegular), share, fresh=False),
        *econforge(problem),
    ]


def each_column(problem: Problem, kind: Any) -> Work:
    """Interpn's `kind`, once per column, into memory that is there already."""
    starts = np.array([axis.low for axis in problem.axes])
    steps = np.array([axis.step for axis in problem.axes])
    counts = [axis.count for axis in problem.axes]
    columns = [
        kind.new(counts, starts, steps, np.ascontiguousarray(values).ravel())
        for values in np.moveaxis(problem.values, -1, 0)
    ]
    coordinates = [np.ascontiguousarray(line) for line in problem.points.T]
    out = np.empty((len(columns), POINTS))

    def run() -> Array:
        for column, into in zip(columns, out, strict=True):
            column.eval_unchecked(coordinates, into)
        return out.T

    return run


def econforge(problem: Problem) -> list[Peer]:
    """Econforge's `interpolation`, vector-valued, if it is installed."""
    if find_spec("interpolation") is None:
        return []
    library = import_module("interpolation.splines")
    grid = library.UCGrid(*[(axis.low, axis.high, axis.count) for axis in problem.axes])
    out = np.empty_like(problem.points)
    coefficients, evaluate = problem.values, library.eval_linear
    if problem.method is Method.CUBIC:
        coefficients, evaluate = library.filter_cubic(grid, problem.values), library.eval_cubic

    def run() -> Array:
        evaluate(grid, coefficients, problem.points, out)
        return out

    return [Peer("econforge", run, 1.0, fresh=False)]


def tensor_spline(problem: Problem) -> NdBSpline:
    """Scipy's not-a-knot spline, made axis by axis: the independent reference."""
    knots, coefficients = [], problem.values
    for i, line in enumerate(problem.nodes):
        spline = make_interp_spline(line, np.moveaxis(coefficients, i, 0), k=3)
        coefficients = np.moveaxis(spline.c, 0, i)
        knots.append(spline.t)
    return NdBSpline(tuple(knots), np.ascontiguousarray(coefficients), 3)


if __name__ == "__main__":
    sys.exit(main())
