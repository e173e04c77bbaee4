"""Sensors between the world and the nodes: when they sample, how well, and how late they say it."""

import sys
from collections import deque
from collections.abc import Sequence
from typing import Final, Protocol, final

import numpy as np

from runtime.arrays import Array
from runtime.chance import generator
from runtime.program import Kind
from runtime.scheduler.clock import Clock, whole_steps
from runtime.scheduler.environment import Delivery
from runtime.world.model import Body, Reading, Sensor, SensorKind

NEVER: Final = sys.maxsize
"""The instant that does not come."""


class Sampled(Protocol):
    """What is asked of a world: one method of `Environment`."""

    def sample(self, robot: int, sensor: int) -> Array:
        """The readings (k,) of one sensor now, as they are; NaN: what it said last."""
        ...


@final
class SensorBank:
    """All sensors of all robots, each with its own rate, latency and generator.

    Fits `runtime.scheduler.environment.Sensors`.
    """

    def __init__(
        self, robots: Sequence[tuple[str, Body]], world: Sampled, step: float, seed: int
    ) -> None:
        """Robots by name, in their order; `step` in seconds."""
        self._world = world
        self._lines = tuple(
            _Line(robot, index, name, sensor, step, seed)
            for robot, (name, body) in enumerate(robots)
            for index, sensor in enumerate(body.sensors)
        )
        self._clock = Clock([line.period for line in self._lines])
        self._next = 0

    @property
    def next_due(self) -> int:
        """The next instant at which a sensor samples, or says what it sampled before."""
        return self._next

    def due(self, instant: int) -> list[Delivery]:
        """Sample what is due, and give back what is to be said now; see the protocol."""
        for who in self._clock.due(instant):
            line = self._lines[who]
            said = line.quality.said(self._world.sample(line.robot, line.sensor))
            line.waiting.append((instant + line.latency if instant else 0, said))
        deliveries = []
        sampling = self._clock.next_due
        self._next = NEVER if sampling is None else sampling
        for line in self._lines:
            waiting = line.waiting
            if not waiting:
                continue
            while waiting and waiting[0][0] <= instant:
                deliveries.append(Delivery(line.robot, line.sensor, waiting.popleft()[1]))
            if waiting:
                self._next = min(self._next, waiting[0][0])
        return deliveries

    def state(self) -> Array:
        """All that what follows depends on, but for the instant: what was said and what waits."""
        numbers = [np.zeros(0)]
        for line in self._lines:
            numbers.append(line.quality.last)
            numbers += [said for _, said in line.waiting]
        return np.concatenate(numbers)


@final
class _Line:
    """One sensor: when it samples, and what it has not said yet."""

    def __init__(
        self, robot: int, index: int, name: str, sensor: Sensor, step: float, seed: int
    ) -> None:
        self.robot, self.sensor = robot, index
        self.period = whole_steps(sensor.every, step)
        self.latency = whole_steps(sensor.latency, step)
        self.quality = Quality(sensor, generator(seed, "sensor", f"{name}.{sensor.name}"))
        self.waiting: deque[tuple[int, Array]] = deque()


@final
class Quality:
    """What a sensor makes of the truth: white noise, resolution, and the ends of its scale.

    Attributes:
        last: (k,) what it said last; before that, far and straight ahead. Nobody writes to it.
    """

    def __init__(self, sensor: Sensor, chance: np.random.Generator) -> None:
        readings = sensor.readings
        self.last = np.array([0.0 if r.kind is Kind.PERIODIC else r.high for r in readings])
        self._chance = chance
        self._is_noisy = any(reading.noise for reading in readings)
        self._rows = tuple(_row(reading) for reading in readings)
        self._has_echo = sensor.kind is SensorKind.RANGE

    def said(self, truth: Array) -> Array:
        """What it says, (k,), where `truth` is so.

        NaN: what it said last. A range that hit nothing says its reach, without noise.
        """
        values = truth.tolist()
        draws = self._chance.standard_normal(len(values)).tolist() if self._is_noisy else values
        for place, (turns, noise, step, low, high) in enumerate(self._rows):
            value = values[place]
            if value != value:  # noqa: PLR0124 (NaN)
                values[place] = float(self.last[place])
                continue
            if noise and not (self._has_echo and value >= high):
                value += noise * draws[place]
            if step:
                value = round(value / step) * step
            if turns:
                value = low + (value - low) % (high - low)
            elif value < low:
                value = low
            elif value > high:
                value = high
            values[place] = value
        self.last = np.array(values)
        return self.last


def _row(reading: Reading) -> tuple[bool, float, float, float, float]:
    """Whether it turns, its noise, its steps (0: none), and the ends of its scale."""
    step = 1.0 if reading.kind is Kind.DISCRETE else reading.step
    return reading.kind is Kind.PERIODIC, reading.noise, step, reading.low, reading.high
