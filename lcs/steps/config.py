"""The constants of learning over several steps."""

from dataclasses import dataclass
from typing import Final, final

from lcs.faults import LearnerError


@final
@dataclass(frozen=True, slots=True)
class Config:
    """Every constant, with defaults that suit all problems tried.

    explore: the share of steps that try an action at random; those are remembered. discount: what
    a reward is worth one step later. memories: how many the land holds; of more, a fair sample.
    fed: so many memories of each action a body needs to live. families: how many times the land is
    divided, each time at other places by chance; their bodies vote together. first: bodies grow
    after so many tries, and anew whenever there were twice as many. generations: how often they
    grow at such a time, from what the generation before expected. longest: an episode is given up
    after so many steps.
    """

    explore: float = 0.5
    discount: float = 0.99
    memories: int = 20_000
    fed: int = 5
    families: int = 5
    first: int = 5_000
    generations: int = 4
    longest: int = 200


SHARES: Final = ("explore", "discount")
COUNTS: Final = ("memories", "fed", "families", "first", "generations", "longest")


def refuse_unfit(config: Config) -> None:
    """Refuse constants that mean nothing.

    Raises:
        LearnerError: a share is not from 0 to 1, or a count is below 1.
    """
    for name in SHARES:
        if not 0.0 <= getattr(config, name) <= 1.0:
            raise LearnerError(f"{name} is from 0 to 1; got {getattr(config, name):g}")
    for name in COUNTS:
        if getattr(config, name) < 1:
            raise LearnerError(f"{name} is 1 or more; got {getattr(config, name):g}")
