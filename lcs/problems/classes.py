"""Problems by formula: inputs uniform in a unit cube, of which a rule tells the class."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.inputs import Input
from lcs.problems.rewards import rewards_of

SKEWED: Final = (0.25, 0.75)
"""The thresholds of experiment 2, in alternate dimensions (4.4)."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Classes:
    """Inputs, uniform in [0, 1)^n, whose class `label` tells, of so many `classes`.

    flipped: the chance that a reward is the other one.
    """

    name: str
    inputs: int
    classes: int
    label: Callable[[Array], Integers]
    flipped: float = 0.0

    @property
    def described(self) -> tuple[Input, ...]:
        """x1, x2 and so on, from 0 to 1."""
        return tuple(Input(f"x{i + 1}", low=0.0, high=1.0) for i in range(self.inputs))

    @property
    def labels(self) -> tuple[str, ...]:
        """Each a number: class 0, class 1 and so on."""
        return tuple(f"class {each}" for each in range(self.classes))

    def drawn(self, count: int, chance: np.random.Generator) -> tuple[Array, Array, Integers]:
        """So many inputs (T, n), the rewards of all classes (T, A) and the right ones (T,)."""
        x = chance.random((count, self.inputs))
        right = self.label(x)
        return x, rewards_of(right, self.classes, self.flipped, chance), right

    def fresh(self, count: int, chance: np.random.Generator) -> tuple[Array, Integers]:
        """So many inputs (T, n) and their right classes (T,), where no reward is flipped."""
        x = chance.random((count, self.inputs))
        return x, self.label(x)


def multiplexer(address: int, thresholds: tuple[float, ...] = (0.5,)) -> Classes:
    """The real multiplexer (Wilson 2000) of so many address bits; thresholds are taken in turn.

    Experiment 1 of the thesis is `multiplexer(2)`, experiment 2 `multiplexer(2, SKEWED)`.
    """
    n = address + 2**address
    at = np.resize(np.array(thresholds), n)

    def label(x: Array) -> Integers:
        bits = (x >= at).astype(np.int64)
        asked = bits[:, :address] @ (1 << np.arange(address)[::-1])
        return np.asarray(bits[np.arange(len(x)), address + asked])

    return Classes(f"multiplexer_{n}", n, 2, label)


def checkerboard(divisions: int, inputs: int = 2) -> Classes:
    """Fields of alternate colors, so many along each input (Stone and Bull 2003)."""

    def label(x: Array) -> Integers:
        fields = np.floor(x * divisions).astype(np.int64)
        return np.asarray(fields.sum(axis=1) % 2)

    return Classes("checkerboard_" + "x".join([str(divisions)] * inputs), inputs, 2, label)
