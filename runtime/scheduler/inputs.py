"""Wires into a node: where each entry of its register comes from at its ticks."""

from collections.abc import Callable, Mapping, Sequence
from typing import Final, TypeAlias, final

import numpy as np

from runtime.architecture import Input, Outside
from runtime.arrays import Array, Booleans, Integers
from runtime.direct_calls import machine_code
from runtime.kernels.blocks import LARGEST
from runtime.program import Kind
from runtime.scheduler.kernels.wires import read

Domain: TypeAlias = tuple[float, float, float]
"""The least and the greatest value of an entry, and its turn (0: not periodic)."""

ANY: Final[Domain] = (-LARGEST, LARGEST, 0.0)
"""The domain of what may be any finite number."""


def domain_of(kind: Kind, low: float, high: float) -> Domain:
    """The domain of an entry; an angle from elsewhere is turned into its own range."""
    return low, high, high - low if kind is Kind.PERIODIC else 0.0


@final
class Inputs:
    """The inputs of one node, as arrays over its m wires; choices may set some for a while.

    signals: places on the board, -1 for a value. low, high: the domains of the entries.
    turns: of those that are periodic, by how much readings are turned into the domain; else 0.
    inhibits: whether a reading outside keeps the node from acting; else it is clipped.
    """

    def __init__(self, wires: Sequence[Input], domains: Mapping[str, Domain]) -> None:
        self.entries = tuple(wire.entry for wire in wires)
        self.signals: Integers = np.array([wire.signal for wire in wires], dtype=np.int64)
        self.values: Array = np.array([wire.value for wire in wires], dtype=np.float64)
        self.scales: Array = np.array([wire.scale for wire in wires], dtype=np.float64)
        limits = [domains.get(wire.entry, ANY) for wire in wires]
        self.low: Array = np.array([low for low, _, _ in limits], dtype=np.float64)
        self.high: Array = np.array([high for _, high, _ in limits], dtype=np.float64)
        self.turns: Array = np.array([turn for _, _, turn in limits], dtype=np.float64)
        self.inhibits: Booleans = np.array(
            [wire.outside is Outside.INHIBIT for wire in wires], dtype=np.bool_
        )
        self._read: Callable[..., bool] | None = None
        self._wired = (self.signals.copy(), self.values.copy())

    def set(self, entry: str, value: float | None) -> None:
        """Let an entry have a value instead of what it is wired to; None undoes that."""
        place = self.entries.index(entry)
        if value is None:
            self.signals[place], self.values[place] = (wired[place] for wired in self._wired)
        else:
            self.signals[place], self.values[place] = -1, value

    def read(self, board: Array) -> tuple[Array, bool]:
        """The values (m,) of the entries now, and whether none of them keeps it from acting."""
        found = np.empty(len(self.entries))
        given = (
            board,
            self.signals,
            self.scales,
            self.values,
            self.low,
            self.high,
            self.turns,
            self.inhibits,
            found,
        )
        if self._read is None:
            self._read = machine_code(read, given)
        return found, self._read(*given)
