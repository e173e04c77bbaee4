"""Where a behavior's ticks look: from where its states are to where they may be a period on.

A tick takes steps of Runge and Kutta from its sample (`runtime.scheduler.kernels.tick`), whose
weights are not negative. So, while a box is not left, each state moves by no more than the period
times the greatest rate over the box, and to no side to which no rate of the box goes; and each
place that a stage looks at lies within that. If a box holds all that can be come to from the start
under the rates of the box itself, then by induction over the stages no stage leaves it. A jump
begins anew from where it lands. Roundings are below 2**-40 of what is added up.
"""

from typing import Final

from compiler.architecture.exclusion.ranges import Box, hull, jumps_over, rates_over
from compiler.architecture.exclusion.table_ranges import ROUNDED, Ends
from runtime.program import Program

ROUNDS: Final = 12
"""Tries to find a box that is not left within a period."""
ROOM: Final = 0.5
"""How much farther the next try goes, so that it may do."""


def within_a_period(program: Program, start: Box, period: float) -> Box | None:
    """A box that no state leaves within a period from `start`; None where none was found."""
    box = dict(start)
    for _ in range(ROUNDS):
        wider = _come_to(program, start, box, period)
        if wider is None:
            return None
        if all(box[n][0] <= low and high <= box[n][1] for n, (low, high) in wider.items()):
            return box
        box = {name: _farther(start[name], ends) for name, ends in wider.items()}
    return None


def _come_to(program: Program, start: Box, box: Box, period: float) -> Box | None:
    """Where states can be within a period from `start`, by the rates and jumps of a box."""
    wider = dict(start)
    for name, ends in jumps_over(program, box).items():
        if ends is None:
            return None
        wider[name] = hull(wider[name], ends)
    for name, ends in rates_over(program, box).items():
        if ends is None:
            return None
        wider[name] = _moved(wider[name], ends, period)
    return wider


def _moved(ends: Ends, rates: Ends, period: float) -> Ends:
    """The ends, after a period of rates; a side to which no rate goes stays where it is."""
    low, high = ends
    least, most = min(rates[0], 0.0) * period, max(rates[1], 0.0) * period
    if least < 0.0:
        low += least - ROUNDED * (abs(low) - least)
    if most > 0.0:
        high += most + ROUNDED * (abs(high) + most)
    return low, high


def _farther(start: Ends, ends: Ends) -> Ends:
    low, high = ends
    return low - ROOM * (start[0] - low), high + ROOM * (high - start[1])
