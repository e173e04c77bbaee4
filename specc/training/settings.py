"""How an arbiter is trained: every number that a result depends on."""

from dataclasses import dataclass
from typing import Final, final

LEARNERS: Final = ("alcsr", "xcsr")
HELD_OUT: Final = 100
"""Worlds in which the best policy is judged in the end."""


@final
@dataclass(frozen=True, slots=True)
class Settings:
    """How `specc train` goes about it.

    learner: `alcsr` or `xcsr`. episodes: to live; a generation that has begun by then is finished.
    first: of these at random, before anything is known. each: to explore in each later generation.
    explore: the share of decisions at which a try begins, once there is a policy. mended,
    varied: lists like the best that race with it and with what is learnt; with rules more where it
    loses most, and changed at random. tried_in: worlds of a race. patience:
    it stops early after so many races that the same list won. rules: at most. again: at most this
    share of those that explore goes back to where the best failed. seed: of all chance.

    Raises:
        ValueError: one of them is of no use.
    """

    learner: str = "alcsr"
    episodes: int = 4_500
    first: int = 1_000
    each: int = 80
    explore: float = 0.06
    mended: int = 16
    varied: int = 8
    tried_in: int = 96
    patience: int = 8
    rules: int = 20
    again: float = 0.25
    seed: int = 0

    def __post_init__(self) -> None:
        """Refuse what nothing can be trained with."""
        known = self.learner in LEARNERS
        whole = all(type(each) is int for each in (*self._counts, *self._none_too))
        shares = all(type(each) is float and 0.0 <= each <= 1.0 for each in self._shares)
        if not (known and whole and shares):
            raise ValueError("a setting is of another kind")
        if min(self._counts) < 1 or min(self._none_too) < 0:
            raise ValueError("a setting is too small")

    @property
    def _counts(self) -> tuple[int, ...]:
        explored = self.episodes, self.first, self.each
        return (*explored, self.tried_in, self.patience, self.rules)

    @property
    def _none_too(self) -> tuple[int, ...]:
        return self.mended, self.varied, self.seed

    @property
    def _shares(self) -> tuple[float, ...]:
        return self.explore, self.again
