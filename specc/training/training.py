"""Training: explore, learn from all that was lived, try what was learnt, and keep the best."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Final, TypeAlias, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.learner import Found, found_policy
from lcs.policies.policy import Policy
from lcs.policies.shortened import shortened
from lcs.policies.steps import Steps, joined
from runtime.arbiter import Arbiter
from runtime.scenario import Scenario
from specc.training.episode import Episode, Task, trained_arbiter, training_of
from specc.training.settings import Settings
from specc.training.workers import Workers
from specc.training.worlds import For, world

EXPLORING: Final = "exploring"
AGAIN: Final = 2
"""What sets the chance of which worlds are explored again apart from other chance."""

FIRST: Final = 10
"""Worlds in which all lists of a generation are tried; the best of them is tried in all."""

Progress: TypeAlias = Callable[[str, int, int], None]


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
@dataclass(frozen=True, eq=False, slots=True)
class Generation:
    """A policy that was learnt: after how many episodes and decisions, and how it did.

    explored: the episodes that it was learnt from last. tried: the policy itself. failed: numbers
    of the worlds where that failed. took: no part of what follows from the seed.
    """

    episodes: int
    decisions: int
    explored: Trial
    tried: Trial
    failed: tuple[int, ...]
    rules: DecisionList
    took: Took


@final
@dataclass(slots=True)
class Course:
    """A training so far: everything that it goes on from; `lived` has an entry per episode."""

    lived: list[Steps] = field(default_factory=list)
    generations: list[Generation] = field(default_factory=list)

    @property
    def best(self) -> Generation:
        """The policy that was worth most; of equal ones the first."""
        return max(self.generations, key=lambda each: each.tried.reward)

    @property
    def episodes(self) -> int:
        """How many were lived to learn from."""
        return self.generations[-1].episodes if self.generations else 0

    def is_over(self, settings: Settings) -> bool:
        """Whether all episodes are lived, or it got no better for long enough."""
        if not self.generations:
            return False
        return self.episodes >= settings.episodes or self.is_stale(settings)

    def is_stale(self, settings: Settings) -> bool:
        """Whether it got no better for long enough."""
        behind = len(self.generations) - 1 - self.generations.index(self.best)
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
    before, standing = course.episodes, _standing(course)
    tasks = exploring_tasks(course, settings)
    after = before + len(tasks)

    def told(what: str, done: int, of: int) -> None:
        lived = before + done if what == EXPLORING else after
        tell(f"{what} {done} of {of}{standing}", lived, settings.episodes)

    clock = [perf_counter()]
    episodes = live_through(workers, tasks, EXPLORING, told)
    clock.append(perf_counter())
    tell(f"learning{standing}", after, settings.episodes)
    lived = [*course.lived, *(episode.steps for episode in episodes)]
    found = policy_of(lived, scenario, settings, len(course.generations))
    clock.append(perf_counter())
    rules, tried = _best_of(found.lists, settings.tried_in, workers, told)
    clock.append(perf_counter())
    course.lived = lived
    return Generation(
        episodes=after,
        decisions=sum(len(steps) for steps in lived),
        explored=trial_of(episodes),
        tried=trial_of(tried),
        failed=tuple(i for i, each in enumerate(tried) if not each.succeeded),
        rules=rules,
        took=Took(*np.diff(clock).tolist()),
    )


def _best_of(
    lists: Sequence[DecisionList], worlds: int, workers: Workers, tell: Progress
) -> tuple[DecisionList, list[Episode]]:
    """The list that does best in the first few of the worlds, and how it does in all of them."""
    few = min(FIRST, worlds)
    tasks = [task for rules in lists for task in trial_tasks(rules, few, For.CHOOSING)]
    episodes = live_through(workers, tasks, "trying all lists", tell)
    each = [episodes[i * few : (i + 1) * few] for i in range(len(lists))]
    best = max(range(len(lists)), key=lambda i: trial_of(each[i]).reward)
    more = trial_tasks(lists[best], worlds, For.CHOOSING)[few:]
    return lists[best], [*each[best], *live_through(workers, more, "trying the best", tell)]


def exploring_tasks(course: Course, settings: Settings) -> list[Task]:
    """The next episodes: in new worlds, and in some of those that the last policy failed in."""
    before, number = course.episodes, len(course.generations)
    count = min(settings.each, settings.episodes - before)
    new = [world(For.LEARNING, before + i, settings.seed) for i in range(count)]
    if not course.generations:
        return [Task(each, AtRandom(), 1.0, before + i) for i, each in enumerate(new)]
    last = course.generations[-1]
    chance = np.random.default_rng([settings.seed, number, AGAIN])
    failed = chance.permutation(last.failed)[: int(settings.again * count)].tolist()
    again = [world(For.CHOOSING, int(i)) for i in failed]
    worlds = [*again, *new[len(again) :]]
    return [Task(each, last.rules, settings.explore, before + i) for i, each in enumerate(worlds)]


def policy_of(lived: Sequence[Steps], scenario: Scenario, settings: Settings, number: int) -> Found:
    """What is learnt from all steps so far, in the generation of that number.

    Rules have bounds of few digits, and decide on these steps as those that were learnt.
    """
    arbiter, steps = trained_arbiter(scenario), joined(lived)
    found = found_policy(
        steps,
        ranges_of(arbiter),
        len(arbiter.choices),
        discount=training_of(scenario).discount,
        learner=settings.learner,
        seed=settings.seed + number,
        most=settings.rules,
    )
    return replace(found, lists=tuple(shortened(rules, steps.x) for rules in found.lists))


def ranges_of(arbiter: Arbiter) -> tuple[Array, Array]:
    """The lowest and the highest of what it reads, (m,) each, SI; of a value by name its index."""
    low = [0.0 if each.values else each.low for each in arbiter.reads]
    high = [float(len(each.values) - 1) if each.values else each.high for each in arbiter.reads]
    return np.array(low), np.array(high)


def trial_tasks(policy: Policy, worlds: int, purpose: For, explore: float = 0.0) -> list[Task]:
    """Episodes of a policy in the worlds of a purpose, the same for all policies."""
    return [Task(world(purpose, i), policy, explore) for i in range(worlds)]


def trial_of(episodes: Sequence[Episode]) -> Trial:
    """The means."""
    return Trial(
        reward=float(np.mean([each.total for each in episodes])),
        success=float(np.mean([each.succeeded for each in episodes])),
        seconds=float(np.mean([each.seconds for each in episodes])),
        decisions=sum(len(each.steps) for each in episodes),
    )


def live_through(
    workers: Workers, tasks: Sequence[Task], what: str, tell: Progress
) -> list[Episode]:
    """All episodes, in their order; `tell` is told `what`, how many are done, and of how many."""
    episodes: list[Episode] = []
    tell(what, 0, len(tasks))
    for episode in workers.lived(tasks):
        episodes.append(episode)
        tell(what, len(episodes), len(tasks))
    return episodes


def _standing(course: Course) -> str:
    """How the last policy did, and the best if that is another."""
    if not course.generations:
        return ""
    best, last = course.best.tried, course.generations[-1].tried
    told = f"; last: reward {last.reward:.3g}, success {100 * last.success:.0f} %"
    return told if best is last else f"{told} (best {best.reward:.3g})"
