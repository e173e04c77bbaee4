"""Sensors between the world and the nodes: when they sample, how well, and how late they say it."""

import math
import sys
from collections.abc import Sequence
from typing import Final, Protocol, final

import numpy as np

from runtime.arrays import Array
from runtime.chance import generator
from runtime.program import Kind
from runtime.scheduler.clock import Clock, whole_steps
from runtime.scheduler.environment import Delivery
from runtime.world.model import Body, Sensor, SensorKind

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
        for line in self._lines:
            while line.waiting and line.waiting[0][0] <= instant:
                deliveries.append(Delivery(line.robot, line.sensor, line.waiting.pop(0)[1]))
        sampling = self._clock.next_due
        instants = [line.waiting[0][0] for line in self._lines if line.waiting]
        self._next = min([NEVER if sampling is None else sampling, *instants])
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
        self.waiting: list[tuple[int, Array]] = []


@final
class Quality:
    """What a sensor makes of the truth: white noise, resolution, and the ends of its scale.

    Attributes:
        last: (k,) what it said last; before that, far and straight ahead.
    """

    def __init__(self, sensor: Sensor, chance: np.random.Generator) -> None:
        readings = sensor.readings
        self.last = np.array([0.0 if r.kind is Kind.PERIODIC else r.high for r in readings])
        self._chance = chance
        self._noise = np.array([reading.noise for reading in readings])
        self._is_exact = not self._noise.any()
        self._readings = tuple(
            (r.kind, 1.0 if r.kind is Kind.DISCRETE else r.step, r.low, r.high) for r in readings
        )
        self._ends = sensor.kind is SensorKind.RANGE

    def said(self, truth: Array) -> Array:
        """What it says, (k,), where `truth` is so.

        NaN: what it said last. A range that hit nothing says its reach, without noise.
        """
        noise = truth * 0.0
        if not self._is_exact:
            noise = self._noise * self._chance.standard_normal(len(truth))
        said = [
            self._one(*row)
            for row in zip(
                *(truth.tolist(), noise.tolist(), self.last.tolist(), self._readings), strict=True
            )
        ]
        self.last = np.array(said)
        return self.last.copy()

    def _one(
        self, true: float, noise: float, last: float, reading: tuple[Kind, float, float, float]
    ) -> float:
        kind, step, low, high = reading
        if math.isnan(true):
            return last
        value = true if self._ends and true >= high else true + noise
        if step > 0.0:
            value = round(value / step) * step
        if kind is Kind.PERIODIC:
            return low + (value - low) % (high - low)
        return min(max(value, low), high)
