"""When a path has come to its end: in a trap that nothing leaves, or close to a cycle."""

from collections.abc import Sequence
from typing import Final, TypeAlias

import numpy as np

from verifier.topology.ends.lyapunov import Ellipsoid, ellipsoid_round
from verifier.topology.ends.spirals import Spiral, spiral_round
from verifier.topology.ends.tubes import Tube, tube_round
from verifier.topology.features import Cycle, FixedPoint, PointKind, Stability
from verifier.topology.slices import Slice

Trap: TypeAlias = Ellipsoid | Spiral
"""A region round a fixed point that nothing leaves, and in which everything goes there."""

STABLE: Final = frozenset({PointKind.STABLE_NODE, PointKind.STABLE_FOCUS})
UNSTABLE: Final = frozenset({PointKind.UNSTABLE_NODE, PointKind.UNSTABLE_FOCUS})
UNCLEAR: Final = frozenset({PointKind.CENTER, PointKind.DEGENERATE})
"""What the linearisation leaves open; a path that spirals round it may tell."""

DRAWS: Final = {
    1: frozenset({Stability.STABLE, Stability.SEMI_STABLE}),
    -1: frozenset({Stability.UNSTABLE, Stability.SEMI_STABLE}),
}
"""Cycles that paths may come to, forward and backward in time."""


def traps_of(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], sign: int
) -> tuple[Trap, ...]:
    """The traps round fixed points for paths forward in time or, where `sign` is -1, backward.

    A fixed point may have two, or none although it attracts.
    """
    kinds = STABLE if sign > 0 else UNSTABLE
    others = np.concatenate([*(p.at[None] for p in fixed_points), *(c.points for c in cycles)])
    found: list[Trap | None] = []
    for index, point in enumerate(fixed_points):
        if point.kind in kinds:
            found.append(ellipsoid_round(view, index, point.at, others, sign))
        if point.kind in kinds | UNCLEAR:
            found.append(spiral_round(view, index, point, others, sign))
    return tuple(trap for trap in found if trap is not None)


def tubes_of(
    view: Slice, fixed_points: Sequence[FixedPoint], cycles: Sequence[Cycle], sign: int
) -> tuple[Tube, ...]:
    """The neighbourhoods of the cycles that paths come to when followed in this direction."""
    return tuple(
        tube_round(view, index, fixed_points, cycles)
        for index, cycle in enumerate(cycles)
        if cycle.stability in DRAWS[sign]
    )
