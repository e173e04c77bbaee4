"""What decisions were worth: measures of what happened between them, and the reward."""

from collections.abc import Mapping
from functools import cache

import numpy as np

from runtime.arrays import Array, Integers
from runtime.code import Code
from runtime.kernels.tape import Tape
from runtime.machine import evaluate, run_tape
from runtime.tape import pack
from runtime.training import How, Training


def ended_at(training: Training, rows: Array) -> int:
    """The first of the rows (T, q) of the quantities at which the episode is over, or -1."""
    if training.ends_when is None or not len(rows):
        return -1
    over = run_tape(_tape(training.ends_when, training.quantities), rows)[:, 0] >= 0.0
    return int(over.argmax()) if over.any() else -1


def rewards_of(
    training: Training, rows: Array, decided: Integers, robustness: Mapping[str, float]
) -> Array:
    """The reward of each decision, (D,).

    Args:
        training: what is rewarded.
        rows: (T, q or more) its quantities first, after each step of the world.
        decided: (D + 1,) rows at which it was decided, and where the last reward is due.
        robustness: of the whole run, by the text of each requirement that a measure is of.
    """
    own = rows[:, : len(training.quantities)]
    measures = np.zeros((len(decided) - 1, len(training.measures)))
    for place, measure in enumerate(training.measures):
        if measure.requirement is not None:
            measures[-1:, place] = robustness[measure.requirement.text]
        elif measure.code is not None:
            values = evaluate([measure.code], training.quantities, own)[:, 0]
            measures[:, place] = measured(measure.how, values, decided)
    return evaluate([training.reward], training.register, measures)[:, 0]


def measured(how: How, values: Array, decided: Integers) -> Array:
    """One measure (D,) of a quantity (T,) between decisions (D + 1,); each includes its end."""
    first, last = values[decided[:-1]], values[decided[1:]]
    match how:
        case How.RISE:
            return last - first
        case How.FALL:
            return first - last
        case How.LAST:
            return last
    since = values[1 : decided[-1] + 1]
    starts = decided[:-1]
    match how:
        case How.MOST:
            return np.maximum.reduceat(since, starts)
        case How.LEAST:
            return np.minimum.reduceat(since, starts)
    return np.add.reduceat(since, starts) / np.diff(decided)


@cache
def _tape(code: Code, names: tuple[str, ...]) -> Tape:
    """The code, packed once: it is asked at each decision."""
    return pack([code], names, ())
