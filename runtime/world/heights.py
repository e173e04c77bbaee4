"""Heights: which things can touch, as bits of a mask.

Two things touch only where their heights overlap. The physics knows bits alone: two shapes touch
where they share one. One bit for each *largest set of heights that all overlap* is exact, and
needs far fewer bits than one for each centimetre: intervals overlap pairwise exactly where they
share a point, and such a set is full at the lower end of one of them.
"""

from collections.abc import Sequence
from typing import Final

BITS: Final = 32
"""What the physics has."""


def bands(heights: Sequence[tuple[float, float]]) -> tuple[int, ...]:
    """A mask for each (low, high); two have a bit in common exactly where they overlap.

    Heights that only meet (one ends where the other begins) do not overlap.

    >>> [f"{mask:b}" for mask in bands([(0.0, 0.1), (0.15, 0.2), (0.0, 0.3)])]
    ['1', '10', '11']

    Raises:
        ValueError: they are so different that they need more bits than there are.
    """
    sets = _largest(heights)
    if len(sets) > BITS:
        raise ValueError(
            f"the things of this world fill {len(sets)} different ranges of height, and the "
            f"physics tells {BITS} apart: let some of them begin or end at the same height"
        )
    return tuple(
        sum(1 << bit for bit, members in enumerate(sets) if index in members)
        for index in range(len(heights))
    )


def ranges_of(heights: Sequence[tuple[float, float]]) -> int:
    """How many bits they need."""
    return len(_largest(heights))


def _largest(heights: Sequence[tuple[float, float]]) -> list[frozenset[int]]:
    """The largest sets that all overlap, from the lowest up; indices of `heights`."""
    found: list[frozenset[int]] = []
    for level in sorted({low for low, _ in heights}):
        members = frozenset(i for i, (low, high) in enumerate(heights) if low <= level < high)
        if not any(members <= other for other in found):
            found = [other for other in found if not other <= members]
            found.append(members)
    return found
