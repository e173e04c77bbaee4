"""What a learner of several steps does, in few rules: where each action is as good as the best."""

import dataclasses
from typing import Final

import numpy as np

from lcs.arrays import Array
from lcs.rules.compaction import Compacted, compact
from lcs.rules.deciding import boxes_hold
from lcs.rules.experience import Experience, accuracy
from lcs.rules.parts import rules_of
from lcs.rules.table import RuleTable
from lcs.steps.learner import StepsLearner

GOOD: Final = 1.0
WORSE: Final = 0.0
"""The levels of the rules."""
JUDGED_WRONGLY: Final = 0.05
"""The share of places where an action may be judged wrongly; small islands are passed over."""
ISLAND: Final = 0.01
"""Rules for a smaller share of the places are left out."""


def policy(learner: StepsLearner, places: Array, tolerance: float) -> Compacted:
    """Few rules that say at places (T, n) which actions are `GOOD` and which `WORSE`.

    An action is good where it is expected to lead to as much as the best one, less `tolerance`: of
    the order of what is lost by one step in vain. Some 1,500 places take seconds.
    What a rule was right and wrong in are places, those of small islands among them. Where nothing
    is known, there are no rules.

    Raises:
        LearnerError: no place is given, or not n finite numbers each.
    """
    bodies, table = learner.bodies, learner.rules()
    family = slice(0, bodies.first[1])
    lower = np.clip(bodies.lower[family], table.low, table.high)
    upper = np.clip(bodies.upper[family], table.low, table.high)
    count = len(lower)
    seeds = RuleTable(
        actions=learner.actions,
        action=np.tile(np.arange(learner.actions), count),
        lower=np.repeat(lower, learner.actions, axis=0),
        upper=np.repeat(upper, learner.actions, axis=0),
        prediction=judged(learner, 0.5 * (lower + upper), tolerance).ravel(),
        weight=np.ones(count * learner.actions),
        right=bodies.meals[family].ravel(),
        wrong=np.zeros(count * learner.actions, np.int64),
        low=table.low,
        high=table.high,
    )
    seen = Experience(places, judged(learner, places, tolerance))
    few = compact(seeds, seen, noise=JUDGED_WRONGLY)
    return _without_islands(few, seen, least=ISLAND if bodies.meals.any() else np.inf)


def _without_islands(few: Compacted, seen: Experience, least: float) -> Compacted:
    """The rules that hold at this share of places, with counts of what is judged there."""
    table = few.table
    holds = boxes_hold(table.lower, table.upper, table.high, seen.inputs)
    agrees = seen.rewards.T[table.action] == table.prediction[:, None]
    right, wrong = (holds & agrees).sum(axis=1), (holds & ~agrees).sum(axis=1)
    weight = (right + 1.0) / (wrong + 1.0)
    counted = dataclasses.replace(table, right=right, wrong=wrong, weight=weight)
    kept = rules_of(counted, right + wrong >= least * len(seen.inputs))
    return dataclasses.replace(few, table=kept, after=accuracy(kept, seen))


def judged(learner: StepsLearner, places: Array, tolerance: float) -> Array:
    """`GOOD` or `WORSE` for each action (T, A) at places (T, n)."""
    _, worth = learner.decide(places)
    return np.where(worth >= worth.max(axis=1, keepdims=True) - tolerance, GOOD, WORSE)
