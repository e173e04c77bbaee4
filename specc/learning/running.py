"""How runs go on: in pieces, between which they are told of, kept, and may be stopped."""

from collections.abc import Callable
from time import perf_counter
from typing import Final

from specc.learning.courses import Piece
from specc.learning.run import Pupil, Run

ATTENTION: Final = 0.1
"""Seconds between two looks at whether it shall stop."""

AT_ONCE: Final = 10, 100, 100_000
"""Cycles between two such looks: the fewest, those at first, and the most."""

KEPT_EVERY: Final = 5.0
"""Seconds between two checkpoints."""


def go_on(
    run: Run[Pupil, Piece],
    advance: Callable[[Run[Pupil, Piece], int], float],
    cycles: int,
    *,
    tell: Callable[[Run[Pupil, Piece]], None],
    keep: Callable[[Run[Pupil, Piece]], None],
    shall_stop: Callable[[], bool],
) -> None:
    """Learn until `cycles` are done, or it shall stop.

    advance: learns from so many at most, and says how many seconds that took. tell: is called some
    times a second. keep: now and then, and at the end.
    """
    kept = perf_counter()
    at_once = AT_ONCE[1]
    while run.done < cycles and not shall_stop():
        took = advance(run, min(at_once, cycles - run.done))
        at_once = next_at_once(at_once, took)
        tell(run)
        if perf_counter() - kept > KEPT_EVERY:
            keep(run)
            kept = perf_counter()
    keep(run)


def next_at_once(cycles: int, took: float) -> int:
    """How many cycles to learn at once, after so many took so many seconds.

    >>> next_at_once(100, 0.2), next_at_once(100, 0.001), next_at_once(80_000, 0.001)
    (50, 200, 100000)
    """
    fewest, _, most = AT_ONCE
    return min(most, max(fewest, int(cycles * min(2.0, ATTENTION / max(took, 1e-4)))))
