"""A race of lists: all are tried in a few worlds, and the better ones of them in more."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, final

import numpy as np

from lcs.policies.decision_list import DecisionList
from runtime.progress import Progress
from specc.training.episode import Episode, Task
from specc.training.living import live_through
from specc.training.workers import Workers

SHARES: Final = (0.125, 0.375, 1.0)
"""Of the worlds, those that lists have been tried in after each heat."""
SURE: Final = 1.3
"""Standard errors by which who is better has to be, to be so for sure: nine times of ten."""
LEFT: Final = (6, 2)
"""Challengers that go on to the next heat."""


@final
@dataclass(eq=False, slots=True)
class Racer:
    """A list, and its episodes so far, a world after the other."""

    rules: DecisionList
    episodes: list[Episode] = field(default_factory=list)

    def beats(self, other: "Racer") -> bool:
        """Whether it surely did better in the same worlds: by more than chance would, mostly.

        By how often it succeeded; where both did in the same worlds, by reward.
        """
        success = np.array([each.succeeded for each in self.episodes], np.float64)
        more = success - [each.succeeded for each in other.episodes]
        if not more.any():
            more = np.array([each.total for each in self.episodes])
            more -= [each.total for each in other.episodes]
        return bool(more.mean() > SURE * more.std() / np.sqrt(len(more)))

    @property
    def standing(self) -> tuple[float, float]:
        """The share of worlds where all that is required was satisfied, then the mean reward."""
        success = float(np.mean([each.succeeded for each in self.episodes]))
        return success, float(np.mean([each.total for each in self.episodes]))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Race:
    """How a race went: the best of the challengers, and who held the title, if anybody did.

    is_won: by the challenger. episodes: all that were lived in it, each once.
    """

    challenger: Racer
    holder: Racer | None
    episodes: tuple[Episode, ...]

    @property
    def is_won(self) -> bool:
        """Whether the challenger surely beat the one that held the title."""
        return self.holder is None or self.challenger.beats(self.holder)

    @property
    def winner(self) -> Racer:
        """Who holds the title now."""
        return self.challenger if self.holder is None or self.is_won else self.holder


def raced(
    champion: DecisionList | None,
    challengers: Sequence[DecisionList],
    worlds: Sequence[int],
    workers: Workers,
    tell: Progress,
) -> Race:
    """Who does best in all of the worlds; of equals who comes first.

    All that go on are tried in the same worlds, so that none wins by easier ones. The champion
    keeps its title where the best does not beat it: of many that are as good, one is lucky in any
    race. A challenger that decides as the champion did all along an episode would live the same,
    to the bit, and is given that one.

    Raises:
        NoRoomError, UserCodeError, SpecError: as `Workers.lived`.
    """
    holder = None if champion is None else Racer(champion)
    running = [Racer(rules) for rules in challengers]
    lived: list[Episode] = []
    done = 0
    for number, upto in enumerate(heats(len(worlds))):
        if number:
            running = _fastest(running, LEFT[number - 1])
        if holder is not None:
            lived += heat([holder], None, worlds[done:upto], workers, tell)
        lived += heat(running, holder, worlds[done:upto], workers, tell)
        done = upto
    best = max(running, key=lambda racer: racer.standing)
    return Race(best, holder, tuple(lived))


def heats(worlds: int) -> list[int]:
    """In how many of so many worlds lists have been tried after each heat."""
    return [max(round(share * worlds), 1) for share in SHARES]


def heat(
    racers: Sequence[Racer],
    holder: Racer | None,
    worlds: Sequence[int],
    workers: Workers,
    tell: Progress,
) -> list[Episode]:
    """Let each of them have its episodes in some worlds more; those that had to be lived."""
    done = len(racers[0].episodes)
    known = [] if holder is None else holder.episodes[done : done + len(worlds)]
    shared = [_shared(racer, holder, known, len(worlds)) for racer in racers]
    tasks = [
        Task(world, racer.rules, 0.0)
        for racer, own in zip(racers, shared, strict=True)
        for world, is_shared in zip(worlds, own, strict=True)
        if not is_shared
    ]
    what = f"trying lists ({len(racers)}) in worlds ({len(worlds)}):"
    lived = live_through(workers, tasks, what, tell)
    new = iter(lived)
    for racer, own in zip(racers, shared, strict=True):
        racer.episodes += [known[i] if same else next(new) for i, same in enumerate(own)]
    return lived


def _shared(racer: Racer, holder: Racer | None, known: Sequence[Episode], count: int) -> list[bool]:
    """In which of so many worlds it would live what is known of the one that holds the title."""
    if holder is None:
        return [False] * count
    return would_live(racer.rules, known, holder.rules)


def would_live(rules: DecisionList, episodes: Sequence[Episode], by: DecisionList) -> list[bool]:
    """Which episodes that one list lived another would live, too: it decides alike all along."""
    if not episodes:
        return []
    each = [episode.places for episode in episodes]
    places, starts = np.concatenate(each), np.cumsum([0, *map(len, each[:-1])])
    alike: list[bool] = np.logical_and.reduceat(
        rules.decide(places) == by.decide(places), starts
    ).tolist()
    return alike


def _fastest(running: Sequence[Racer], left: int) -> list[Racer]:
    """As many of them, in the order in which they stand."""
    return sorted(running, key=lambda racer: racer.standing, reverse=True)[:left]
