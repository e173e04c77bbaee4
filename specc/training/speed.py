"""How fast a training went, and which part of the time each thing took."""

from dataclasses import dataclass
from typing import final

from specc.training.course import Course
from specc.training.pace import Pace


@final
@dataclass(frozen=True, slots=True)
class Shares:
    """Of a training: seconds on a clock, decisions made in them, and what each part took of them.

    per_second: decisions. per_second_bare: those of a run of the world alone, under the same
    commands. world, control, rewards: see `Pace`; with `learning` they are shares of 1.
    """

    seconds: float
    decisions: int
    jobs: int
    per_second: float
    per_second_bare: float
    world: float
    control: float
    rewards: float
    learning: float


def shares_of(course: Course, pace: Pace, jobs: int) -> Shares:
    """The shares of a training; episodes are taken to divide their time as one of `pace` does."""
    took = [each.took for each in course.generations]
    learning = sum(each.learning for each in took)
    living = sum(each.exploring + each.trying for each in took)
    decisions = sum(each.explored.decisions + each.raced for each in course.generations)
    seconds = learning + living

    def share(part: float) -> float:
        return part / pace.seconds * living / seconds

    return Shares(
        seconds=seconds,
        decisions=decisions,
        jobs=jobs,
        per_second=decisions / seconds,
        per_second_bare=pace.decisions / max(pace.world, 1e-9),
        world=share(pace.world),
        control=share(pace.control),
        rewards=share(pace.rewards),
        learning=learning / seconds,
    )
