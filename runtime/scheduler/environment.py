"""What the scheduler asks of the world, and of the sensors between the world and the nodes.

All in SI; angles in radians, counter-clockwise. Robots, sensors and channels are numbers: their
places in `Scenario.robots`, `Body.sensors` and `Architecture.channels`. Time is counted in whole
steps of `Scenario.step`; instant k is the time k * step, instant 0 the beginning.

The calls at one instant k, in this order, and no others:

1. `Sensors.due(k)` where `Sensors.next_due` is k: it calls `Environment.sample` for each sensor
   that is due, in the order of robots and sensors, and gives back what goes on the board now;
2. nodes tick (nothing of the world is asked);
3. `Environment.command`, once for each robot whose channels are set anew (at instant 0: each), in
   the order of robots;
4. `Environment.advance`, once: afterwards it is instant k + 1.
"""

from collections.abc import Sequence
from typing import NamedTuple, Protocol, final

from runtime.arrays import Array, Booleans


class Environment(Protocol):
    """A world with robots in it, of which only these things can be asked."""

    @property
    def time(self) -> float:
        """Seconds since the beginning: the number of steps taken, times the step."""
        ...

    def sample(self, robot: int, sensor: int) -> Array:
        """The readings (k,) of one sensor at this instant, as they are: without noise.

        In the order of `Sensor.readings`; a discrete one is 0 or 1. Asking changes nothing, and
        the array is the caller's own.
        """
        ...

    def command(self, robot: int, channels: Array, driven: Booleans) -> None:
        """Set what a robot's drive is to do from now on, until the next call.

        channels: (c,) set-points in the order of `Architecture.channels`, in the unit of each
        channel (m/s, rad/s), within its domain. driven: (c,) False where nothing drives the
        channel and it rolls freely (`rest: coast`); its set-point means nothing then. `stop` is
        a set-point of 0 and `hold` the last one, both driven. The arrays are the scheduler's:
        they are read during the call, not kept.
        """
        ...

    def advance(self) -> None:
        """Let one step pass, with the commands as they are."""
        ...

    def state_hash(self) -> bytes:
        """A digest of everything that what follows depends on: equal exactly where that is."""
        ...


@final
class Delivery(NamedTuple):
    """Readings (k,) of a sensor that go on its robot's board now."""

    robot: int
    sensor: int
    readings: Array


class Sensors(Protocol):
    """All sensors of all robots: their rates, latencies, noise and resolutions."""

    @property
    def next_due(self) -> int:
        """The next instant at which `due` must be called; 0 at the beginning.

        At instant 0 every sensor samples, and delivers at once whatever its latency: the world
        stood still before the beginning, so it says what it has been saying.
        """
        ...

    def due(self, instant: int) -> Sequence[Delivery]:
        """Sample the sensors that are due, then give back all readings whose latency is over.

        In the order of robots, then sensors, then samples. Afterwards `next_due` > `instant`.
        """
        ...

    def state(self) -> Array:
        """What they have sampled and not said yet, and what they said last: for digests."""
        ...
