"""Training: explore, learn from all that was lived, let what was learnt race with the best."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Final, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Integers
from lcs.policies.steps import joined
from runtime.progress import Progress
from runtime.scenario import Scenario
from specc.training.challengers import challengers_of
from specc.training.course import Course, Failure, Generation, Took, trial_of
from specc.training.episode import Episode, Task
from specc.training.living import live_through
from specc.training.race import raced
from specc.training.settings import Settings
from specc.training.unlearnable import refuse_decided
from specc.training.workers import Workers
from specc.training.worlds import For, world

AGAIN: Final = 2
"""What sets the chance of which failures are lived again apart from other chance."""

BEFORE: Final = 30
"""Decisions before a failure, at most, at which something else is tried."""


@final
@dataclass(frozen=True, slots=True)
class AtRandom:
    """The first of all policies, which knows nothing: what it says is always tried over."""

    def decide(self, inputs: npt.ArrayLike) -> Integers:
        """Choice 0 at each."""
        return np.zeros(len(np.asarray(inputs)), np.int64)


def go_on(
    course: Course,
    scenario: Scenario,
    settings: Settings,
    workers: Workers,
    tell: Progress,
    keep: Callable[[Course], None],
) -> Course:
    """Train until it is over; the whole course.

    Everything that a generation does follows from the steps lived so far, the settings and its
    number. So a training that was interrupted goes on as if it had not been.

    Args:
        course: the training so far.
        scenario: one that trains.
        settings: how it is gone about.
        workers: live the episodes.
        tell: is told how it stands, how many episodes are lived, and of how many.
        keep: is given the course after each generation.

    Raises:
        NoRoomError: there is no room for what is placed at random.
        UserCodeError: the scenario needs Python of the user's own.
        LearnerError: what is read, or rewarded, is not finite.
        SpecError: a process that lived episodes is gone (V417), or none was longer than a decision
            (V418).
    """
    while not course.is_over(settings):
        course = _one_more(course, scenario, settings, workers, tell)
        keep(course)
    return course


def _one_more(
    course: Course, scenario: Scenario, settings: Settings, workers: Workers, tell: Progress
) -> Course:
    """The course with one more generation."""
    standing, most, done_so_far = _standing(course), settings.episodes, course.episodes
    number = len(course.generations)

    def told(what: str, done: int, of: int) -> None:
        nonlocal done_so_far
        done_so_far += done > 0
        tell(f"{what} {done} of {of}{standing}", min(done_so_far, most), most)

    clock = [perf_counter()]
    episodes = live_through(workers, exploring_tasks(course, settings), "exploring", told)
    clock.append(perf_counter())
    tell(f"learning{standing}", min(done_so_far, most), most)
    if number == 0:
        refuse_decided(scenario, episodes)
    lived = (*course.lived, *(episode.steps for episode in episodes))
    champion = course.champion.rules if course.generations else None
    found = challengers_of(joined(lived), champion, scenario, settings, number)
    clock.append(perf_counter())
    worlds = choosing_worlds(number, settings)
    race = raced(champion, found.lists, worlds, workers, told)
    clock.append(perf_counter())
    made = Generation(
        episodes=len(lived),
        decisions=sum(len(steps) for steps in lived),
        explored=trial_of(episodes),
        tried=trial_of(race.winner.episodes),
        failed=_failures(worlds, race.winner.episodes),
        rules=found.counted(race.challenger.rules),
        is_new=race.is_won,
        raced=sum(len(each.steps) for each in race.episodes),
        took=Took(*np.diff(clock).tolist()),
    )
    everything = (*lived, *(episode.steps for episode in race.episodes))
    return Course(everything, (*course.generations, made))


def _failures(worlds: Sequence[int], episodes: Sequence[Episode]) -> tuple[Failure, ...]:
    """Those of the worlds where something that is required was not satisfied."""
    pairs = zip(worlds, episodes, strict=True)
    return tuple(Failure(seed, len(each.steps)) for seed, each in pairs if not each.succeeded)


def choosing_worlds(number: int, settings: Settings) -> list[int]:
    """Where the lists of a generation are tried: in worlds of its own, where no other was.

    So a list that was lucky in the worlds of its first race has to be good in the next.
    """
    first = number * settings.tried_in
    return [world(For.CHOOSING, first + i) for i in range(settings.tried_in)]


def exploring_tasks(course: Course, settings: Settings) -> list[Task]:
    """The next episodes that explore: in new worlds, and where the last policy failed.

    A failure is lived again as it was, for the same world and policy do the same, until shortly
    before its end. Something else is tried there.
    """
    before, is_first = course.episodes, not course.generations
    count = min(settings.first if is_first else settings.each, settings.episodes - before)
    new = [world(For.LEARNING, before + i, settings.seed) for i in range(count)]
    if is_first:
        return [Task(each, AtRandom(), 1.0, before + i) for i, each in enumerate(new)]
    last, best = course.generations[-1], course.champion.rules
    chance = np.random.default_rng([settings.seed, len(course.generations), AGAIN])
    back = chance.permutation(len(last.failed))[: int(settings.again * count)]
    tasks = [Task(each, best, settings.explore, before + i) for i, each in enumerate(new)]
    for place, failure in enumerate(last.failed[i] for i in back):
        first_try = max(failure.decisions - 1 - int(chance.integers(BEFORE)), 0)
        tasks[place] = replace(tasks[place], world=failure.world, first_try=first_try)
    return tasks


def _standing(course: Course) -> str:
    """How the best did in its last race."""
    if not course.generations:
        return ""
    tried = course.generations[-1].tried
    return f"; best so far: success {100 * tried.success:.0f} %, reward {tried.reward:.3g}"
