"""A trace: what was measured, in SI units, with every loss counted."""

from dataclasses import dataclass
from typing import Final, final

from runtime.arrays import Array

TICKS: Final = "ticks"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Series:
    """One measured quantity: `times` (T,) seconds, strictly increasing; `values` (T,) SI.

    Angles of periodic states are unwrapped. `delay`, `scale`, `offset` and the unit of the
    binding are already applied. `clock` says which stamp the times are: `sensor` or `log`, or
    `ticks` where a node of an architecture wrote down what it sampled. `logged`: of an angle that
    was logged beyond its range, the values before they were unwrapped.
    """

    name: str
    times: Array
    values: Array
    path: str
    clock: str
    logged: Array | None = None

    @property
    def was_acted_on(self) -> bool:
        """Whether these are the very values that the robot acted on, at its own ticks."""
        return self.clock == TICKS


@final
@dataclass(frozen=True, slots=True)
class Loss:
    """Something in the log that could not be used: its cause, how often, and where."""

    cause: str
    count: int
    detail: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trace:
    """A log, read for one program: a series for each variable that it holds.

    constants: SI values of variables that the spec declares constant instead of logged.
    start: the time of the first sample, seconds since the epoch of the log's clock; the times
    of all series count from it.
    """

    source: str
    series: dict[str, Series]
    constants: dict[str, float]
    start: float
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]
