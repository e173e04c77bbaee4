"""An arbiter of the user's own: a function, or a class of the shape of `protocol.Arbiter`."""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arbitration.conditions import entries_of
from runtime.arrays import Array
from runtime.user_code import Callee, UserCodeError, call


@final
class FunctionArbiter:
    """`function(reads, time)`, which returns a choice, or a number of 0 or more for some choices.

    reads: a mapping, which cannot be changed, from the names of reads and controls to floats.
    """

    def __init__(self, arbiter: Arbiter, function: Callee) -> None:
        self._text, self._function = arbiter.module, function
        self._names = entries_of(arbiter)
        self._choices = arbiter.choices

    def reset(self, seed: int) -> None:
        """Do nothing: a function keeps nothing."""

    def decide(self, reads: Array, time: float) -> Array:
        """What the function says.

        Raises:
            UserCodeError: it raised, or returned something else.
        """
        frozen = MappingProxyType(dict(zip(self._names, reads.tolist(), strict=True)))
        answer = call(self._text, self._function, frozen, time)
        numbers = {answer: 1.0} if isinstance(answer, str) else answer
        if not isinstance(numbers, Mapping) or not set(numbers) <= set(self._choices):
            raise UserCodeError(
                f"{self._text} must return one of {', '.join(self._choices)}, or a dict with a "
                f"number for each (got {answer!r:.60})"
            )
        return np.array([self._number(numbers.get(choice, 0.0)) for choice in self._choices])

    def learn(self, reward: float) -> None:
        """Do nothing: what learns is a class."""

    def _number(self, value: object) -> float:
        if isinstance(value, int | float) and math.isfinite(value) and value >= 0:
            return float(value)
        raise UserCodeError(f"{self._text} gave {value!r:.60}, which is no number of 0 or more")


@final
class ObjectArbiter:
    """An object of the user's that has the shape of an arbiter; its answers are checked.

    It is made by `cls(reads, choices)`, from the names of reads and controls, and of choices.
    """

    def __init__(self, arbiter: Arbiter, cls: Callee) -> None:
        self._text, self._count = arbiter.module, len(arbiter.choices)
        names = entries_of(arbiter)
        self._object = call(self._text, cls, names, arbiter.choices)

    def reset(self, seed: int) -> None:
        """Pass it on."""
        self._call("reset", seed)

    def decide(self, reads: Array, time: float) -> Array:
        """What the object says.

        Raises:
            UserCodeError: it raised, or returned something else than k numbers of 0 or more.
        """
        answer = self._call("decide", reads.copy(), time)
        try:
            numbers = np.array(answer, dtype=np.float64)
        except (TypeError, ValueError):
            numbers = np.empty(0)
        if numbers.shape != (self._count,) or not (numbers >= 0.0).all() or np.isinf(numbers).any():
            raise UserCodeError(
                f"{self._text} must decide with {self._count} numbers of 0 or more "
                f"(got {answer!r:.60})"
            )
        return numbers

    def learn(self, reward: float) -> None:
        """Pass it on."""
        self._call("learn", reward)

    def _call(self, method: str, *arguments: object) -> object:
        function = getattr(self._object, method, None)
        if function is None:
            raise UserCodeError(f"{self._text} has no method {method}: an arbiter has one")
        return call(f"{self._text}.{method}", function, *arguments)
