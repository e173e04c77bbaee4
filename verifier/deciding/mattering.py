"""Which of what an arbiter reads matters most: how often another value of it alone decides else.

This is the total effect of Sobol's analysis for a decision: both at random over the domains.
"""

from collections.abc import Collection
from typing import Final

import numpy as np

from runtime.arbiter import Arbiter, Read
from runtime.arrays import Array
from verifier.deciding.conditions import Values
from verifier.deciding.rulings import register_at, rulings_at

POINTS: Final = 8192
SEED: Final = 20261123


def mattering(arbiter: Arbiter, held: Values, among: Collection[str]) -> dict[str, float]:
    """By read, the share of situations in which another value of it alone changes the choice.

    held: SI; stays as it is. among: the reads that are asked for. The same numbers every time.
    """
    generator = np.random.Generator(np.random.Philox(SEED))
    points = np.tile(register_at(arbiter, held), (POINTS, 1))
    free = [read for read in arbiter.reads if read.name not in held]
    for read in free:
        points[:, arbiter.register.index(read.name)] = _drawn(read, generator)
    before = [ruling.choices for ruling in rulings_at(arbiter, points)]
    shares = {}
    for read in free:
        if read.name not in among:
            continue
        moved = points.copy()
        moved[:, arbiter.register.index(read.name)] = _drawn(read, generator)
        after = [ruling.choices for ruling in rulings_at(arbiter, moved)]
        shares[read.name] = sum(a != b for a, b in zip(before, after, strict=True)) / POINTS
    return shares


def _drawn(read: Read, generator: np.random.Generator) -> Array:
    if read.values:
        return generator.integers(0, len(read.values), POINTS).astype(np.float64)
    return generator.uniform(read.low, read.high, POINTS)
