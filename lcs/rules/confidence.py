"""How sure one may be of a rule that was right so many times of so many."""

import math
from dataclasses import dataclass
from typing import Final, final

Z: Final = 1.959963984540054
"""Of a normal distribution, 95 % lie so near to its mean."""


@final
@dataclass(frozen=True, slots=True)
class Confidence:
    """In a prediction that was right in `right` of `cases`.

    laplace: (right + 1) / (cases + 2), the chance that it is right the next time if every share was
    as likely before. low, high: Wilson's interval, that holds the true share in 95 % of such cases.
    """

    right: int
    cases: int
    laplace: float
    low: float
    high: float


def confidence(right: int, wrong: int) -> Confidence:
    """The confidence after so many right and wrong predictions (Wilson 1927; Agresti 1998)."""
    cases = right + wrong
    laplace = (right + 1) / (cases + 2)
    if cases == 0:
        return Confidence(0, 0, laplace, 0.0, 1.0)
    share, weight = right / cases, Z * Z / cases
    middle = (share + weight / 2.0) / (1.0 + weight)
    half = Z / (1.0 + weight) * math.sqrt(share * (1.0 - share) / cases + weight / (4.0 * cases))
    low = 0.0 if right == 0 else middle - half
    high = 1.0 if wrong == 0 else middle + half
    return Confidence(right, cases, laplace, low, high)
