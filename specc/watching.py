"""A run that is looked at while it is computed: what `specc simulate --watch` shows."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import final

import numpy as np
from rich.console import Console

from runtime.arrays import Array, Booleans
from runtime.scenario import Scenario
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Tick
from runtime.world.layout import lay_out
from specc.figures.live import Show, live_view
from specc.figures.scene import NOBODY
from specc.pictured import scene_of, winner


@final
class Onlooker:
    """Shows a run: an `Observer` of who acts; its `seen` is told where all are."""

    def __init__(self, scenario: Scenario, things: int, doers: list[list[str]], show: Show) -> None:
        """doers: for each robot what has acted; it grows."""
        self._robots, self._things = scenario.robots, things
        self._doers, self._show = doers, show
        self._acting = np.full(len(scenario.robots), NOBODY, dtype=np.int64)

    def seen(self, time: float, poses: Array) -> None:
        """Show where all are now."""
        self._show(time, poses[: self._things], poses[self._things :], self._acting)

    def acting(
        self,
        instant: int,  # noqa: ARG002  the protocol has it
        robot: int,
        acts: Booleans,
        weights: Array,  # noqa: ARG002  the protocol has it
    ) -> None:
        """Remember who has its way."""
        name = winner(self._robots[robot].architecture, acts)
        known = self._doers[robot]
        if name and name not in known:
            known.append(name)
        self._acting[robot] = known.index(name) if name else NOBODY

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Nothing is shown of it."""

    def ticked(self, instant: int, tick: Tick) -> None:
        """Nothing is shown of it."""

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """Nothing is shown of it."""

    def happened(self, instant: int, event: Event) -> None:
        """Nothing is shown of it."""


@contextmanager
def watching(
    scenario: Scenario, console: Console, *, speed: float | None = 1.0
) -> Iterator[Onlooker]:
    """A live view of a run: `run(scenario, observer=it, seen=it.seen)`.

    speed: seconds of the run in one on the wall, at most; None: as fast as it is computed. Ctrl-C
    leaves the terminal as it was, and goes on as KeyboardInterrupt.

    Raises:
        NoRoomError: there is no room for what is placed at random.
    """
    robots = [(robot.name, robot.body, robot.start.pose) for robot in scenario.robots]
    things = lay_out(scenario.world, robots, scenario.seed).things
    doers: list[list[str]] = [[] for _ in scenario.robots]
    with live_view(scene_of(scenario, things), doers, console, speed=speed) as show:
        yield Onlooker(scenario, len(things), doers, show)
