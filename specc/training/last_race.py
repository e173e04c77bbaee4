"""The last race: the best of all generations, without the rules that it does not need."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Integers
from lcs.policies.decision_list import DecisionList
from specc.training.course import Course, Generation, Trial, trial_of
from specc.training.living import Progress
from specc.training.race import Racer, heat, raced
from specc.training.settings import Settings
from specc.training.training import choosing_worlds
from specc.training.workers import Workers

LAST: Final = 2
"""The last race has the worlds of so many others."""
RARE: Final = 0.4
"""A rule is tried to be left out that decides in no more than this share of the worlds."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Kept:
    """What is kept of a training.

    best: the generation whose list won the last race. rules: that list without what it does as well
    without. trial: how these did in that race.
    """

    best: Generation
    rules: DecisionList
    trial: Trial

    @property
    def given_up(self) -> int:
        """How many rules."""
        return len(self.best.rules) - len(self.rules)


def last_race(course: Course, settings: Settings, workers: Workers, tell: Progress) -> Kept:
    """The best list of all generations, in few rules.

    The race is longer than those before, in worlds of its own. A list that did not beat the best of
    its time for sure runs again: it may well be better.

    Raises:
        NoRoomError, UserCodeError, SpecError: as `Workers.lived`.
    """
    every, after = course.generations, len(course.generations)
    worlds = [each for i in range(LAST) for each in choosing_worlds(after + i, settings)]
    champion = course.champion.rules
    others = [each.rules for each in every if each.rules is not champion]
    race = raced(champion if others else None, others or [champion], worlds, workers, tell)
    contenders = [race.challenger, *([] if race.holder is None else [race.holder])]
    best = max(contenders, key=lambda racer: racer.standing)
    few = _compacted(best, worlds, workers, tell)
    won = next(each for each in every if each.rules is best.rules)
    return Kept(won, few.rules, trial_of(few.episodes))


def _compacted(best: Racer, worlds: Sequence[int], workers: Workers, tell: Progress) -> Racer:
    """The list without each rule without which it succeeds as often, the rarest of them first.

    A list without a rule is tried where that rule decided alone: elsewhere it would live the same.
    """
    decides = _worlds_of_rules(best)
    now, left = best, np.ones(len(best.rules), np.bool_)
    for rule in np.argsort(decides, kind="stable"):
        if decides[rule] > RARE * len(worlds):
            break
        others = left.copy()
        others[rule] = False
        fewer = Racer(best.rules.in_order(np.flatnonzero(others)))
        heat([fewer], now, worlds, workers, tell)
        if fewer.standing[0] >= now.standing[0]:
            now, left = fewer, others
    return now


def _worlds_of_rules(racer: Racer) -> Integers:
    """In how many of its worlds each rule decides at least once, (R,)."""
    count = np.zeros(len(racer.rules) + 1, np.int64)
    for episode in racer.episodes:
        count[np.unique(racer.rules.first(episode.steps.x))] += 1
    return count[:-1]
