"""A scenario run: the scheduler and the world together, and everything that it leaves.

No clock of a computer is read: the same scenario and seed leave the same arrays, bit for bit.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Floats, frozen
from runtime.recording.gathering import Gathering
from runtime.recording.quantities import quantities_of
from runtime.recording.tracks import (
    Happening,
    LightFrames,
    Quantity,
    RobotTrack,
    Touch,
    WorldTrack,
)
from runtime.scenario import Scenario
from runtime.scheduler.nodes import Learner
from runtime.scheduler.observer import Observer, Silent
from runtime.scheduler.scheduler import NO_LEARNERS
from runtime.start import started
from runtime.world.audit import Audit
from runtime.world.layout import Layout
from runtime.world.light import LightMap
from runtime.world.sensing import Senses
from runtime.world.world import SimulatedWorld

Progress: TypeAlias = Callable[[int, int], None]
"""Is told how many steps of how many are done."""
Seen: TypeAlias = Callable[[float, Array], None]
"""Is told where all are while it runs: seconds, and poses (n, 3) of things, then robots."""

LOOK: Final = 0.02
"""Seconds between two looks at where all are, at most; how near robots come is seen each step."""
CELL: Final = 0.05
"""Metres: the least width of a cell of the light on the floor."""
MOST_CELLS: Final = 400
"""So many cells lie side by side at most: of a large floor they are wider."""
MOST_FRAMES: Final = 300
"""So many pictures of that light are kept at most: of a long run they are farther apart."""
TOLD: Final = 200
"""How often progress is told."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Run:
    """What a run left.

    scenario: with the seed that it was run with. duration: seconds. layout: where all stood at
    first, with things that were laid at random. robots: in the order of the scenario.
    signals: every named quantity. floor: the light on it, where that was asked for. touches: each
    beginning of one, in the order of time. digest: of the state at the end: equal exactly where
    all that follows would be equal.
    """

    scenario: Scenario
    duration: float
    layout: Layout
    robots: tuple[RobotTrack, ...]
    world: WorldTrack
    floor: LightFrames | None
    signals: Mapping[str, Quantity]
    events: tuple[Happening, ...]
    touches: tuple[Touch, ...]
    audit: Audit
    digest: bytes


