"""The fewest sets that cover what all of them cover."""

from typing import Final

import numpy as np

from lcs.arrays import Array, Booleans

LOOKS: Final = 20_000
"""At sets, in the search for a smaller cover; where they end, the best so far is taken."""


def smallest_cover(held: Booleans, worth: Array) -> list[int]:
    """Which of the sets held (C, T) to take, so that all that any holds is still held.

    Essential sets first; then the fewest of the others, found by branch and bound from a greedy
    cover (Chvatal 1979). Of equals, those of greater worth (C,). Ascending.
    """
    order = sorted(range(len(held)), key=lambda c: (-float(worth[c]), c))
    classes = np.unique(np.packbits(held[order][:, held.any(axis=0)], axis=0).T, axis=0)
    bits = np.unpackbits(classes, axis=1)[:, : len(order)].astype(np.bool_)
    sets = [_as_bits(column) for column in bits.T]
    whole = _as_bits(np.ones(len(bits), np.bool_))
    taken = _essential(sets, bits)
    left = whole
    for c in taken:
        left &= ~sets[c]
    free = _largest([c for c in range(len(sets)) if c not in taken], left, sets)
    more = _searched(left, sets, free)
    return sorted(order[c] for c in _without_spare([*taken, *more], sets))


def _as_bits(members: Booleans) -> int:
    """A set as one integer."""
    return int.from_bytes(np.packbits(members).tobytes(), "big")


def _essential(sets: list[int], bits: Booleans) -> list[int]:
    """The sets that alone hold something."""
    alone = bits[bits.sum(axis=1) == 1]
    found = alone.any(axis=0)
    return [c for c in range(len(sets)) if found[c]]


def _largest(free: list[int], left: int, sets: list[int]) -> list[int]:
    """Those of the free sets that hold something left, and no less than another of them does."""
    kept: list[int] = []
    for c in sorted(free, key=lambda c: (-(sets[c] & left).bit_count(), c)):
        held = sets[c] & left
        if held and all(held & ~sets[other] for other in kept):
            kept.append(c)
    return sorted(kept)


def _greedy(left: int, sets: list[int], free: list[int]) -> list[int]:
    taken = []
    while left:
        best = max(free, key=lambda c: (sets[c] & left).bit_count())
        taken.append(best)
        left &= ~sets[best]
    return taken


def _searched(left: int, sets: list[int], free: list[int]) -> list[int]:
    """The fewest of the free sets that hold all that is left."""
    best = _greedy(left, sets, free)
    steps = LOOKS // max(len(free), 1)
    stack: list[tuple[int, list[int]]] = [(left, [])]
    while stack and steps > 0:
        steps -= 1
        rest, taken = stack.pop()
        if not rest:
            best = taken if len(taken) < len(best) else best
            continue
        most = max((sets[c] & rest).bit_count() for c in free)
        if len(taken) + -(-rest.bit_count() // most) >= len(best):
            continue
        member = 1 << (rest.bit_length() - 1)
        ways = [c for c in free if sets[c] & member]
        ways.sort(key=lambda c: ((sets[c] & rest).bit_count(), -c))
        stack += [(rest & ~sets[c], [*taken, c]) for c in ways]
    return best


def _without_spare(taken: list[int], sets: list[int]) -> list[int]:
    """Those without which something would not be held, the last looked at first."""
    kept = list(taken)
    for c in reversed(taken):
        others = 0
        for other in kept:
            others |= sets[other] if other != c else 0
        if sets[c] & ~others == 0:
            kept.remove(c)
    return kept
