"""The robot with which a procedure is rehearsed: its timing, and what it stands in."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, final


@final
@dataclass(frozen=True, slots=True)
class Robot:
    """A robot that reads every `period` and acts `response_time` later; 0: at once, all the time.

    levels: the values (SI) at which a control is held, of those that are not set freely. reach:
    the range (SI) in which a sensor tells a sensed quantity. noise: the standard deviation (SI) of
    the sensor that tells it. own: the states that are its own account: known to it exactly, and
    moved at its ticks.
    """

    period: float = 0.0
    response_time: float = 0.0
    levels: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    reach: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    noise: Mapping[str, float] = field(default_factory=dict)
    own: frozenset[str] = frozenset()

    @property
    def is_prompt(self) -> bool:
        """Whether it follows the field at once."""
        return self.period == 0.0


PROMPT: Final = Robot()
