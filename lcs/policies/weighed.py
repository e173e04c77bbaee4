"""A list on examples, arranged so that what a change of one rule costs or saves is soon known."""

from dataclasses import dataclass
from typing import final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.policies.decision_list import DecisionList, holds


@final
@dataclass(frozen=True, eq=False, slots=True)
class Weighed:
    """A list of R rules on T examples, and what it loses there.

    x (T, n). cost (A, T): what each action loses. unmet (R + 1, T): where no rule before each one
    holds; the last: where none does. lost (R + 1, T): what is lost where the rules from each one on
    decide alone; the last: where none decides.
    """

    rules: DecisionList
    x: Array
    cost: Array
    unmet: Booleans
    lost: Array

    def saved(self, action: Integers, held: Array) -> Array:
        """What each of C rules more would save at each place in the list, (R + 1, C).

        action (C,). held (C, T): 1 where its box holds, else 0.
        """
        saves = np.where(self.unmet[:, None], self.lost[:, None] - self.cost, 0.0)  # (R + 1, A, T)
        places, actions, examples = saves.shape
        inside = held @ saves.reshape(places * actions, examples).T
        of_each = inside.reshape(len(held), places, actions)
        own: Array = of_each[np.arange(len(held)), :, action].T
        return own

    def costs(self, changed: DecisionList, rule: int) -> float:
        """What is lost more by a list that differs in the bounds of this rule alone."""
        own = slice(rule, rule + 1)
        held = holds(changed.lower[own], changed.upper[own], self.x)[0]
        lost = np.where(held, self.cost[self.rules.action[rule]], self.lost[rule + 1])
        return self._more(rule, lost)

    def costs_without(self, rule: int) -> float:
        """What is lost more without this rule."""
        return self._more(rule, self.lost[rule + 1])

    def instead(self, rules: DecisionList) -> "Weighed":
        """Another list on the same examples."""
        return weighed(rules, self.x, self.cost)

    def _more(self, rule: int, lost: Array) -> float:
        return float((lost - self.lost[rule])[self.unmet[rule]].sum())


def weighed(rules: DecisionList, x: Array, cost: Array) -> Weighed:
    """A list on examples (T, n) where actions cost (A, T)."""
    held = holds(rules.lower, rules.upper, x)
    unmet = np.ones((len(rules) + 1, len(x)), np.bool_)
    np.logical_and.accumulate(~held, axis=0, out=unmet[1:])
    lost = np.empty((len(rules) + 1, len(x)))
    lost[-1] = cost[rules.otherwise]
    for rule in reversed(range(len(rules))):
        lost[rule] = np.where(held[rule], cost[rules.action[rule]], lost[rule + 1])
    return Weighed(rules, x, cost, unmet, lost)
