"""How fast episodes go, and which part of them is the world's own."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import process_time
from typing import final

from runtime.arrays import Array, Booleans
from runtime.recording.live import LastTicks
from runtime.scenario import Scenario
from runtime.start import started
from specc.training.episode import Task, lived


@final
@dataclass(frozen=True, slots=True)
class Pace:
    """Of some episodes: decisions, and seconds of the processor in each part.

    world: physics alone, under the same commands. control: sensors, behaviors, arbiter and
    channels. rewards: starting it, measuring, and working out what decisions were worth.
    """

    decisions: int
    world: float
    control: float
    rewards: float

    @property
    def seconds(self) -> float:
        """Of all parts."""
        return self.world + self.control + self.rewards


class _Commands(LastTicks):
    """Keeps what was commanded, and when."""

    def __init__(self) -> None:
        super().__init__()
        self.given: list[tuple[int, int, Array, Booleans]] = []

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        self.given.append((instant, robot, channels.copy(), driven.copy()))


def paced(scenario: Scenario, tasks: Sequence[Task]) -> Pace:
    """Live episodes, and the world's part of each alone; the first twice, since it loads kernels.

    Raises:
        NoRoomError, UserCodeError, LearnerError: as `lived`.
    """
    lived(scenario, tasks[0])
    every = [_one_paced(scenario, task) for task in tasks]
    return Pace(
        decisions=sum(each.decisions for each in every),
        world=sum(each.world for each in every),
        control=sum(each.control for each in every),
        rewards=sum(each.rewards for each in every),
    )


def _one_paced(scenario: Scenario, task: Task) -> Pace:
    heard = _Commands()
    episode = lived(scenario, task, heard)
    instants = round(episode.seconds / scenario.step)
    world = _world_alone(replace(scenario, seed=task.world), heard.given, instants)
    return Pace(
        decisions=len(episode.steps),
        world=world,
        control=max(episode.running - world, 0.0),
        rewards=episode.rewarding,
    )


def _world_alone(
    scenario: Scenario, given: list[tuple[int, int, Array, Booleans]], instants: int
) -> float:
    """Seconds for so many steps of the world under the same commands."""
    world = started(scenario).world
    waiting = iter([*given, (instants, 0, None, None)])
    due, robot, channels, driven = next(waiting)
    began = process_time()
    for instant in range(instants):
        while due == instant and channels is not None and driven is not None:
            world.command(robot, channels, driven)
            due, robot, channels, driven = next(waiting)
        world.advance()
    return process_time() - began
