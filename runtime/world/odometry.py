"""Odometry: where a robot believes to be from how its wheels turned."""

import math
from typing import final

import numpy as np

from runtime.arrays import Array
from runtime.world.model import Drive, DriveKind, Sensor


@final
class Odometry:
    """What wheels turned, added up from the beginning; x and y in the frame of the start.

    Each wheel has a scale of its own, drawn once, by which it is wrong for all of a run; wheels
    that slip on the floor are believed, too. A holonomic body has three such scales: of forward,
    left and turn.
    """

    def __init__(self, sensor: Sensor, drive: Drive, chance: np.random.Generator) -> None:
        self._half = drive.track / 2.0
        self._has_wheels = drive.kind is DriveKind.DIFFERENTIAL
        self._scales = (1.0 + sensor.slip * chance.standard_normal(3)).tolist()
        self._place = (0.0, 0.0, 0.0)
        self._motion = (0.0, 0.0, 0.0)
        self._driven: tuple[float, float, float] | None = None

    def advance(self, driven: tuple[float, float, float], seconds: float) -> None:
        """Add a step at the end of which the wheels turn as for `driven`: forward, left, turn.

        In a step of the physics bodies move first, as fast as they were, and then change their
        velocities; so do the wheels.
        """
        forward, left, turn = self._motion
        x, y, heading = self._place
        half = 0.5 * turn * seconds
        # The chord of an arc, seen in its middle: exact for a steady motion.
        length = seconds * (math.sin(half) / half if half else 1.0)
        cosine, sine = length * math.cos(heading + half), length * math.sin(heading + half)
        self._place = (
            x + forward * cosine - left * sine,
            y + forward * sine + left * cosine,
            math.remainder(heading + 2.0 * half, math.tau),
        )
        if driven is not self._driven:  # a motor that holds its speed says the same
            self._driven, self._motion = driven, self._believed(driven)

    def read(self) -> tuple[float, ...]:
        """The readings x, y, heading, speed, turn."""
        forward, left, turn = self._motion
        return (*self._place, forward if self._has_wheels else math.hypot(forward, left), turn)

    def state(self) -> Array:
        """All that changes (6,)."""
        return np.array((*self._place, *self._motion))

    def _believed(self, driven: tuple[float, float, float]) -> tuple[float, float, float]:
        forward, left, turn = driven
        a, b, c = self._scales
        if not self._has_wheels:
            return a * forward, b * left, c * turn
        by_left, by_right = a * (forward - turn * self._half), b * (forward + turn * self._half)
        return 0.5 * (by_left + by_right), 0.0, (by_right - by_left) / (2.0 * self._half)
