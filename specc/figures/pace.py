"""How fast a run is shown: in step with a clock on the wall, and not more often than one sees."""

import math
import time
from collections.abc import Callable
from typing import Final, final

RATE: Final = 12.0
"""Pictures per second of a clock on the wall."""


@final
class Pace:
    """Waits until the time of a moment has come, and says which moments are to be drawn."""

    def __init__(
        self,
        speed: float | None,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """speed: seconds of the run in one of the clock; None: as fast as moments come."""
        self._speed, self._clock, self._sleep = speed, clock, sleep
        self._began = clock()
        self._first = self._shown = math.nan

    def wait(self, now: float) -> None:
        """Until it is time for the moment `now` of the run; the first one is at once."""
        if math.isnan(self._first):
            self._first = now
        if self._speed is not None:
            wait = self._began + (now - self._first) / self._speed - self._clock()
            if wait > 0.0:
                self._sleep(wait)

    def is_due(self) -> bool:
        """Whether the last picture was long enough ago."""
        return not self._shown > self._clock() - 1.0 / RATE

    def shown(self) -> None:
        """A picture was shown now."""
        self._shown = self._clock()
