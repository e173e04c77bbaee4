"""A policy from what was lived: what actions are worth, rules for the best ones, few of them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np
import numpy.typing as npt

from lcs.alcsr.config import GROWN
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Array, Booleans, Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.listing import Offer, counted, listed
from lcs.policies.steps import Steps
from lcs.policies.worth import worth_of
from lcs.rules.deciding import decide
from lcs.rules.table import RuleTable
from lcs.xcsr.learner import XCSR

GOOD: Final = 1_000.0
WORSE: Final = 0.0
"""What a learner is rewarded with for an action that is as good as the best, and for another."""
EQUAL: Final = 0.1
"""An action is as good as the best where it loses no more than this share of what is at stake.

At stake is the difference of the best and the worst action, in the middle of all places.
"""
MOST_RULES: Final = 20
TAUGHT: Final = 6_000
"""Places that rules are learnt from: so many tell as much as all, the more so as those where more
is at stake are more likely among them."""
LISTED: Final = 12_000
"""Places that lists are made for."""
DRAWS: Final = 2
"""How often rules are learnt, each time from other places: lists that lose as little may do as
differently in trials as any."""

Making: TypeAlias = Callable[[int, Array, Array, int], ALCSR | XCSR]
"""From the number of actions, the lowest and the highest inputs (n,), and a seed."""


def _alcsr(actions: int, low: Array, high: Array, seed: int) -> ALCSR:
    n = len(low)
    return ALCSR(actions, n, GROWN, reward_range=GOOD, low=low, high=high, seed=seed)


def _xcsr(actions: int, low: Array, high: Array, seed: int) -> XCSR:
    return XCSR(actions, len(low), low=low, high=high, seed=seed)


LEARNERS: Final[dict[str, Making]] = {"alcsr": _alcsr, "xcsr": _xcsr}


@final
@dataclass(frozen=True, eq=False, slots=True)
class Voting:
    """The policy of all rules of a table, by their vote; `otherwise` where it knows nothing."""

    table: RuleTable
    otherwise: int

    def decide(self, inputs: npt.ArrayLike) -> Integers:
        """The actions (T,) at inputs (T, n)."""
        best = decide(self.table, inputs).best
        return np.where(best < 0, self.otherwise, best)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Found:
    """Lists of few rules, and all the rules that they were chosen from.

    lists: of each draw one for each action, which takes it where no rule holds; how often rules are
    right is not counted. Which is best is not told by what single decisions lose: an action that is
    nearly as good as the best, once, may lead to nothing if it is always taken. It takes a trial.
    tables: all rules, of each draw. x: all lived places (D, n), within their ranges. cost (D, A):
    what an action loses there against the best one. good (D, A): whether it is as good as that.
    """

    lists: tuple[DecisionList, ...]
    tables: tuple[RuleTable, ...]
    x: Array
    cost: Array
    good: Booleans

    def counted(self, rules: DecisionList) -> DecisionList:
        """A list with how often its rules are right by what is known here."""
        return counted(rules, self.x, self.good)


def found_policy(
    lived: Steps,
    ranges: tuple[Array, Array],
    actions: int,
    *,
    discount: float,
    learner: str,
    seed: int,
    most: int = MOST_RULES,
) -> Found:
    """What a learner makes of what was lived; the same for the same steps and seed.

    Args:
        lived: all steps of all episodes.
        ranges: the lowest and the highest inputs, (n,) each.
        actions: how many there are.
        discount: what a reward is worth one step later.
        learner: one of `LEARNERS`.
        seed: of all chance.
        most: rules.

    Raises:
        LearnerError: something is not finite, or out of range.
    """
    worth = worth_of(lived, actions, discount, seed)
    cost = worth.max(axis=1, keepdims=True) - worth
    stake = cost.max(axis=1)
    tolerance = EQUAL * float(np.median(stake))
    x, good = np.clip(lived.x, *ranges), cost <= tolerance
    lists: list[DecisionList] = []
    tables: list[RuleTable] = []
    for draw in range(DRAWS):
        chance = np.random.default_rng([seed, draw])
        taught = drawn(chance, stake, TAUGHT)
        made = LEARNERS[learner](actions, *ranges, int(chance.integers(2**31)))
        made.teach(x[taught], np.where(good, GOOD, WORSE)[taught])
        tables.append(made.rules())
        offer, some = offer_of(tables[-1]), drawn(chance, np.ones(len(x)), LISTED)
        lists += (
            listed(offer, x[some], cost[some], otherwise, most=most) for otherwise in range(actions)
        )
    return Found(tuple(lists), tuple(tables), x, cost, good)


def drawn(chance: np.random.Generator, weight: Array, most: int) -> Integers:
    """Indices of different ones, `most` of them or all; the heavier, the likelier, (T,)."""
    able = int(np.count_nonzero(weight))
    if not able:
        return chance.permutation(len(weight))[:most]
    return chance.choice(len(weight), min(most, able), replace=False, p=weight / weight.sum())


def offer_of(table: RuleTable) -> Offer:
    """The rules that say that their action is good."""
    good = table.prediction > 0.5 * (GOOD + WORSE)
    lower = np.where(table.lower > table.low, table.lower, -np.inf)[good]
    upper = np.where(table.upper < table.high, table.upper, np.inf)[good]
    return Offer(table.action[good], lower, upper)
