"""The best list made plainer: few rules, of few conditions, with bounds of few digits.

Of lists that are ever plainer the plainest is taken that does not fall behind the best of them by
more than its standard error (Breiman, Friedman, Olshen and Stone 1984, section 3.4.3). How a list
does is known from trials alone; by its own worth it may well be better than the one it was made of.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Integers
from lcs.policies.decision_list import DecisionList
from lcs.policies.learner import Found
from lcs.policies.shortened import shortened
from lcs.policies.simplifying import simplified
from lcs.policies.weighed import weighed
from specc.training.course import Trial, trial_of
from specc.training.last_race import LastRace
from specc.training.living import Progress
from specc.training.race import Racer, heat
from specc.training.workers import Workers

SAVES: Final = (0.0005, 0.001, 0.002, 0.004)
"""What a rule has to save, in the plain list and in ever plainer ones: a share of what is lost
where none decides."""
OF_A_DIGIT: Final = 0.2
"""And one more digit of a bound: a share of that."""
RARE: Final = 0.4
"""A rule is tried to be left out that decides in no more than this share of the worlds."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Compacted:
    """A list, how it did in the last race, and how it did there before it was made plainer."""

    rules: DecisionList
    trial: Trial
    before: Trial


def compacted(race: LastRace, found: Found, workers: Workers, tell: Progress) -> Compacted:
    """The winner of the last race made plainer, by trials in the same worlds.

    Args:
        race: the last race.
        found: what is known of worth; its last places are those of the winner, as in `own_steps`.
        workers: live the trials.
        tell: is told how far they are.

    Raises:
        NoRoomError, UserCodeError, SpecError: as `Workers.lived`.
    """
    runners = [race.winner]
    for rules in _plainer(race.winner, found):
        runners.append(Racer(rules))
        heat(runners[-1:], race.winner, race.worlds, workers, tell)
    few = _without_rare(plainest(runners), race.worlds, workers, tell)
    return Compacted(few.rules, trial_of(few.episodes), trial_of(race.winner.episodes))


def plainest(runners: Sequence[Racer]) -> Racer:
    """The last, each plainer than those before, within a standard error of who succeeds most."""
    success = np.array([each.standing[0] for each in runners])
    most = float(success.max())
    error = np.sqrt(most * (1.0 - most) / len(runners[0].episodes))
    return runners[int(np.flatnonzero(success >= most - error)[-1])]


def _plainer(winner: Racer, found: Found) -> Iterator[DecisionList]:
    """Ever plainer lists, by what is lost at the places of the winner itself."""
    count = sum(len(each.steps) for each in winner.episodes)
    x, cost = found.x[-count:], np.ascontiguousarray(found.cost[-count:].T)
    now = weighed(winner.rules, x, cost)
    for share in SAVES:
        least = share * float(now.lost[-1].sum())
        yield shortened(simplified(now, least, of_a_digit=OF_A_DIGIT), x)


def _without_rare(best: Racer, worlds: Sequence[int], workers: Workers, tell: Progress) -> Racer:
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
