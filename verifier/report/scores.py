"""Scores of similarity that others print, for comparison with the verdict; nothing rests on them.

They compare what was measured with what the spec predicts, over windows of one horizon laid end
to end. All are 1 at best but the NRMSE, which is 0 at best.
"""

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True)
class IsoRating:
    """The rating of ISO/TS 18571:2024 and its four parts, each from 0 (poor) to 1 (excellent)."""

    overall: float
    corridor: float
    phase: float
    magnitude: float
    slope: float


@final
@dataclass(frozen=True, slots=True)
class VariableScores:
    """The scores of one variable over `samples` samples.

    nrmse: the root mean square error over the range of the measured values.
    r_squared: the coefficient of determination, at most 1, negative where the mean predicts
    better. Both are NaN, and `iso` None, where what was measured never moved.
    """

    name: str
    samples: int
    iso: IsoRating | None
    nrmse: float
    r_squared: float


@final
@dataclass(frozen=True, slots=True)
class Scores:
    """The scores of all judged variables, and what they are worth, in sentences."""

    variables: tuple[VariableScores, ...]
    sentences: tuple[str, ...]
