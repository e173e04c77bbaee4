"""How probable each class is, by the rules, where one class of them is right."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans
from lcs.rules.kernels import assessing
from lcs.rules.table import RuleTable

TINY: Final = 1e-12
HUGE: Final = 1e150
"""Weights are kept between both, so that no sum of them is 0 or infinite."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Belief:
    """Of T inputs: how probable each class is (T, A), and whether rules hold for it (T, A)."""

    probability: Array
    is_covered: Booleans


def believe(table: RuleTable, inputs: Array, right_above: float = 0.0) -> Belief:
    """What a table says of inputs (T, n); conditions on NaN hold.

    A rule that expects a reward above `right_above` is for its class, others are against it. The
    rule was right in so many of its feedings; with one before that it was born of, and with
    Laplace's two, one right and one wrong: that is how much it believes. A class is believed as the
    rules that hold for it do on average, by their weight. Classes that no rule holds for share what
    the others leave, by how near a rule for them is. The sum is 1.
    """
    share = (table.right + 2.0) / (table.right + table.wrong + 3.0)
    is_for = table.prediction > right_above
    width = table.high - table.low
    belief, far = (np.zeros((len(inputs), table.actions)) for _ in range(2))
    assessing.assess(
        table.lower,
        table.upper,
        table.high,
        np.where(width > 0.0, width, 1.0),
        table.action,
        np.clip(table.weight, TINY, HUGE),
        np.where(is_for, share, 1.0 - share),
        is_for,
        inputs,
        belief,
        far,
    )
    is_covered = ~np.isnan(belief)
    return Belief(_completed(np.where(is_covered, belief, 0.0), is_covered, far), is_covered)


def _completed(belief: Array, is_covered: Booleans, far: Array) -> Array:
    """Beliefs (T, A) that sum to 1."""
    near = np.where(is_covered, 0.0, 1.0 / (far + TINY))
    nobody = ~is_covered & (near.sum(axis=1, keepdims=True) == 0.0)
    near[nobody] = 1.0
    left = np.maximum(1.0 - belief.sum(axis=1, keepdims=True), 0.0)
    whole = belief + left * near / np.maximum(near.sum(axis=1, keepdims=True), TINY)
    found: Array = whole / whole.sum(axis=1, keepdims=True)
    return found
