"""Where on a ladder of sizes the verdict turns."""

from collections.abc import Callable
from typing import Final

LEAP: Final = 4
"""Rungs that are passed over at most on the way up, so that what is caught there is not missed."""


def turning(
    is_caught: Callable[[int], bool], expected: Callable[[int], int], guess: int, rungs: int
) -> tuple[int | None, int | None]:
    """A rung that is missed, and the one above it, which is caught.

    The first is None where even the lowest is caught, the second where the highest is not.
    `expected` says, of a rung that was tried, where the turning is likely to be: a good guess
    saves trials and changes nothing else, as long as larger faults are caught wherever smaller
    ones are. It is taken every other time only, so that bad guesses cost little.
    """
    missed, caught, rung, is_asked = -1, rungs, guess, True
    while True:
        if is_caught(rung):
            caught = rung
        else:
            missed = rung
        if caught - missed <= 1:
            break
        rung = _next(missed, caught, rungs, expected(rung) if is_asked else None)
        is_asked = not is_asked
    return (missed if missed >= 0 else None), (caught if caught < rungs else None)


def _next(missed: int, caught: int, rungs: int, hint: int | None) -> int:
    """The rung to try next, strictly between the two."""
    middle = (missed + caught) // 2
    if caught == rungs:
        middle = min(missed + LEAP, rungs - 1)
    elif missed < 0:
        middle = max(caught - LEAP, 0)
    wanted = middle if hint is None else hint
    highest = min(caught - 1, missed + LEAP) if missed >= 0 else caught - 1
    return min(max(wanted, missed + 1), highest)
