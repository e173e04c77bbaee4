"""Estimates with Student's and normal intervals."""

from scipy import special

from verifier.report.features import Estimate
from verifier.report.report import Interval


def student(value: float, error: float, count: int, confidence: float) -> Estimate:
    """A mean of `count` independent values with standard error `error`."""
    quantile = float(special.stdtrit(max(count - 1, 1), 0.5 + confidence / 2.0))
    return Estimate(value, Interval(value - quantile * error, value + quantile * error))


def normal(value: float, error: float, confidence: float) -> Estimate:
    """A value with a known standard error."""
    half = float(special.ndtri(0.5 + confidence / 2.0)) * error
    return Estimate(value, Interval(value - half, value + half))
