"""Choices that were held: what each brought while it was, as one longer step.

One decision of many changes little, and what follows it is as uncertain as ever. A choice that is
held for some time shows what it is worth: advantages grow with the time, the noise hardly does. A
policy that may change its choice at each decision does no worse than one that has to hold it.
"""

from dataclasses import dataclass
from typing import final

import numpy as np

from lcs.arrays import Array, Booleans
from lcs.policies.steps import Steps


@final
@dataclass(frozen=True, eq=False, slots=True)
class Held:
    """For each of D decisions, what its choice brought from then on as long as it was held.

    reward (D,): discounted. after (D, n), ends (D,): where that led. discount (D,): what a reward
    there is worth.
    """

    reward: Array
    after: Array
    ends: Booleans
    discount: Array


def held(lived: Steps, discount: float, longest: int) -> Held:
    """Look from each decision as far ahead as its choice was held, `longest` decisions at most."""
    last = np.arange(len(lived))
    reward, worth = lived.reward.copy(), np.full(len(lived), discount)
    goes_on = _goes_on(lived)
    for _ in range(longest - 1):
        those = np.flatnonzero(goes_on[last])
        last[those] += 1
        reward[those] += worth[those] * lived.reward[last[those]]
        worth[those] *= discount
    return Held(reward, lived.after[last], lived.ends[last], worth)


def _goes_on(lived: Steps) -> Booleans:
    """Whether the next decision is of the same episode, and chooses the same (D,)."""
    same = np.zeros(len(lived), np.bool_)
    same[:-1] = ~lived.last[:-1] & (lived.action[1:] == lived.action[:-1])
    return same
