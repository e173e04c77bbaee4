"""Portraits made by hand: everything that can be drawn, each in a known number and place."""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array, frozen
from runtime.program import Unit
from verifier.topology.branches.continuation import (
    Bifurcation,
    Branches,
    Change,
    CycleBranch,
    PointBranch,
)
from verifier.topology.features import (
    Attractor,
    AxisRange,
    Basins,
    Completeness,
    Cycle,
    FixedPoint,
    Grid,
    Held,
    PointKind,
    Portrait,
    Reaches,
    Separatrix,
    Stability,
    Standing,
    Switching,
    Trajectory,
    UndecidedBox,
)

CM = Unit("cm", 0.01)
NONE = Unit("1", 1.0)
X = AxisRange("x", CM, -0.02, 0.02, periodic=False)
V = AxisRange("v", NONE, -2.0, 2.0, periodic=False)


def point(
    at: tuple[float, ...],
    kind: PointKind,
    standing: Standing = Standing.SHARED,
    *,
    proved: bool = True,
) -> FixedPoint:
    m = len(at)
    return FixedPoint(
        frozen(at), kind, (1.0 + 0j,) * m, (), None, (), proved, proved,
        frozen(np.full(m, 1e-9)), standing,
    )  # fmt: skip


def circle(radius: float, stability: Stability, modes: tuple[int, ...] = ()) -> Cycle:
    t = np.linspace(0.0, 1.0, 101)
    points = radius * np.stack([0.01 * np.cos(2 * np.pi * t), -np.sin(2 * np.pi * t)], axis=-1)
    return Cycle(
        frozen(3.0 * t), frozen(points), 3.0, stability, (0.5 + 0j,), (0.5 + 0j,),
        doubtful=False, turns=(0, 0), modes=modes,
    )  # fmt: skip


def jumping() -> Cycle:
    """A square in x and v whose upright sides are jumps."""
    x = np.array([-0.01, 0.0, 0.01, 0.01, 0.0, -0.01, -0.01])
    v = np.array([1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    t = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 4.0, 4.0])
    points = frozen(np.stack([x, v], axis=-1))
    return replace(
        circle(1.0, Stability.STABLE), times=frozen(t), points=points, period=4.0,
        modes=(0, 0, 0, 1, 1, 1, 0),
    )  # fmt: skip


def branch(reaches: Reaches, to: int, times: Array, points: Array, *, stable: bool) -> Separatrix:
    return Separatrix(1, stable, reaches, to, times, points)


def field() -> Grid:
    nodes = (frozen(np.linspace(-0.02, 0.02, 33)), frozen(np.linspace(-2.0, 2.0, 33)))
    x, v = np.meshgrid(*nodes, indexing="ij")
    return Grid(nodes, frozen(np.stack([0.01 * v, -100.0 * x], axis=-1)))


def basins() -> Basins:
    centres = tuple(frozen((np.arange(20) + 0.5) / 20 * a.width + a.low) for a in (X, V))
    labels = np.zeros((20, 20), dtype=np.int64)
    labels[10:] = 1
    labels[:, 18:] = -1
    labels[:, :1] = -2
    attractors = (
        Attractor(is_cycle=False, index=0, share=0.425),
        Attractor(is_cycle=True, index=0, share=0.425),
    )
    return Basins(centres, labels, attractors, leaves=0.1, open=0.05)


def everything() -> Portrait:
    """One of each thing."""
    line = frozen(np.stack([np.linspace(-0.02, 0.02, 50), np.linspace(-1, 1, 50)], axis=-1))
    times = frozen(np.linspace(0.0, 1.0, 50))
    return Portrait(
        name="all_at_once",
        about="One of each thing.",
        axes=(X, V),
        held=(Held("mu", NONE, 0.5, ""), Held("going", NONE, 0.0, "forward")),
        every=0.0,
        field=field(),
        nullclines=(),
        fixed_points=(
            point((-0.01, 0.0), PointKind.STABLE_NODE),
            point((0.0, 0.0), PointKind.SADDLE, Standing.INVENTED),
            point((0.01, 0.5), PointKind.DEGENERATE, Standing.UNCOMPARED, proved=False),
        ),
        completeness=Completeness(
            complete=False,
            undecided=(UndecidedBox(frozen([0.009, 0.4]), frozen([0.011, 0.6])),),
            lost=frozen([[0.005, -1.0]]),
            about="the tables",
        ),
        cycles=(circle(1.2, Stability.STABLE), circle(0.6, Stability.UNSTABLE)),
        separatrices=(
            branch(Reaches.EDGE, -1, times, line, stable=True),
            branch(Reaches.POINT, 0, times, line, stable=False),
            branch(Reaches.CYCLE, 0, times, line, stable=False),
        ),
        basins=basins(),
        switching=(Switching("forward", "back", (frozen([[0.01, -2.0], [0.01, 2.0]]),)),),
        trajectories=(Trajectory(times, line, 0),),
        notes=("a note",),
    )


def branches() -> Branches:
    """A Hopf bifurcation at 0.5, and a saddle and a node that meet at 0.8."""
    mu = frozen(np.linspace(0.0, 1.0, 11))
    early = frozen(np.linspace(0.0, 0.8, 9))
    late = frozen(np.linspace(0.5, 1.0, 6))
    kinds = (PointKind.STABLE_FOCUS,) * 5 + (PointKind.UNSTABLE_FOCUS,) * 6
    reach = np.sqrt(late - 0.5)[:, None] * np.array([0.01, 1.0])
    return Branches(
        name="bifurcating",
        about="",
        control="mu",
        unit=NONE,
        low=0.0,
        high=1.0,
        axes=(X, V),
        held=(),
        values=mu,
        points=(
            PointBranch(mu, frozen(np.zeros((11, 2))), kinds),
            PointBranch(early, frozen(np.full((9, 2), 0.01)), (PointKind.SADDLE,) * 9),
        ),
        cycles=(
            CycleBranch(
                late, frozen(-reach), frozen(reach), frozen(np.full(6, 3.0)),
                (Stability.STABLE,) * 6,
            ),
        ),
        bifurcations=(
            Bifurcation(Change.HOPF, 0.5, 1e-4, frozen([0.0, 0.0]), "a focus loses its hold"),
            Bifurcation(Change.SADDLE_NODE, 0.8, 1e-4, frozen([0.01, 0.01]), "a saddle meets"),
        ),
        notes=(),
    )  # fmt: skip
