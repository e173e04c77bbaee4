"""At which controls the features are compared: those that held longest in the trace.

The features of a field are those of fixed controls. A trace with many settings is looked at where
one of them held; the refitted field takes what it learns from all of them.

An input that only passes a value, as a sine does at its turning points, does not hold it: over a
few horizons its mean must stay the same but for its noise.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Kind, Program, State
from verifier.fidelity.stretches.needs import Input, Needs, held, parts_of
from verifier.flags import runs_of
from verifier.topology.features import Settings

CELL: Final = 0.02
"""Inputs are told apart by this share of their domains."""
NEAR: Final = 0.01
"""So far from the setting, as a share of its domain, an input still has it."""
FEWEST: Final = 3
"""Samples in a third of a span."""
STILL: Final = 3.0
"""An input that holds does so for at least so many horizons."""
SURE: Final = 4.0
"""Deviations of the difference of two means that are put down to noise."""
SHARP: Final = 3.0
"""Of that: so far aside is an input before or after it holds."""
ROUNDING: Final = 1e-6
"""Of a domain."""
SECOND: Final = 0.6745 * np.sqrt(6.0)
"""The median size of second differences of white noise, in its standard deviations."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Setting:
    """The values of all controls and of the states that nobody predicts, but the mode; SI.

    varied: those of them that changed in the trace. holds (T,): at which of the times that were
    asked for the trace holds it; nowhere, where the inputs kept changing.
    """

    values: Settings
    varied: Settings
    holds: Booleans

    @property
    def share(self) -> float:
        """For how much of the time it holds."""
        return float(np.mean(self.holds)) if len(self.holds) else 0.0


def longest_setting(program: Program, needs: Needs, times: Array, horizon: float) -> Setting:
    """The setting in which the robot was longest, counted at `times` (T,)."""
    inputs = [each for each in needs.inputs if each.name != program.field.mode]
    found = dict(_defaults(program, needs))
    if not inputs or not len(times):
        return Setting(tuple(sorted(found.items())), (), np.ones(len(times), dtype=np.bool_))
    values = np.stack([_values(each, times) for each in inputs], axis=-1)
    widths = np.array([_width(program, each) for each in inputs])
    still = np.ones(len(times), dtype=np.bool_)
    for column, width, each in zip(values.T, widths, inputs, strict=True):
        if not _is_discrete(program, each) and _varies(column, width):
            still &= _stands_still(times, column, width, STILL * horizon)
    chosen = _commonest((values[still] if np.any(still) else values) / widths) * widths
    holds = still & np.all(np.abs(values - chosen) <= NEAR * widths, axis=-1)
    told = {
        each.name: float(np.clip(value, each.low, each.high))
        for each, value in zip(inputs, chosen, strict=True)
    }
    varied = [
        (each.name, told[each.name])
        for each, column, width in zip(inputs, values.T, widths, strict=True)
        if _varies(column, width)
    ]
    return Setting(tuple(sorted((found | told).items())), tuple(sorted(varied)), holds)


def _varies(values: Array, width: float) -> bool:
    low, high = np.quantile(values, [0.005, 0.995])
    return bool(high - low > 2.0 * NEAR * width)


def _stands_still(times: Array, values: Array, width: float, seconds: float) -> Booleans:
    """Where the input lies in a span of `seconds` whose thirds have one mean, but for noise.

    The crest of a slow wave may look so, too; but what is held is taken up or left at once.
    """
    third = max(FEWEST, int(np.ceil(seconds / 3.0 / np.median(np.diff(times)))))
    found = np.zeros(len(values), dtype=np.bool_)
    if len(values) < 3 * third:
        return found
    noise = float(np.median(np.abs(np.diff(values, 2)))) / SECOND
    sums = np.concatenate([[0.0], np.cumsum(values - values[0])])
    means = (sums[third:] - sums[:-third]) / third
    three = np.stack([means[: -2 * third], means[third:-third], means[2 * third :]])
    allowed = max(SURE * noise * np.sqrt(2.0 / third), ROUNDING * width)
    for first, last in runs_of(np.ptp(three, axis=0) <= allowed):
        low, high = first, last - 1 + 3 * third
        place = np.mean(values[low:high])
        aside = (values[max(low - third, 0) : low], values[high : high + third])
        found[low:high] |= any(
            len(part) and abs(np.mean(part) - place) > SHARP * allowed for part in aside
        )
    return found


def _commonest(scaled: Array) -> Array:
    """The median of the rows (T, k) in the commonest cell, of two grids of cells."""
    best = np.zeros(len(scaled), dtype=np.bool_)
    for offset in (0.0, 0.5):
        cells = np.rint(scaled / CELL + offset)
        _, cell, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
        inside = cell.ravel() == np.argmax(counts)
        best = inside if np.sum(inside) > np.sum(best) else best
    return np.asarray(np.median(scaled[best], axis=0))


def _values(given: Input, times: Array) -> Array:
    return np.full(len(times), given.value) if given.series is None else held(given.series, times)


def _width(program: Program, given: Input) -> float:
    part = parts_of(program)[given.name]
    return 1.0 if _is_discrete(program, given) else part.high - part.low


def _is_discrete(program: Program, given: Input) -> bool:
    part = parts_of(program)[given.name]
    return isinstance(part, State) and part.kind is Kind.DISCRETE


def _defaults(program: Program, needs: Needs) -> list[tuple[str, float]]:
    """What the field does not read, or the trace does not tell."""
    predicted = {state.name for state in needs.driven}
    states = [
        (state.name, state.hold)
        for state in program.states
        if state.name not in predicted and state.name != program.field.mode
    ]
    return [*states, *((control.name, control.default) for control in program.controls)]
