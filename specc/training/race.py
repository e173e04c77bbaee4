"""A race of lists: all are tried in a few worlds, and the better ones of them in more."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final, final

import numpy as np

from lcs.policies.decision_list import DecisionList
from specc.training.episode import Episode, Task
from specc.training.living import Progress, live_through
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
    """A list, and its episodes so far; `is_champion` stays in the race to its end."""

    rules: DecisionList
    is_champion: bool = False
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
    """Who won, the best of the challengers, and all episodes that were lived in it."""

    winner: Racer
    challenger: Racer
    episodes: tuple[Episode, ...]


def raced(
    champion: DecisionList | None,
    challengers: Sequence[DecisionList],
    worlds: Sequence[int],
    workers: Workers,
    tell: Progress,
) -> Race:
    """Who does best in all of the worlds; of equals who comes first.

    All that go on are tried in the same worlds, so that none wins by easier ones. The champion
    stays where the best does not beat it: of many that are as good, one is lucky in any race.
    """
    racers = [Racer(rules) for rules in challengers]
    if champion is not None:
        racers.insert(0, Racer(champion, is_champion=True))
    running, done = racers, 0
    for heat, share in enumerate(SHARES):
        upto = max(round(share * len(worlds)), 1)
        if heat:
            running = list(_fastest(running, LEFT[heat - 1]))
        tasks = [Task(each, racer.rules, 0.0) for racer in running for each in worlds[done:upto]]
        what = f"trying {len(running)} lists in {upto - done} worlds:"
        episodes = iter(live_through(workers, tasks, what, tell))
        for racer in running:
            racer.episodes += [next(episodes) for _ in range(upto - done)]
        done = upto
    every = tuple(each for racer in racers for each in racer.episodes)
    challenging = [racer for racer in running if not racer.is_champion]
    best = max(challenging, key=lambda racer: racer.standing)
    is_beaten = champion is None or best.beats(racers[0])
    return Race(best if is_beaten else racers[0], best, every)


def _fastest(running: Sequence[Racer], left: int) -> Iterator[Racer]:
    """The champion, and as many of the others, in the order in which they stand."""
    others = [racer for racer in running if not racer.is_champion]
    first = sorted(others, key=lambda racer: racer.standing, reverse=True)[:left]
    return (racer for racer in running if racer.is_champion or racer in first)
