"""At which controls the features are compared: those that held longest in the trace.

The features of a field are those of fixed controls. A trace with many settings is looked at where
one of them held; the refitted field takes what it learns from all of them.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Kind, Program, State
from verifier.fidelity.stretches.needs import Input, Needs, held, parts_of
from verifier.topology.features import Settings

CELL: Final = 0.02
"""Inputs are told apart by this share of their domains."""
NEAR: Final = 0.01
"""So far from the setting, as a share of its domain, an input still has it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Setting:
    """The values of all controls and of the states that nobody predicts, but the mode; SI.

    holds (T,): at which of the times it was asked for the trace has it.
    """

    values: Settings
    holds: Booleans

    @property
    def share(self) -> float:
        """For how much of the time it holds."""
        return float(np.mean(self.holds)) if len(self.holds) else 0.0


def longest_setting(program: Program, needs: Needs, times: Array) -> Setting:
    """The setting in which the robot was longest, counted at `times` (T,)."""
    inputs = [each for each in needs.inputs if each.name != program.field.mode]
    values = np.stack([_values(each, times) for each in inputs], axis=-1) if inputs else None
    found = dict(_defaults(program, needs))
    holds = np.ones(len(times), dtype=np.bool_)
    if values is not None:
        widths = np.array([_width(program, each) for each in inputs])
        chosen = _commonest(values / widths) * widths
        holds = np.all(np.abs(values - chosen) <= NEAR * widths, axis=-1)
        found |= {
            each.name: float(np.clip(value, each.low, each.high))
            for each, value in zip(inputs, chosen, strict=True)
        }
    return Setting(tuple(sorted(found.items())), holds)


def _commonest(scaled: Array) -> Array:
    """The median of the rows (T, k) in the commonest cell."""
    _, cell, counts = np.unique(
        np.rint(scaled / CELL), axis=0, return_inverse=True, return_counts=True
    )
    inside = cell.ravel() == np.argmax(counts)
    return np.asarray(np.median(scaled[inside], axis=0))


def _values(given: Input, times: Array) -> Array:
    return np.full(len(times), given.value) if given.series is None else held(given.series, times)


def _width(program: Program, given: Input) -> float:
    part = parts_of(program)[given.name]
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        return 1.0
    return part.high - part.low


def _defaults(program: Program, needs: Needs) -> list[tuple[str, float]]:
    """What the field does not read, or the trace does not tell."""
    predicted = {state.name for state in needs.driven}
    states = [
        (state.name, state.hold)
        for state in program.states
        if state.name not in predicted and state.name != program.field.mode
    ]
    return [*states, *((control.name, control.default) for control in program.controls)]
