"""Values of an input on either side of each threshold at which a behavior changes its mode."""

from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.flow import flow_of
from runtime.machine import evaluate
from runtime.program import Control, Program, State

PLACES: Final = 2000
"""Where a condition is looked at along one input, evenly and by decades."""
DECADES: Final = 6.0
ASIDE: Final = 0.1
"""A value stands so far from its threshold, as a share of the range,"""
HALFWAY: Final = 0.5
"""or in the middle between the threshold and the end of the range, if that is nearer."""


def threshold_levels(program: Program, part: State | Control) -> tuple[float, ...]:
    """Values (SI) of `part` beside the thresholds of all ways out of modes, all else at default."""
    found: set[float] = set()
    for guard in program.field.guards:
        if part.name in guard.condition.tokens:
            for threshold in _thresholds(program, guard.condition, part):
                found.update(_beside(threshold, part))
    return tuple(sorted(found))


def _thresholds(program: Program, condition: Code, part: State | Control) -> Array:
    """Where the condition changes its sign along the range of one input."""
    width = part.high - part.low
    values = np.unique(
        np.concatenate(
            [
                np.linspace(part.low, part.high, PLACES),
                part.low + width * np.logspace(-DECADES, 0.0, PLACES),
            ]
        )
    )
    defaults = flow_of(program).defaults
    register = np.tile(defaults, (values.size, 1))
    register[:, program.register.index(part.name)] = values
    is_open = evaluate([condition], program.register, register)[:, 0] >= 0.0
    places = np.flatnonzero(is_open[1:] != is_open[:-1])
    return np.asarray(0.5 * (values[places] + values[places + 1]))


def _beside(threshold: float, part: State | Control) -> tuple[float, float]:
    room = min(threshold - part.low, part.high - threshold)
    aside = min(ASIDE * (part.high - part.low), HALFWAY * room)
    return threshold - aside, threshold + aside
