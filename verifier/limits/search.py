"""Where on a ladder of sizes the verdict turns."""

from collections.abc import Callable


def turning(
    is_caught: Callable[[int], bool], expected: Callable[[int], int], guess: int, rungs: int
) -> tuple[int | None, int | None]:
    """The highest rung that is missed, and the one above it, which is caught.

    The first is None where even the lowest is caught, the second where the highest is not.
    `expected` says, of a rung that was tried, where the turning is likely to be: a good guess
    saves trials and changes nothing else, as long as larger faults are caught wherever smaller
    ones are.
    """
    missed, caught = _placed(is_caught, guess, None, None)
    better = min(max(expected(guess), 0), rungs - 1)
    if (missed is None or better > missed) and (caught is None or better < caught):
        missed, caught = _placed(is_caught, better, missed, caught)
    stride = 1
    while caught is None and missed is not None and missed < rungs - 1:
        missed, caught = _placed(is_caught, min(missed + stride, rungs - 1), missed, caught)
        stride *= 2
    while missed is None and caught is not None and caught > 0:
        missed, caught = _placed(is_caught, max(caught - stride, 0), missed, caught)
        stride *= 2
    while missed is not None and caught is not None and caught - missed > 1:
        missed, caught = _placed(is_caught, (caught + missed) // 2, missed, caught)
    return missed, caught


def _placed(
    is_caught: Callable[[int], bool], rung: int, missed: int | None, caught: int | None
) -> tuple[int | None, int | None]:
    return (missed, rung) if is_caught(rung) else (rung, caught)
