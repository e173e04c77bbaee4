"""Training: explore, learn from all that was lived, let what was learnt race with the best."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Final, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.steps import Steps, joined
from runtime.scenario import Scenario
from specc.training.challengers import challengers_of
from specc.training.episode import Episode, Task
from specc.training.living import Progress, live_through
from specc.training.race import raced
from specc.training.settings import Settings
from specc.training.workers import Workers
from specc.training.worlds import For, world

AGAIN: Final = 2
"""What sets the chance of which failures are lived again apart from other chance."""

LAST: Final = 3
"""The last race has the worlds of so many."""
BEFORE: Final = 30
"""Decisions before a failure, at most, at which something else is tried."""


@final
@dataclass(frozen=True, slots=True)
class Trial:
    """How a policy did in some worlds: means of episodes, `success` a share of them.

    decisions: of all episodes together.
    """

    reward: float
    success: float
    seconds: float
    decisions: int


@final
@dataclass(frozen=True, slots=True)
class Took:
    """Seconds of the computer: for exploring, for learning and for trying."""

    exploring: float
    learning: float
    trying: float


@final
@dataclass(frozen=True, slots=True)
class Failure:
    """The seed of a world in which a policy failed, and after how many decisions."""

    world: int
    decisions: int


@final
@dataclass(frozen=True, eq=False, slots=True)
class Generation:
    """What was learnt from so many episodes and decisions, and what is best since its race.

    explored: the last of these episodes. rules: the best of the lists that challenged the best so
    far. is_new: it won. tried: who won, in the worlds of the race. failed: where that did. raced:
    decisions of all lists in it, from which later generations learn. took: no part of what follows
    from the seed.
    """

    episodes: int
    decisions: int
    explored: Trial
    tried: Trial
    failed: tuple[Failure, ...]
    rules: DecisionList
    is_new: bool
    raced: int
    took: Took


@final
@dataclass(slots=True)
class Course:
    """A training so far: everything that it goes on from.

    lived: of each episode, those that explored in a generation before those of its race.
    """

    lived: list[Steps] = field(default_factory=list)
    generations: list[Generation] = field(default_factory=list)

    @property
    def champion(self) -> Generation:
        """The generation whose list won last."""
        return next(each for each in reversed(self.generations) if each.is_new)

    @property
    def episodes(self) -> int:
        """How many were lived."""
        return len(self.lived)

    def is_over(self, settings: Settings) -> bool:
        """Whether all episodes are lived, or it got no better for long enough."""
        if not self.generations:
            return False
        return self.episodes >= settings.episodes or self.is_stale(settings)

    def is_stale(self, settings: Settings) -> bool:
        """Whether no other list won for long enough."""
        behind = len(self.generations) - 1 - self.generations.index(self.champion)
        return behind >= settings.patience


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
    keep: Callable[[], None],
) -> None:
    """Train until it is over.

    Everything that a generation does follows from the steps lived so far, the settings and its
    number. So a training that was interrupted goes on as if it had not been.

    tell: is told how it stands, how many episodes are lived, and of how many. keep: is called
    after each generation.
    """
    while not course.is_over(settings):
        course.generations.append(_generation(course, scenario, settings, workers, tell))
        keep()


def _generation(
    course: Course, scenario: Scenario, settings: Settings, workers: Workers, tell: Progress
) -> Generation:
    standing, most, done_so_far = _standing(course), settings.episodes, course.episodes
    tasks = exploring_tasks(course, settings)

    def told(what: str, done: int, of: int) -> None:
        nonlocal done_so_far
        done_so_far += done > 0
        tell(f"{what} {done} of {of}{standing}", min(done_so_far, most), most)

    clock = [perf_counter()]
    episodes = live_through(workers, tasks, "exploring", told)
    clock.append(perf_counter())
    tell(f"learning{standing}", min(done_so_far, most), most)
    lived = [*course.lived, *(episode.steps for episode in episodes)]
    champion = course.champion.rules if course.generations else None
    challengers = challengers_of(
        joined(lived), champion, scenario, settings, len(course.generations)
    )
    clock.append(perf_counter())
    worlds = choosing_worlds(len(course.generations), settings)
    race = raced(champion, challengers, worlds, workers, told)
    clock.append(perf_counter())
    winner = race.winner
    course.lived = [*lived, *(episode.steps for episode in race.episodes)]
    return Generation(
        episodes=len(lived),
        decisions=sum(len(steps) for steps in lived),
        explored=trial_of(episodes),
        tried=trial_of(winner.episodes),
        failed=tuple(
            Failure(seed, len(each.steps))
            for seed, each in zip(worlds, winner.episodes, strict=True)
            if not each.succeeded
        ),
        rules=race.challenger.rules,
        is_new=not winner.is_champion,
        raced=sum(len(each.steps) for each in race.episodes),
        took=Took(*np.diff(clock).tolist()),
    )


def best_of(
    course: Course, settings: Settings, workers: Workers, tell: Progress
) -> tuple[Generation, Trial]:
    """The generation whose list is the best of all, and how it did in the last race.

    That one is longer than those before, in worlds of its own, and who did not beat the best of
    its time for sure runs again: it may well be better.
    """
    every, after = course.generations, len(course.generations)
    worlds = [each for i in range(LAST) for each in choosing_worlds(after + i, settings)]
    winner = raced(None, [each.rules for each in every], worlds, workers, tell).winner
    return next(each for each in every if each.rules is winner.rules), trial_of(winner.episodes)


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


def trial_of(episodes: Sequence[Episode]) -> Trial:
    """The means."""
    return Trial(
        reward=float(np.mean([each.total for each in episodes])),
        success=float(np.mean([each.succeeded for each in episodes])),
        seconds=float(np.mean([each.seconds for each in episodes])),
        decisions=sum(len(each.steps) for each in episodes),
    )


def _standing(course: Course) -> str:
    """How the best did in its last race."""
    if not course.generations:
        return ""
    tried = course.generations[-1].tried
    return f"; best so far: success {100 * tried.success:.0f} %, reward {tried.reward:.3g}"
