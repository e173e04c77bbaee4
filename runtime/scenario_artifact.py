"""The artifact of a scenario: one file with its world, its robots and all that drives them.

`scenario.json` and for each architecture `architectures/N.specc`, the very artifact that it has by
itself with the body that it drives. Nothing else is needed to run it, but Python of its author's
own, which is looked for beside the file of the architecture that names it.
"""

import dataclasses
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, final

from runtime import architecture_artifact
from runtime.container import ArtifactError, Member, join, split
from runtime.document import Document
from runtime.requirement_faults import faults_of
from runtime.scenario import Robot, Scenario, Start
from runtime.scheduler.clock import whole_steps
from runtime.training_faults import faults_of as faults_of_training
from runtime.world.heights import BITS, ranges_of


@final
@dataclass(frozen=True, eq=False, slots=True)
class Placed:
    """A robot, whose architecture and body are the member of that number."""

    name: str
    architecture: int
    start: Start
    origin: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class Staged:
    """What stands in the document: a scenario whose robots are placed apart."""

    scenario: Scenario
    robots: tuple[Placed, ...]


SHORTEST: Final = 1e-9
"""Seconds: the shortest step that stamps tell apart."""
LONGEST: Final = 9e9
"""Seconds: the longest run whose nanoseconds are counted in 64 bits."""
DOCUMENT: Final = Document("scenario", "staged", 2, Staged)


def to_bytes(scenario: Scenario) -> bytes:
    """The artifact of a scenario.

    Raises:
        ArtifactError: its parts do not fit together, or are too large.
    """
    for fault in _faults(scenario):
        raise ArtifactError(f"'{scenario.name}' does not fit together: {fault}")
    driven = [architecture_artifact.to_bytes(r.architecture, r.body) for r in scenario.robots]
    once = list(dict.fromkeys(driven))
    robots = tuple(
        Placed(robot.name, once.index(data), robot.start, robot.origin)
        for robot, data in zip(scenario.robots, driven, strict=True)
    )
    bare = dataclasses.replace(scenario, robots=())
    document = memoryview(DOCUMENT.written(Staged(bare, robots)))
    members = [Member(_name(i), memoryview(data)) for i, data in enumerate(once)]
    return join([Member(DOCUMENT.name, document), *members])


def from_bytes(data: bytes) -> Scenario:
    """The scenario of an artifact.

    Raises:
        ArtifactError: the data was cut or altered, or is no artifact of this version.
    """
    members = split(memoryview(data))
    names = [DOCUMENT.name, *(_name(i) for i in range(len(members) - 1))]
    if [name for name, _ in members] != names:
        raise ArtifactError("the artifact has other parts than a scenario and its architectures")
    staged: Staged = DOCUMENT.read(bytes(members[0].content))
    driven = [architecture_artifact.from_bytes(bytes(content)) for _, content in members[1:]]
    robots = []
    for one in staged.robots:
        if not 0 <= one.architecture < len(driven):
            raise ArtifactError(f"the artifact lacks the architecture of '{one.name}'")
        architecture, body = driven[one.architecture]
        robots.append(Robot(one.name, body, architecture, one.start, one.origin))
    scenario = dataclasses.replace(staged.scenario, robots=tuple(robots))
    # One scenario, one artifact: nothing may stand in it that would not be written.
    if to_bytes(scenario) != data:
        raise ArtifactError("the artifact was not written by specc")
    return scenario


def is_scenario(data: bytes) -> bool:
    """Whether a container holds a scenario."""
    return DOCUMENT.name in [name for name, _ in split(memoryview(data))]


def _faults(scenario: Scenario) -> Iterator[str]:
    """What keeps a scenario from being run, each in a sentence."""
    names = [robot.name for robot in scenario.robots]
    if not names or len(set(names)) != len(names):
        yield "it needs robots of different names"
    if not is_time(scenario.step, scenario.duration):
        yield "it has no step or no duration"
        return
    if ranges_of(_heights(scenario)) > BITS:
        yield "it has more ranges of height than the physics tells apart"
    yield from faults_of_times(scenario.robots, scenario.step)
    for requirement in scenario.requirements:
        yield from faults_of(requirement)
    if scenario.training is not None:
        yield from faults_of_training(scenario.training, scenario.robots)


def _heights(scenario: Scenario) -> list[tuple[float, float]]:
    """From where to where all that stands in it reaches."""
    scattered = [(s.prototype.low, s.prototype.high) for s in scenario.world.scattered]
    bodies = [(robot.body.low, robot.body.high) for robot in scenario.robots]
    return [*((thing.low, thing.high) for thing in scenario.world.things), *scattered, *bodies]


def is_time(step: float, duration: float) -> bool:
    """Whether a run can have this step and this duration (s): stamps are whole nanoseconds."""
    return all(SHORTEST <= time <= LONGEST for time in (step, duration))


def faults_of_times(robots: Sequence[Robot], step: float) -> Iterator[str]:
    """Which times of robots' nodes and sensors are no multiples of the step, each in a sentence."""
    for robot in robots:
        sensors, nodes = robot.body.sensors, robot.architecture.nodes
        periods = [*(s.every for s in sensors), *(n.period for n in nodes)]
        delays = [*(s.latency for s in sensors), *(n.response_time for n in nodes)]
        try:
            for time in (*periods, *delays):
                whole_steps(time, step)
            if min(periods, default=step) < 0.5 * step:
                yield f"of {robot.name} {min(periods)!r} s is shorter than the step, {step!r} s"
        except ValueError as problem:
            yield f"of {robot.name} {problem}"


def _name(place: int) -> str:
    return f"architectures/{place}.specc"
