"""A scenario: robots with their architectures in a world, for a while, and what is required."""

from dataclasses import dataclass
from typing import final

from runtime.architecture import Architecture
from runtime.program import Origin
from runtime.requirement import Requirement
from runtime.training import Training
from runtime.world.model import Body, Pose, World


@final
@dataclass(frozen=True, slots=True)
class Start:
    """Where a robot begins: a pose, or (None) anywhere that is free, by the seed."""

    pose: Pose | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Robot:
    """One robot: its body, what controls it, and where it starts."""

    name: str
    body: Body
    architecture: Architecture
    start: Start
    origin: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scenario:
    """What `specc simulate` runs.

    step: seconds of one step of physics; every period, response time, rate and latency is a
    multiple of it. beginnings: by `robot.node.state`, the values (SI) that internal states start
    from. training: how an arbiter in it learns, where one does.
    """

    name: str
    about: str
    world: World
    robots: tuple[Robot, ...]
    duration: float
    step: float
    seed: int
    beginnings: dict[str, float]
    requirements: tuple[Requirement, ...]
    source: Origin
    training: Training | None = None
