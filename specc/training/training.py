"""Training: explore, learn from all that was lived, try what was learnt, and keep the best."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.learner import Found, found_policy
from lcs.policies.policy import Policy
from lcs.policies.steps import Steps, joined
from runtime.arbiter import Arbiter
from runtime.scenario import Scenario
from specc.training.episode import Episode, Task, trained_arbiter, training_of
from specc.training.settings import Settings
from specc.training.workers import Workers
from specc.training.worlds import For, world

Progress: TypeAlias = Callable[[str, int, int], None]


@final
@dataclass(frozen=True, slots=True)
class Trial:
    """How a policy did in some worlds: means of episodes, `success` a share of them."""

    reward: float
    success: float
    seconds: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class Generation:
    """A policy that was learnt: after how many episodes and decisions, and how it did.

    explored: the episodes that it was learnt from last. tried: the policy itself.
    """

    episodes: int
    decisions: int
    explored: Trial
    tried: Trial
    rules: DecisionList


@final
@dataclass(slots=True)
class Course:
    """A training so far: everything that it goes on from."""

    lived: list[Steps] = field(default_factory=list)
    generations: list[Generation] = field(default_factory=list)

    @property
    def best(self) -> Generation:
        """The policy that was worth most; of equal ones the first."""
        return max(self.generations, key=lambda each: each.tried.reward)

    def is_over(self, settings: Settings) -> bool:
        """Whether all episodes are lived, or it got no better for long enough."""
        if not self.generations:
            return False
        last = len(self.generations) - 1
        behind = last - self.generations.index(self.best)
        return self.generations[-1].episodes >= settings.episodes or behind >= settings.patience


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

    tell: is told what is done, how much of it, and of how much. keep: is called after each
    generation.
    """
    while not course.is_over(settings):
        course.generations.append(_generation(course, scenario, settings, workers, tell))
        keep()


def _generation(
    course: Course, scenario: Scenario, settings: Settings, workers: Workers, tell: Progress
) -> Generation:
    before = course.generations[-1].episodes if course.generations else 0
    count = min(settings.each, settings.episodes - before)
    policy: Policy = course.generations[-1].rules if course.generations else AtRandom()
    explore = settings.explore if course.generations else 1.0
    worlds = [world(For.LEARNING, before + i, settings.seed) for i in range(count)]
    episodes = _lived(workers, [Task(each, policy, explore) for each in worlds], "exploring", tell)
    tell("learning", 0, 1)
    lived = [*course.lived, *(episode.steps for episode in episodes)]
    found = policy_of(lived, scenario, settings, len(course.generations))
    tried = trial(found.rules, settings.tried_in, For.CHOOSING, workers, "trying", tell)
    course.lived = lived
    decisions = sum(len(steps) for steps in lived)
    return Generation(before + count, decisions, trial_of(episodes), tried, found.rules)


def policy_of(lived: Sequence[Steps], scenario: Scenario, settings: Settings, number: int) -> Found:
    """What is learnt from all steps so far, in the generation of that number."""
    arbiter = trained_arbiter(scenario)
    return found_policy(
        joined(lived),
        ranges_of(arbiter),
        len(arbiter.choices),
        discount=training_of(scenario).discount,
        learner=settings.learner,
        seed=settings.seed + number,
        most=settings.rules,
    )


def ranges_of(arbiter: Arbiter) -> tuple[Array, Array]:
    """The lowest and the highest of what it reads and of its controls, (m,) each, SI."""
    read = [(each.low, each.high) for each in arbiter.reads]
    read += [(each.low, each.high) for each in arbiter.controls]
    low, high = np.array(read).reshape(-1, 2).T
    return low, high


def trial(
    policy: Policy, worlds: int, purpose: For, workers: Workers, what: str, tell: Progress
) -> Trial:
    """How a policy does, without exploring, in the worlds of a purpose."""
    tasks = [Task(world(purpose, i), policy, 0.0) for i in range(worlds)]
    return trial_of(_lived(workers, tasks, what, tell))


def trial_of(episodes: Sequence[Episode]) -> Trial:
    """The means."""
    return Trial(
        reward=float(np.mean([each.total for each in episodes])),
        success=float(np.mean([each.succeeded for each in episodes])),
        seconds=float(np.mean([each.seconds for each in episodes])),
    )


def _lived(workers: Workers, tasks: Sequence[Task], what: str, tell: Progress) -> list[Episode]:
    episodes = []
    tell(what, 0, len(tasks))
    for episode in workers.lived(tasks):
        episodes.append(episode)
        tell(what, len(episodes), len(tasks))
    return episodes
