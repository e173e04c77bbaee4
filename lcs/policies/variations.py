"""Lists that differ a little from one: what a trial may find to be better than all that was learnt.

What an action is worth is known from what was lived as well as noise allows, and what is not read.
A trial knows neither limit, so near the best list so far trials are the judge.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

import numpy as np

from lcs.arrays import Array
from lcs.policies.decision_list import DecisionList

TWICE: Final = 0.5
"""How often a list is changed a second time."""
AS_FAR: Final = 0.1
"""How far a bound moves: a deviation of the share of lived places that are below it."""

Change: TypeAlias = Callable[[DecisionList], DecisionList]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Variation:
    """Draws lists that differ a little from another.

    others: lists whose rules may come into it. x: lived places (T, n), among which bounds move.
    actions: how many there are. most: rules. chance: of all that.
    """

    others: Sequence[DecisionList]
    x: Array
    actions: int
    most: int
    chance: np.random.Generator

    def of(self, rules: DecisionList) -> DecisionList:
        """The list with one change or two, or none where the one that was drawn is not possible.

        A bound moves or goes, a rule goes, comes, changes places with another, or its action.
        """
        common: tuple[Change, ...] = (self.moved, self.more)
        rare: tuple[Change, ...] = (self.moved, self.wider, self.fewer, self.swapped, self.acting)
        changes = (*common, *common, *rare)
        for _ in range(1 + (self.chance.random() < TWICE)):
            rules = changes[self._one_of(len(changes))](rules)
        return rules

    def moved(self, rules: DecisionList) -> DecisionList:
        """A bound is moved to another lived place."""
        side, found = self._some_bound(rules)
        if found is None:
            return rules
        values = np.sort(self.x[:, found[1]])
        share = np.searchsorted(values, getattr(rules, side)[found]) / len(values)
        shifted = np.clip(share + AS_FAR * self.chance.standard_normal(), 0.0, 1.0)
        return rules.with_bound(*found, side, float(np.quantile(values, shifted)))

    def wider(self, rules: DecisionList) -> DecisionList:
        """A bound goes."""
        side, found = self._some_bound(rules)
        if found is None:
            return rules
        return rules.without_bound(*found, side)

    def fewer(self, rules: DecisionList) -> DecisionList:
        """A rule goes."""
        if not len(rules):
            return rules
        return rules.without(self._one_of(len(rules)))

    def swapped(self, rules: DecisionList) -> DecisionList:
        """Two rules change places."""
        if len(rules) < 2:
            return rules
        order = np.arange(len(rules))
        one, other = self.chance.permutation(len(rules))[:2]
        order[[one, other]] = order[[other, one]]
        return rules.in_order(order)

    def acting(self, rules: DecisionList) -> DecisionList:
        """Another action is taken by a rule, or where none holds."""
        rule, action = self._one_of(len(rules) + 1), self._one_of(self.actions)
        if rule == len(rules):
            return replace(rules, otherwise=action)
        actions = rules.action.copy()
        actions[rule] = action
        return replace(rules, action=actions)

    def more(self, rules: DecisionList) -> DecisionList:
        """A rule of another list comes in somewhere."""
        given = [other for other in self.others if len(other)]
        if not given or len(rules) >= self.most:
            return rules
        other = given[self._one_of(len(given))]
        rule, place = self._one_of(len(other)), self._one_of(len(rules) + 1)
        bounds = other.lower[rule], other.upper[rule]
        return rules.with_rule(place, int(other.action[rule]), *bounds)

    def _some_bound(self, rules: DecisionList) -> tuple[str, tuple[int, int] | None]:
        """A side, and a rule and an input with a bound there; None where there is no bound."""
        bounds = [
            (side, (int(rule), int(i)))
            for side in ("lower", "upper")
            for rule, i in np.argwhere(np.isfinite(getattr(rules, side)))
        ]
        return bounds[self._one_of(len(bounds))] if bounds else ("", None)

    def _one_of(self, count: int) -> int:
        return int(self.chance.integers(count))
