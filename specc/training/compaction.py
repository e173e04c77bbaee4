"""The best list made plain: rules, conditions and digits go that trials do not need.

What a rule saves by what is known of worth tells little of what a list does without it: lists that
lose as little succeed in 58 to 75 of 100 worlds. So each change is tried, in the same worlds, where
the list would live anything else than it did.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import methodcaller
from typing import Final, TypeAlias, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.shortened import shortened
from lcs.rules.digits import of_digits
from runtime.progress import Progress
from specc.training.race import Racer, heat, heats, would_live
from specc.training.remembered import Remembered
from specc.training.workers import Workers

RARE: Final = 0.4
"""A change is tried if the list would live anything else in no more than this share of the worlds:
one that matters more often is hardly needless, and takes long to try."""
DIGITS: Final = 1, 2, 3
"""Digits that bounds are rounded to."""

ROUNDING: Final = 1e-9
"""Of a reward: sums of the same numbers differ by less."""

Change: TypeAlias = Callable[[DecisionList], DecisionList]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Trials:
    """Where lists are tried, who lives the trials, who is told how far they are, what is known."""

    worlds: Sequence[int]
    workers: Workers
    tell: Progress
    remembered: Remembered

    def unless_worse(self, now: Racer, change: Change, floor: float) -> Racer:
        """The changed list, unless it succeeds less often or has less reward than `floor`.

        Raises:
            NoRoomError, UserCodeError, SpecError: as `Workers.lived`.
        """
        changed = Racer(change(now.rules))
        if touched(changed.rules, now) > RARE * len(self.worlds):
            return now
        if not self.remembered.stays(lambda: self._is_as_good(changed, now, floor)):
            return now
        self._live(changed, now, len(self.worlds))
        return changed

    def _is_as_good(self, changed: Racer, now: Racer, floor: float) -> bool:
        for upto in heats(len(self.worlds)):
            self._live(changed, now, upto)
            if Racer(now.rules, now.episodes[:upto]).beats(changed):
                return False
        success, reward = changed.standing
        return success >= now.standing[0] and reward >= floor

    def _live(self, changed: Racer, now: Racer, upto: int) -> None:
        """Its episodes in so many worlds, but for those that it has."""
        what = f"making it plain: rules {len(now.rules)}, conditions {now.rules.conditions}"

        def told(_: str, done: int, of: int) -> None:
            self.tell(what, done, of)

        more = self.worlds[len(changed.episodes) : upto]
        if more:
            heat([changed], now, more, self.workers, told)


def compacted(best: Racer, trials: Trials) -> Racer:
    """The list without the rules, conditions and digits without which it succeeds as often.

    What matters in the fewest worlds goes first: in all others the list lives as before. Its reward
    stays within a standard error of what it was.

    Args:
        best: a list that has its episodes in all worlds of the trials.
        trials: how a change is tried.

    Raises:
        NoRoomError, UserCodeError, SpecError: as `Workers.lived`.
    """
    floor = _floor(best)
    now = _without_rules(best, trials, floor)
    for changes in (_wider, _rounder):
        for change in _rarest_first(now, changes(now.rules)):
            now = trials.unless_worse(now, change, floor)
    now = _without_rules(now, trials, floor)
    for change in (_shorter(now), DecisionList.closed):
        now = trials.unless_worse(now, change, floor)
    return now


def _floor(best: Racer) -> float:
    """The mean reward less its standard error, and less what sums of many numbers err by."""
    total = np.array([each.total for each in best.episodes])
    error = total.std() / np.sqrt(len(total))
    return float(total.mean() - error - ROUNDING * np.abs(total).max())


def touched(rules: DecisionList, now: Racer) -> int:
    """In how many worlds a list would live anything else than one that ran there."""
    return would_live(rules, now.episodes, now.rules).count(False)


def _without_rules(now: Racer, trials: Trials, floor: float) -> Racer:
    """The list without its needless rules, each of which is tried once."""
    left = list(range(len(now.rules)))
    rare = sorted(left, key=lambda rule: touched(now.rules.without(rule), now))
    for rule in rare:
        fewer = trials.unless_worse(now, methodcaller("without", left.index(rule)), floor)
        if fewer is not now:
            now = fewer
            left.remove(rule)
    return now


def _wider(rules: DecisionList) -> Iterator[Change]:
    """Each of its bounds gone."""
    for rule, i, side, _ in rules.bounds():
        yield methodcaller("without_bound", rule, i, side)


def _rounder(rules: DecisionList) -> Iterator[Change]:
    """Each of its bounds in few digits, a little lower or higher."""
    for rule, i, side, _ in rules.bounds():
        for digits in DIGITS:
            for up in (False, True):
                yield partial(_rounded, bound=(rule, i, side), digits=digits, up=up)


def _rounded(
    rules: DecisionList, *, bound: tuple[int, int, str], digits: int, up: bool
) -> DecisionList:
    """With one of its bounds in so many digits; as it is where that has no more."""
    rule, i, side = bound
    value = float(getattr(rules, side)[rule, i])
    return rules.with_bound(rule, i, side, of_digits(value, digits, up=up))


def _rarest_first(now: Racer, changes: Iterator[Change]) -> list[Change]:
    return sorted(changes, key=lambda change: touched(change(now.rules), now))


def _shorter(now: Racer) -> Change:
    """Bounds of as few digits as leave each decision that it took as it is."""
    places = np.concatenate([each.places for each in now.episodes])
    return partial(_shortened, places=places)


def _shortened(rules: DecisionList, places: Array) -> DecisionList:
    """With a shorter bound wherever there is one."""
    short = shortened(rules, places)
    pairs = (short.lower, rules.lower), (short.upper, rules.upper)
    lower, upper = (np.where(_digits(new) < _digits(old), new, old) for new, old in pairs)
    return replace(rules, lower=lower, upper=upper)


def _digits(bounds: Array) -> Integers:
    """How long each is when it is written; 0 of one that asks for nothing."""
    lengths = [len(repr(bound)) if np.isfinite(bound) else 0 for bound in bounds.ravel().tolist()]
    return np.array(lengths, np.int64).reshape(bounds.shape)
