"""Sentences on features, for an engineer who has not read about any of this."""

import math

from runtime.program import Unit
from verifier.report.features import (
    ComparedFeature,
    Estimate,
    FeatureNumber,
    FeatureStanding,
)
from verifier.report.wording import listed, quantity, shown, suffix

DIGITS = 2
"""Significant digits of a half interval."""


def estimate_words(estimate: Estimate, unit: Unit) -> str:
    """A value with half its interval: `6.74 ± 0.003 s`, digits as the interval has them."""
    half = 0.5 * (estimate.interval.high - estimate.interval.low) / unit.scale
    value = estimate.value / unit.scale
    if not math.isfinite(half):
        return f"about {shown(estimate.value, unit)}{suffix(unit)}"
    if half <= 0.0:
        return quantity(estimate.value, unit)
    decimals = max(0, min(9, DIGITS - 1 - math.floor(math.log10(half))))
    return f"{value:.{decimals}f} ± {half:.{decimals}f}{suffix(unit)}"


def sentence_on(feature: ComparedFeature, manner: str, *, with_numbers: bool = True) -> str:
    """The sentence on a feature of the spec.

    manner: how the robot's was found, as a clause that its numbers end: `the robot rests at`; a
    whole clause where there are none, or they are left out.
    """
    head = f"{feature.name[:1].upper()}{feature.name[1:]}"
    if feature.is_declared:
        head += ", expected by the spec"
    told = [number for number in feature.numbers if number.robot is not None]
    if not told or not with_numbers:
        return f"{head}: {manner}."
    robot = listed([_robot_words(number) for number in told])
    return f"{head}: {manner} {robot}; {_judgement(feature)}."


def _robot_words(number: FeatureNumber) -> str:
    assert number.robot is not None, "only what was found is told"
    link = " of " if number.name == "period" or " " in number.name else " = "
    return f"{number.name}{link}{estimate_words(number.robot, number.unit)}"


def _judgement(feature: ComparedFeature) -> str:
    worst = [n for n in feature.numbers if n.standing is FeatureStanding.EXCEEDED]
    if worst:
        return listed([_excess(number) for number in worst])
    if feature.standing is FeatureStanding.EXCEEDED:
        return f"the spec's is a {feature.kind}"
    open_ = [n for n in feature.numbers if n.standing is FeatureStanding.UNDECIDED]
    if not open_ and feature.standing is FeatureStanding.WITHIN:
        return f"that is within what is allowed by {_allowed_by(feature.numbers)}"
    unlimited = [n for n in open_ if not math.isfinite(n.tolerance)]
    if unlimited:
        names = listed([n.name for n in unlimited])
        return f"no tolerance says how far {names} may be off"
    return f"not clear for {listed([_doubt(n) for n in open_])}; a longer trace would tell"


def _excess(number: FeatureNumber) -> str:
    assert number.robot is not None, "nothing unknown is exceeded"
    off = number.robot.value - number.spec
    above, below = (
        ("longer than", "shorter than") if number.name == "period" else ("above", "below")
    )
    allowed = quantity(number.tolerance, number.unit)
    return (
        f"its {number.name} is {quantity(abs(off), number.unit)} {above if off > 0.0 else below}"
        f" the spec's {quantity(number.spec, number.unit)},"
        f" where {number.allowed_by} allows {allowed}"
    )


def _doubt(number: FeatureNumber) -> str:
    assert number.robot is not None, "of nothing unknown it is asked how far off it is"
    off = quantity(abs(number.robot.value - number.spec), number.unit)
    return (
        f"{number.name} ({off} off the spec's {quantity(number.spec, number.unit)},"
        f" {quantity(number.tolerance, number.unit)} allowed)"
    )


def _allowed_by(numbers: tuple[FeatureNumber, ...]) -> str:
    """`the tolerance`, or `the claim and the tolerance`."""
    return listed(sorted({n.allowed_by for n in numbers if math.isfinite(n.tolerance)}))
