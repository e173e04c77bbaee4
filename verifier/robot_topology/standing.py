"""Where a number of the robot stands against that of the spec, and a feature with all of its."""

import numpy as np

from verifier.report.features import Estimate, FeatureNumber, FeatureStanding


def standing_of(
    spec: float, robot: Estimate | None, tolerance: float, turn: float
) -> FeatureStanding:
    """Of one number; `turn` is the period of an angle, else 0."""
    if robot is None:
        return FeatureStanding.NOT_VISITED
    if not np.isfinite(tolerance):
        return FeatureStanding.UNDECIDED
    off = robot.value - spec
    if turn > 0.0:
        off -= turn * np.rint(off / turn)
    low = off - (robot.value - robot.interval.low)
    high = off + (robot.interval.high - robot.value)
    if -tolerance <= low and high <= tolerance:
        return FeatureStanding.WITHIN
    if high < -tolerance or low > tolerance:
        return FeatureStanding.EXCEEDED
    return FeatureStanding.UNDECIDED


def together(numbers: tuple[FeatureNumber, ...]) -> FeatureStanding:
    """Of a feature: exceeded where one number is, within where all that have a tolerance are."""
    if all(number.robot is None for number in numbers):
        return FeatureStanding.NOT_VISITED
    judged = [number.standing for number in numbers if np.isfinite(number.tolerance)]
    if FeatureStanding.EXCEEDED in judged:
        return FeatureStanding.EXCEEDED
    if judged and all(standing is FeatureStanding.WITHIN for standing in judged):
        return FeatureStanding.WITHIN
    return FeatureStanding.UNDECIDED
