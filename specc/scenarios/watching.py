"""A run that is looked at while it is computed: what `specc simulate --watch` shows."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import final

import numpy as np
from rich.console import Console

from runtime.arrays import Array, Booleans
from runtime.scenario import Scenario
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Resolved, Tick
from runtime.world.layout import lay_out
from specc.figures.eyes import Glimpse, glimpses
from specc.figures.live import Show, live_view
from specc.figures.live_lines import live_lines
from specc.figures.live_window import live_window, open_window
from specc.figures.scene import NOBODY, Scene, Trails
from specc.figures.style_names import Style
from specc.scenarios.pictured import drawn_sensors, said_now, scene_of, winner


@final
class Onlooker:
    """Shows a run: an `Observer` of who acts and senses; its `seen` is told where all are.

    Attributes:
        doers: for each robot what has acted up to now.
        glimpses: for each robot what its eyes say; None of one that has said nothing yet.
    """

    def __init__(self, scenario: Scenario, things: int) -> None:
        self._robots, self._things = scenario.robots, things
        self._eyes = [drawn_sensors(robot) for robot in scenario.robots]
        self._show: Show | None = None
        self.doers: list[list[str]] = [[] for _ in scenario.robots]
        self.glimpses: list[list[Glimpse | None]] = [[None] * len(eyes) for eyes in self._eyes]
        self._acting = np.full(len(scenario.robots), NOBODY, dtype=np.int64)

    def shows_on(self, show: Show) -> None:
        """Where everything is shown from now on."""
        self._show = show

    def seen(self, time: float, poses: Array) -> None:
        """Show where all are now."""
        if self._show is not None:
            acting = self._acting.copy()
            self._show(time, poses[: self._things], poses[self._things :], acting)

    def acting(
        self,
        instant: int,  # noqa: ARG002  the protocol has it
        robot: int,
        acts: Booleans,
        weights: Array,
    ) -> None:
        """Remember who has its way."""
        name = winner(self._robots[robot].architecture, acts, weights)
        known = self.doers[robot]
        if name and name not in known:
            known.append(name)
        self._acting[robot] = known.index(name) if name else NOBODY

    def sensed(self, instant: int, delivery: Delivery) -> None:  # noqa: ARG002  the protocol has it
        """Remember what an eye says."""
        sensor = self._robots[delivery.robot].body.sensors[delivery.sensor]
        eyes = self._eyes[delivery.robot]
        if sensor in eyes:
            (glimpse,) = glimpses((said_now(sensor, delivery.readings),), 0.0)
            self.glimpses[delivery.robot][eyes.index(sensor)] = glimpse

    def ticked(self, instant: int, tick: Tick) -> None:
        """Nothing is shown of it."""

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """Nothing is shown of it."""

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Nothing is shown of it."""

    def happened(self, instant: int, event: Event) -> None:
        """Nothing is shown of it."""


@contextmanager
def watching(
    scenario: Scenario,
    console: Console,
    *,
    speed: float | None = 1.0,
    style: Style = Style.SCREEN,
) -> Iterator[Onlooker]:
    """A live view of a run: `run(scenario, observer=it, seen=it.seen)`.

    In a window where there is a display, else in the terminal; as lines where the console is none.
    speed: seconds of the run in one on the wall, at most; None: as fast as it is computed. Ctrl-C
    leaves the terminal as it was, and goes on as KeyboardInterrupt.

    Raises:
        NoRoomError: there is no room for what is placed at random.
    """
    robots = [(robot.name, robot.body, robot.start.pose) for robot in scenario.robots]
    things = lay_out(scenario.world, robots, scenario.seed).things
    onlooker = Onlooker(scenario, len(things))
    screen = _Screen(console, speed, style, scenario.duration)
    with screen.showing(scene_of(scenario, things), onlooker.doers, onlooker.glimpses) as show:
        onlooker.shows_on(show)
        yield onlooker


def rewatch(
    scene: Scene,
    trails: Trails,
    console: Console,
    *,
    speed: float | None = 1.0,
    style: Style = Style.SCREEN,
) -> None:
    """Show a recorded run as one that is computed is shown; Ctrl-C goes on as KeyboardInterrupt."""
    eyes: list[list[Glimpse | None]] = [[None] * len(said) for said in trails.said]
    screen = _Screen(console, speed, style, float(trails.times[-1] - trails.times[0]))
    with screen.showing(scene, trails.doers, eyes) as show:
        for row, now in enumerate(trails.times.tolist()):
            for robot, said in enumerate(trails.said):
                eyes[robot][:] = glimpses(said, now)
            show(now, trails.things[row], trails.robots[row], trails.acting[row])


@final
@dataclass(frozen=True, slots=True)
class _Screen:
    """Where runs are shown: the first of a window, a terminal, and lines that is there."""

    console: Console
    speed: float | None
    style: Style
    duration: float

    @contextmanager
    def showing(
        self,
        scene: Scene,
        doers: Sequence[Sequence[str]],
        eyes: Sequence[Sequence[Glimpse | None]],
    ) -> Iterator[Show]:
        """What it yields shows a moment."""
        window, console = open_window(scene.title), self.console
        if window is not None:
            view = live_window(window, scene, doers, eyes, speed=self.speed, style=self.style)
        elif console.is_interactive:
            view = live_view(scene, doers, console, speed=self.speed)
        else:
            view = live_lines(scene, doers, console, duration=self.duration)
        with view as show:
            yield show