def run(
    scenario: Scenario,
    *,
    allow_code: bool = False,
    beside: Path | None = None,
    learners: Mapping[str, Learner] = NO_LEARNERS,
    observer: Observer | None = None,
    progress: Progress | None = None,
    light_every: float | None = None,
    seen: Seen | None = None,
) -> Run:
    """Run a scenario to its end.

    Args:
        scenario: compiled.
        allow_code: whether Python that the scenario names may be run.
        beside: the folder where it is looked for; None for that of each architecture's own file.
        learners: by `robot.node`, what decides instead of the arbiter that is there.
        observer: is told everything as it happens.
        progress: is told a few hundred times how far it is.
        light_every: seconds between two pictures of the light on the floor, at least; None for
            none.
        seen: is told where all are, each time that the run looks.

    Raises:
        NoRoomError: there is no room for what is placed at random.
        UserCodeError: code of the user's own may not be run, is not found, or raised.
    """
    gathering = Gathering(scenario, observer or Silent())
    begun = started(
        scenario, allow_code=allow_code, beside=beside, learners=learners, observer=gathering
    )
    world, scheduler = begun.world, begun.scheduler
    watch = _Watch(scenario, world, begun.senses, light_every, seen)
    steps = max(round(scenario.duration / scenario.step), 1)
    every = max(steps // TOLD, 1)
    for done in range(steps):
        watch.look()
        scheduler.step()
        if progress is not None and done % every == 0:
            progress(done, steps)
    watch.look(last=True)
    if progress is not None:
        progress(steps, steps)
    tracks, looked = gathering.tracks(), watch.track()
    return Run(
        scenario=scenario,
        duration=steps * scenario.step,
        layout=world.layout,
        robots=tracks,
        world=looked,
        floor=watch.floor(),
        signals=quantities_of(scenario.robots, tracks, looked),
        events=gathering.happenings(),
        touches=tuple(watch.touches),
        audit=world.audit(),
        digest=scheduler.state_hash(),
    )


@final
class _Watch:
    """Looks at the world between steps, and changes nothing in it."""

    def __init__(
        self,
        scenario: Scenario,
        world: SimulatedWorld,
        senses: Senses,
        light_every: float | None,
        seen: Seen | None,
    ) -> None:
        self._seen = seen
        self._world, self._senses, self._step = world, senses, scenario.step
        self._robots = range(len(scenario.robots))
        things = (thing.name for thing in world.layout.things)
        self._names = (*things, *(robot.name for robot in scenario.robots))
        self._riders = tuple(robot.name for robot in scenario.robots)
        self._owners = (*self._names, "walls")
        self._touched: list[set[int]] = [set() for _ in self._robots]
        self.touches: list[Touch] = []
        self._every = max(int(LOOK / scenario.step), 1)
        self._at: list[int] = []
        self._poses: list[Array] = []
        self._motions: list[list[tuple[float, float]]] = []
        self._light: list[list[float]] = []
        self._clearance: list[list[float]] = []
        self._contacts: list[list[float]] = []
        self._map: LightMap | None = None
        self._map_every = 0
        self._map_at: list[int] = []
        self._lux: list[Floats] = []
        if light_every is not None:
            self._map_every = steps_between_frames(scenario, light_every)
            self._map = senses.light_map(cells_of(scenario.world.arena))

    def look(self, *, last: bool = False) -> None:
        """Look, at what is due at this instant."""
        steps, world = self._world.steps, self._world
        self._clearance.append([world.clearance(robot) for robot in self._robots])
        self._contacts.append([float(self._touching(robot)) for robot in self._robots])
        if last or steps % self._every == 0:
            self._at.append(steps)
            self._poses.append(world.poses())
            if self._seen is not None:
                self._seen(world.time, self._poses[-1])
            motions = [world.motion(robot) for robot in self._robots]
            self._motions.append([(motion.forward, motion.turn) for motion in motions])
            self._light.append([self._senses.light(robot) for robot in self._robots])
        if self._map is not None and steps % self._map_every == 0:
            world.geometry()
            self._map.update()
            self._map_at.append(steps)
            self._lux.append(self._map.lux.astype(np.float32))

    def _touching(self, robot: int) -> int:
        """How many others a robot touches; remember where it begins to."""
        before, now = self._touched[robot], set[int]()
        for contact in self._world.touching(robot):
            if contact.owner not in now | before:
                who, what = self._riders[robot], self._owners[contact.owner]
                self.touches.append(Touch(self._world.time, who, what, contact.x, contact.y))
            now.add(contact.owner)
        self._touched[robot] = now
        return len(now)

    def track(self) -> WorldTrack:
        """What was seen."""
        count, robots = len(self._at), len(self._robots)
        return WorldTrack(
            names=self._names,
            times=frozen(np.array(self._at, dtype=np.float64) * self._step),
            poses=frozen(np.array(self._poses).reshape(count, len(self._names), 3)),
            motions=frozen(np.array(self._motions).reshape(count, robots, 2)),
            light=frozen(np.array(self._light).reshape(count, robots)),
            close_times=frozen(np.arange(len(self._clearance)) * self._step),
            clearance=frozen(np.array(self._clearance).reshape(-1, robots)),
            contacts=frozen(np.array(self._contacts).reshape(-1, robots)),
        )

    def floor(self) -> LightFrames | None:
        """The light on the floor, where that was asked for."""
        if self._map is None:
            return None
        times = frozen(np.array(self._map_at, dtype=np.float64) * self._step)
        lux = np.array(self._lux)
        lux.setflags(write=False)
        return LightFrames(self._map.xs, self._map.ys, times, lux)


def cells_of(arena: tuple[tuple[float, float], ...]) -> tuple[int, int]:
    """So many cells of the light on the floor lie along x and y."""
    wide, high = np.ptp(np.array(arena), axis=0)
    cell = max(CELL, float(max(wide, high)) / MOST_CELLS)
    return max(round(wide / cell), 1), max(round(high / cell), 1)


def steps_between_frames(scenario: Scenario, light_every: float) -> int:
    """How many steps lie between two pictures of the light on the floor.

    light_every: seconds that are wanted between two; a long run has them farther apart, by a whole
    multiple.
    """
    steps = max(round(light_every / scenario.step), 1)
    frames = scenario.duration / (steps * scenario.step)
    return steps * max(math.ceil(frames / MOST_FRAMES), 1)
