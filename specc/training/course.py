"""A training so far: what was lived, and each generation of what was learnt from it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.policies.decision_list import DecisionList
from lcs.policies.steps import Steps
from specc.training.episode import Episode
from specc.training.settings import Settings

FEW: Final = 4
"""No generation is begun with fewer than this part of the episodes that one explores by."""


@final
@dataclass(frozen=True, slots=True)
class Trial:
    """How a policy did in some worlds: means of episodes, `success` a share of them.

    decisions: of all episodes together.
    """

    reward: float
    success: float
    seconds: float
    decisions: int


@final
@dataclass(frozen=True, slots=True)
class Took:
    """Seconds of the computer: for exploring, for learning and for trying."""

    exploring: float
    learning: float
    trying: float


@final
@dataclass(frozen=True, slots=True)
class Failure:
    """The seed of a world in which a policy failed, and after how many decisions."""

    world: int
    decisions: int


@final
@dataclass(frozen=True, eq=False, slots=True)
class Generation:
    """What was learnt from so many episodes and decisions, and what is best since its race.

    explored: the last of these episodes. rules: the best of the lists that challenged the best so
    far. is_new: it won. tried: who won, in the worlds of the race. failed: where that did. raced:
    decisions of all lists in it, from which later generations learn. took: no part of what follows
    from the seed.
    """

    episodes: int
    decisions: int
    explored: Trial
    tried: Trial
    failed: tuple[Failure, ...]
    rules: DecisionList
    is_new: bool
    raced: int
    took: Took


@final
@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """A training so far: everything that it goes on from.

    lived: of each episode, those that explored in a generation before those of its race.
    """

    lived: tuple[Steps, ...] = ()
    generations: tuple[Generation, ...] = ()

    @property
    def champion(self) -> Generation:
        """The generation whose list won last."""
        return next(each for each in reversed(self.generations) if each.is_new)

    @property
    def episodes(self) -> int:
        """How many were lived."""
        return len(self.lived)

    def is_over(self, settings: Settings) -> bool:
        """Whether hardly any episodes are left, or it got no better for long enough."""
        if not self.generations:
            return False
        left = settings.episodes - self.episodes
        return left < settings.each / FEW or self.is_stale(settings)

    def is_stale(self, settings: Settings) -> bool:
        """Whether no other list won for long enough."""
        behind = len(self.generations) - 1 - self.generations.index(self.champion)
        return behind >= settings.patience


def trial_of(episodes: Sequence[Episode]) -> Trial:
    """The means."""
    return Trial(
        reward=float(np.mean([each.total for each in episodes])),
        success=float(np.mean([each.succeeded for each in episodes])),
        seconds=float(np.mean([each.seconds for each in episodes])),
        decisions=sum(len(each.steps) for each in episodes),
    )
