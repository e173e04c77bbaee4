"""Choice by condition: the first rule that holds, or all layers that want to act."""

from typing import final

import numpy as np

from runtime.arbiter import Arbiter, Rule
from runtime.arbitration.conditions import Conditions
from runtime.arrays import Array
from runtime.code import ONE, Code

NEVER = Code("0")


@final
class Latches:
    """Which rules hold, each by itself (hysteresis and least durations), whatever is chosen.

    A rule holds where its `when` does. Once it holds it goes on: until its `until` does (without
    one: until `when` no longer does), and for at least `lasts` seconds since it began to hold.
    """

    def __init__(self, arbiter: Arbiter) -> None:
        self._rules: tuple[Rule, ...] = arbiter.rules
        codes = [code for rule in arbiter.rules for code in (rule.when or ONE, rule.until or NEVER)]
        self._conditions = Conditions(arbiter, codes)
        self.reset()

    def reset(self) -> None:
        """Let none hold."""
        self._since: list[float | None] = [None for _ in self._rules]

    def holding(self, reads: Array, time: float) -> list[bool]:
        """Whether each rule holds now."""
        values = self._conditions.at(reads).reshape(-1, 2).tolist()
        for place, (rule, (when, until)) in enumerate(zip(self._rules, values, strict=True)):
            since = self._since[place]
            if since is None:
                self._since[place] = time if when != 0.0 else None
                continue
            is_released = when == 0.0 and (rule.until is None or until != 0.0)
            # A hair less, because times are multiples of a step that is no round number.
            if is_released and time - since >= rule.lasts * (1.0 - 1e-9):
                self._since[place] = None
        return [since is not None for since in self._since]


class _ByRules:
    """What decides by rules that latch, each of which has a choice."""

    def __init__(self, arbiter: Arbiter) -> None:
        self._latches = Latches(arbiter)
        self._choices = [rule.choice for rule in arbiter.rules]
        self._count = len(arbiter.choices)

    def reset(self, seed: int) -> None:  # noqa: ARG002  # there is no chance in it
        """Let no rule hold."""
        self._latches.reset()

    def learn(self, reward: float) -> None:
        """Do nothing: rules do not learn."""

    def _holding(self, reads: Array, time: float) -> list[int]:
        """The choices of the rules that hold, in their order."""
        holds = self._latches.holding(reads, time)
        return [choice for choice, held in zip(self._choices, holds, strict=True) if held]


@final
class Rules(_ByRules):
    """Exclusive choice: the first rule that holds has its choice; 0 for all where none does."""

    def decide(self, reads: Array, time: float) -> Array:
        """1 for the choice of the first rule that holds."""
        numbers = np.zeros(self._count)
        numbers[self._holding(reads, time)[:1]] = 1.0
        return numbers


@final
class Subsumption(_ByRules):
    """Layers: each that wants to act is chosen; channels say which has its way (Brooks 1986)."""

    def decide(self, reads: Array, time: float) -> Array:
        """1 for the choice of each layer that holds."""
        numbers = np.zeros(self._count)
        numbers[self._holding(reads, time)] = 1.0
        return numbers
