"""The last race: the best of all generations, in more worlds than any before."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

from runtime.progress import Progress
from specc.training.course import Course, Generation
from specc.training.race import Racer, heat, raced
from specc.training.remembered import Remembered
from specc.training.settings import Settings
from specc.training.training import choosing_worlds
from specc.training.workers import Workers

LAST: Final = 2
"""The last race has the worlds of so many others."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class LastRace:
    """Whose list won the last race, what it lived there, and in which worlds."""

    best: Generation
    winner: Racer
    worlds: Sequence[int]


def last_race(
    course: Course,
    settings: Settings,
    workers: Workers,
    tell: Progress,
    remembered: Remembered,
) -> LastRace:
    """The best list of all generations; one that is remembered lives its own part once more.

    The race is longer than those before, in worlds of its own. A list that did not beat the best of
    its time for sure runs again: it may well be better.

    Raises:
        NoRoomError, UserCodeError, SpecError: as `Workers.lived`.
    """
    every, after = course.generations, len(course.generations)
    worlds = [each for i in range(LAST) for each in choosing_worlds(after + i, settings)]
    if remembered.winner is not None:
        best = every[remembered.winner]
        winner = Racer(best.rules)
        heat([winner], None, worlds, workers, tell)
        return LastRace(best, winner, worlds)
    champion = course.champion.rules
    others = [each.rules for each in every if each.rules is not champion]
    race = raced(champion if others else None, others or [champion], worlds, workers, tell)
    contenders = [race.challenger, *([] if race.holder is None else [race.holder])]
    winner = max(contenders, key=lambda racer: racer.standing)
    place = next(i for i, each in enumerate(every) if each.rules is winner.rules)
    remembered.won(place)
    return LastRace(every[place], winner, worlds)
