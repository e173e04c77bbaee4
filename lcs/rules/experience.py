"""What was seen of a problem: inputs, and the rewards of actions as far as they are known."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Integers
from lcs.faults import LearnerError
from lcs.rules.deciding import decide
from lcs.rules.table import RuleTable

MOST_LEVELS: Final = 64
"""Different rewards, at most."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Experience:
    """T inputs (T, n), and rewards (T, A), NaN where an action was not tried."""

    inputs: Array
    rewards: Array

    @property
    def levels(self) -> Array:
        """The different rewards, ascending.

        Raises:
            LearnerError: there are none, or too many to be levels.
        """
        found: Array = np.unique(self.rewards[np.isfinite(self.rewards)])
        if not 0 < len(found) <= MOST_LEVELS:
            raise LearnerError(
                f"rules are compacted by reward levels, 1 to {MOST_LEVELS} different rewards; "
                f"these examples have {len(found)}"
            )
        return found


def experience_of(inputs: npt.ArrayLike, rewards: npt.ArrayLike) -> Experience:
    """Examples whose rewards (T, A) are known for all actions; NaN where one is not.

    Raises:
        LearnerError: the sizes differ, or an input is not finite.
    """
    x, given = np.ascontiguousarray(inputs, np.float64), np.asarray(rewards, np.float64)
    if x.ndim != 2 or given.ndim != 2 or len(x) != len(given):
        raise LearnerError(f"inputs (T, n) and rewards (T, A) differ: {x.shape}, {given.shape}")
    if not np.isfinite(x).all():
        raise LearnerError("an input of these examples is not finite")
    return Experience(x, given)


def remembered(
    inputs: npt.ArrayLike, action: npt.ArrayLike, reward: npt.ArrayLike, actions: int
) -> Experience:
    """Examples of which one action (T,) was tried, and its reward (T,) is known.

    Raises:
        LearnerError: the sizes differ, or an action is none of 0 to `actions` - 1.
    """
    tried, given = np.asarray(action, np.int64), np.asarray(reward, np.float64)
    if tried.shape != given.shape or tried.ndim != 1:
        raise LearnerError(f"actions and rewards differ: {tried.shape}, {given.shape}")
    if tried.size and not 0 <= tried.min() <= tried.max() < actions:
        raise LearnerError(f"actions are 0 to {actions - 1}; got {tried.min()} to {tried.max()}")
    rewards = np.full((len(tried), actions), np.nan)
    rewards[np.arange(len(tried)), tried] = given
    return experience_of(inputs, rewards)


@final
@dataclass(frozen=True, slots=True)
class Accuracy:
    """How good rules are on examples; uncovered ones count as wrong.

    expected: share of the known rewards whose level the rules expect. decided: share of the inputs
    with all rewards known whose best action is decided for; NaN where there are none. uncovered:
    share of the inputs of which some action is unknown to the rules.
    """

    expected: float
    decided: float
    uncovered: float


def accuracy(table: RuleTable, seen: Experience) -> Accuracy:
    """How good rules are on examples."""
    said = decide(table, seen.inputs)
    known = np.isfinite(seen.rewards)
    is_level = nearest_level(said.expected, seen.levels) == nearest_level(seen.rewards, seen.levels)
    whole = known.all(axis=1)
    best = np.where(said.best < 0, 0, said.best)
    taken = np.take_along_axis(seen.rewards, best[:, None], axis=1)[:, 0]
    is_best = (said.best >= 0) & (taken == seen.rewards.max(axis=1))
    return Accuracy(
        expected=float((is_level & known).sum() / known.sum()),
        decided=float(is_best[whole].mean()) if whole.any() else float("nan"),
        uncovered=float((said.best < 0).mean()) if len(said.best) else float("nan"),
    )


def nearest_level(values: Array, levels: Array) -> Integers:
    """Index of the level nearest to each value, the lower of two; -1 of NaN."""
    middles = (levels[1:] + levels[:-1]) / 2.0
    found = np.searchsorted(middles, values)
    return np.where(np.isnan(values), -1, found)
