"""A decision list: boxes in an order; the first that holds says what is done (Rivest 1987)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np
import numpy.typing as npt

from lcs.arrays import Array, Booleans, Integers
from lcs.given import inputs_of

OF_EACH: Final = "action", "lower", "upper", "right", "wrong"
"""What a list has of each of its rules."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class DecisionList:
    """R rules for n inputs, and the action `otherwise`, where none of them holds.

    action (R,). lower, upper (R, n): a rule holds where lower <= x < upper in each input; bounds
    are infinite where nothing is asked. right, wrong (R,): of the examples that it was the first
    to hold on, how often its action was as good as the best, and how often it was not.
    """

    action: Integers
    lower: Array
    upper: Array
    right: Integers
    wrong: Integers
    otherwise: int

    def __len__(self) -> int:
        """How many rules, `otherwise` not among them."""
        return len(self.action)

    @property
    def conditions(self) -> int:
        """How many bounds its rules have."""
        return int(np.isfinite(self.lower).sum() + np.isfinite(self.upper).sum())

    def bounds_of(self, rule: int) -> Iterator[tuple[int, str, float]]:
        """Input, side and value of each bound of a rule."""
        for side in ("lower", "upper"):
            values = getattr(self, side)[rule]
            for i in np.flatnonzero(np.isfinite(values)):
                yield int(i), side, float(values[i])

    def bounds(self) -> Iterator[tuple[int, int, str, float]]:
        """Rule, input, side and value of each bound, those of the last rule first."""
        for rule in reversed(range(len(self))):
            for i, side, value in self.bounds_of(rule):
                yield rule, i, side, value

    def decide(self, inputs: npt.ArrayLike) -> Integers:
        """The action at each of the inputs (T, n), as (T,).

        Raises:
            LearnerError: not n finite numbers each.
        """
        first = self.first(inputs)
        actions = np.append(self.action, self.otherwise)
        taken: Integers = actions[first]
        return taken

    def first(self, inputs: npt.ArrayLike) -> Integers:
        """Which rule is the first to hold at inputs (T, n), as (T,); R where none does.

        Raises:
            LearnerError: not n finite numbers each.
        """
        return first_to_hold(self.lower, self.upper, inputs_of(inputs, self.lower.shape[1]))

    def in_order(self, order: Integers) -> "DecisionList":
        """These of its rules, in this order."""
        return replace(self, **{name: getattr(self, name)[order] for name in OF_EACH})

    def without(self, rule: int) -> "DecisionList":
        """All but one of its rules."""
        return self.in_order(np.delete(np.arange(len(self)), rule))

    def without_bound(self, rule: int, i: int, side: str) -> "DecisionList":
        """The list without the `lower` or `upper` bound of a rule in input i."""
        return self.with_bound(rule, i, side, -np.inf if side == "lower" else np.inf)

    def closed(self) -> "DecisionList":
        """The same decisions without the rules from one on that always holds."""
        asks = np.isfinite(self.lower).any(axis=1) | np.isfinite(self.upper).any(axis=1)
        if asks.all():
            return self
        last = int(asks.argmin())
        return replace(self.in_order(np.arange(last)), otherwise=int(self.action[last]))

    def with_rule(self, place: int, action: int, lower: Array, upper: Array) -> "DecisionList":
        """The list with one rule more, before the one at this place; its bounds (n,)."""
        return replace(
            self,
            action=np.insert(self.action, place, action),
            lower=np.insert(self.lower, place, lower, axis=0),
            upper=np.insert(self.upper, place, upper, axis=0),
            right=np.insert(self.right, place, 0),
            wrong=np.insert(self.wrong, place, 0),
        )

    def with_bound(self, rule: int, i: int, side: str, value: float) -> "DecisionList":
        """The list with another `lower` or `upper` bound of a rule in input i."""
        bounds = getattr(self, side).copy()
        bounds[rule, i] = value
        return replace(self, **{side: bounds})


def uncounted(action: Integers, lower: Array, upper: Array, otherwise: int) -> DecisionList:
    """The list of these rules, of which nothing is known yet."""
    nothing = np.zeros(len(action), np.int64)
    return DecisionList(action, lower, upper, nothing, nothing, otherwise)


def always(action: int, inputs: int) -> DecisionList:
    """The list without rules."""
    no_bounds = np.zeros((0, inputs))
    return uncounted(np.zeros(0, np.int64), no_bounds, no_bounds, action)


def first_to_hold(lower: Array, upper: Array, x: Array) -> Integers:
    """Which of R boxes (R, n) is the first to hold each of the inputs (T, n); R where none does."""
    held = np.ones((len(lower) + 1, len(x)), np.bool_)
    held[:-1] = holds(lower, upper, x)
    found: Integers = held.argmax(axis=0)
    return found


def holds(lower: Array, upper: Array, x: Array) -> Booleans:
    """Which boxes (R, n) hold which inputs (T, n), as (R, T)."""
    inside = np.ones((len(lower), len(x)), np.bool_)
    for i in range(x.shape[1]):
        inside &= (x[:, i] >= lower[:, i, None]) & (x[:, i] < upper[:, i, None])
    return inside
