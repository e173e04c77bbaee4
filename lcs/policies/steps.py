"""What was lived through: decisions, what each was rewarded with, and where it led."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import final

import numpy as np

from lcs.arrays import Array, Booleans, Integers


@final
@dataclass(frozen=True, eq=False, slots=True)
class Steps:
    """D decisions of one episode or of several, one after the other.

    x, after (D, n): where it was decided, and where that led. action (D,). reward (D,).
    last (D,): whether it was the last of its episode. ends (D,): whether it ended it, so that
    nothing comes after; an episode whose time is up might have gone on.
    """

    x: Array
    action: Integers
    reward: Array
    after: Array
    last: Booleans
    ends: Booleans

    def __len__(self) -> int:
        """How many decisions."""
        return len(self.action)


def joined(parts: Sequence[Steps]) -> Steps:
    """The steps of several episodes, one after the other."""
    return Steps(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Steps)))
