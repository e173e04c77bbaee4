"""Artificial load: processors that are kept busy, and a computer that ponders for random times."""

# ruff: noqa: ARG002  # an observer is told more than this one listens to

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Resolved, Tick


class Burning:
    """An observer that holds the computer up for a random real time at whatever happens.

    most: seconds at a time. Half of the time it sleeps, half of the time it keeps busy.
    burnt: seconds up to now.
    """

    def __init__(self, most: float, seed: int) -> None:
        self._most = most
        self._chance = np.random.default_rng(seed)
        self.burnt = 0.0

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Readings went on the board."""
        self._ponder(0.05)

    def ticked(self, instant: int, tick: Tick) -> None:
        """A node sampled the board."""
        self._ponder(1.0)

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        """Who acts changed."""
        self._ponder(1.0)

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """The channels were set anew."""
        self._ponder(0.2)

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Another has its way on a channel."""
        self._ponder(0.2)

    def happened(self, instant: int, event: Event) -> None:
        """Something that should not pass in silence."""
        self._ponder(1.0)

    def _ponder(self, share: float) -> None:
        if self._chance.random() > share:
            return
        begun = time.perf_counter()
        seconds = self._most * self._chance.random()
        if self._chance.random() < 0.5:
            time.sleep(seconds)
        while time.perf_counter() - begun < seconds:
            pass
        self.burnt += time.perf_counter() - begun


@contextmanager
def busy_processors(count: int) -> Iterator[None]:
    """So many processes beside, each as busy as it can be, while the block runs."""
    code = "while True: sum(k * k for k in range(10000))"
    beside = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(count)]
    try:
        yield
    finally:
        for process in beside:
            process.kill()
            process.wait()
