"""Which worlds episodes are lived in: seeds that set learning, choosing and judging apart."""

from enum import IntEnum
from typing import Final, final

import numpy as np

OWN: Final = 2**32
"""Seeds below are left to people: no world of an episode has one of them."""


@final
class For(IntEnum):
    """What a world is for."""

    LEARNING = 1
    CHOOSING = 2
    JUDGING = 3


def world(purpose: For, number: int, seed: int = 0) -> int:
    """The seed of a world; those for choosing and for judging are the same for all trainings."""
    drawn = np.random.SeedSequence([int(purpose), seed, number]).generate_state(1, np.uint32)
    return OWN * int(purpose) + int(drawn[0])
