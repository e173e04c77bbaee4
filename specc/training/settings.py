"""How an arbiter is trained: every number that a result depends on."""

from dataclasses import dataclass
from typing import Final, final

HELD_OUT: Final = 100
"""Worlds in which the best policy is judged in the end."""


@final
@dataclass(frozen=True, slots=True)
class Settings:
    """How `specc train` goes about it.

    learner: `alcsr` or `xcsr`. episodes: for learning, at most. each: after so many the policy is
    learnt anew and tried. explore: the share of decisions at which a try begins, once there is a
    policy. tried_in: worlds in which each policy is tried, the same for all; the best is kept.
    patience: it stops early after so many policies that were no better. rules: at most.
    again: at most this share of the next episodes explores worlds that the last policy failed in.
    seed: of all chance.
    """

    learner: str = "alcsr"
    episodes: int = 400
    each: int = 40
    explore: float = 0.1
    tried_in: int = 40
    patience: int = 4
    rules: int = 12
    again: float = 0.25
    seed: int = 0
