"""Separatrices of maps."""

from collections.abc import Sequence

from verifier.topology.features import Cycle, FixedPoint, Separatrix
from verifier.topology.local_manifolds import Branch
from verifier.topology.slices import Slice


def map_separatrices(
    view: Slice,
    fixed_points: Sequence[FixedPoint],
    cycles: Sequence[Cycle],
    branches: Sequence[Branch],
) -> tuple[Separatrix, ...]:
    """Nothing yet."""
    del view, fixed_points, cycles, branches
    return ()
