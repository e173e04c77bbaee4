"""A scenario at instant 0: its world laid out, its senses, and the scheduler that drives it all."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import final

from runtime.scenario import Scenario
from runtime.scheduler.nodes import Learner
from runtime.scheduler.observer import Observer
from runtime.scheduler.scheduler import NO_LEARNERS, Scheduler
from runtime.scheduler.sensors import SensorBank
from runtime.world.sensing import Senses, senses_of
from runtime.world.world import Inhabitant, SimulatedWorld


@final
@dataclass(frozen=True, eq=False, slots=True)
class Started:
    """What a run is made of, before its first step."""

    world: SimulatedWorld
    senses: Senses
    scheduler: Scheduler


def started(
    scenario: Scenario,
    *,
    allow_code: bool = False,
    beside: Path | None = None,
    learners: Mapping[str, Learner] = NO_LEARNERS,
    observer: Observer | None = None,
) -> Started:
    """A scenario, ready to run; the arguments are those of `runtime.run.run`.

    Raises:
        NoRoomError: there is no room for what is placed at random.
        UserCodeError: code of the user's own may not be run, or is not found.
    """
    made: list[Senses] = []

    def sensing(world: SimulatedWorld) -> Senses:
        made.append(senses_of(world))
        return made[0]

    inhabitants = [
        Inhabitant(
            robot.name,
            robot.body,
            robot.start.pose,
            tuple(channel.name for channel in robot.architecture.channels),
        )
        for robot in scenario.robots
    ]
    world = SimulatedWorld(
        scenario.world, inhabitants, scenario.step, scenario.seed, senses=sensing
    )
    robots = [(robot.name, robot.body) for robot in scenario.robots]
    scheduler = Scheduler(
        scenario,
        world,
        SensorBank(robots, world, scenario.step, scenario.seed),
        allow_code=allow_code,
        beside=beside,
        observer=observer,
        learners=learners,
    )
    return Started(world, made[0], scheduler)
