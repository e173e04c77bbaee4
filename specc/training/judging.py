"""The best policy beside others, in worlds that no policy was learnt or chosen in."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.learner import Voting
from lcs.policies.policy import Policy
from lcs.rules.table import RuleTable
from runtime.arbiter import Arbiter
from runtime.machine import evaluate
from runtime.progress import Progress
from specc.training.course import Trial, trial_of
from specc.training.episode import Task
from specc.training.living import live_through
from specc.training.training import AtRandom
from specc.training.workers import Workers
from specc.training.worlds import For, world
from verifier.arbitration.shares import interval_of

CONFIDENCE: Final = 0.95


@final
@dataclass(frozen=True, slots=True)
class Judged:
    """How something that decides did in the worlds held out.

    what: in a few words. rules: how many it has; None where it has none. low, high: the interval of
    its success. failed: seeds of the worlds where it failed.
    """

    what: str
    rules: int | None
    trial: Trial
    low: float
    high: float
    failed: tuple[int, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class AsItWas:
    """The policy of an arbiter whose rules are boxes of what it reads."""

    arbiter: Arbiter

    def decide(self, inputs: npt.ArrayLike) -> Integers:
        """The choices (T,) at reads (T, m)."""
        x: Array = np.asarray(inputs, np.float64)
        names = tuple(read.name for read in self.arbiter.reads)
        choices = np.array([rule.choice for rule in self.arbiter.rules])
        held = np.ones((len(x), len(choices)), np.bool_)
        for place, rule in enumerate(self.arbiter.rules):
            if rule.when is not None:
                held[:, place] = evaluate([rule.when], names, x)[:, 0] != 0.0
        chosen: Integers = choices[held.argmax(axis=1)]
        return chosen


def judged(
    learnt: tuple[DecisionList, RuleTable],
    arbiter: Arbiter,
    worlds: int,
    workers: Workers,
    tell: Progress,
) -> tuple[Judged, ...]:
    """What was learnt, all rules learnt, the arbiter as it was, and chance.

    learnt: the list, and these rules. arbiter: before training. worlds: how
    many, the same for all.
    """
    done: list[Judged] = []
    beside = list(_beside(*learnt, arbiter))
    total = len(beside) * worlds
    for what, rules, policy, explore in beside:

        def told(_what: str, count: int, of: int, what: str = what) -> None:
            so_far = len(done) * worlds
            tell(f"judging in worlds held out: {what}, {count} of {of}", so_far + count, total)

        seeds = [world(For.JUDGING, i) for i in range(worlds)]
        tasks = [Task(seed, policy, explore) for seed in seeds]
        episodes = live_through(workers, tasks, what, told)
        succeeded = [each.succeeded for each in episodes]
        low, high = interval(float(np.mean(succeeded)), worlds)
        failed = tuple(s for s, good in zip(seeds, succeeded, strict=True) if not good)
        done.append(Judged(what, rules, trial_of(episodes), low, high, failed))
    return tuple(done)


def interval(success: float, worlds: int) -> tuple[float, float]:
    """Where a share of so many worlds lies, after Clopper and Pearson (1934), by `CONFIDENCE`."""
    found = interval_of(success, worlds, CONFIDENCE)
    return found.low, found.high


def _beside(
    rules: DecisionList, table: RuleTable, arbiter: Arbiter
) -> Iterator[tuple[str, int | None, Policy, float]]:
    """What is judged: its name, how many rules it has, its policy, and how much it tries."""
    yield "what was learnt", len(rules), rules, 0.0
    yield "all rules learnt, by their vote", len(table), Voting(table, rules.otherwise), 0.0
    if len(arbiter.rules) > 1:  # the last one always holds
        yield "the arbiter as it was", len(arbiter.rules) - 1, AsItWas(arbiter), 0.0
    yield "choices at random", None, AtRandom(), 1.0
