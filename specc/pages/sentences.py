"""The sentences of a report's page: what numbers mean and how to read its figures."""

import math

from runtime.program import Unit
from specc.figures.quantities import number, quantity, seconds
from verifier.report.report import Coverage, Interval, RegionMean, Report, VariableResult
from verifier.report.situations import where
from verifier.report.wording import digits_of, percent


def ranged(interval: Interval, unit: Unit) -> str:
    """An interval in the user's unit: `0.01 … 0.03 m`; without ends it is not known."""
    ends = (interval.low / unit.scale, interval.high / unit.scale)
    if math.isinf(ends[0]) and math.isinf(ends[1]):
        return "not known"
    digits = digits_of(*ends)
    return f"{number(ends[0], digits)} … {quantity(interval.high, unit, digits)}"


def how_to_read_the_table(report: Report) -> str:
    """What the columns of the main table mean."""
    return (
        f"All errors are measured minus predicted, {seconds(report.horizon)} after a window began."
        " The RMSE is what the log shows; the departure is the same without the measurement"
        f" noise, with its {percent(report.confidence)} confidence interval, which is what the"
        " judgement compares with the tolerance. The mean error is signed: positive where the"
        " robot ends above the prediction."
    )


def how_to_read_the_overview(report: Report) -> str:
    """The caption of the figure with all variables."""
    return (
        f"How far each variable departs from the prediction after {seconds(report.horizon)}, in"
        f" tolerances: the mark is the estimate, the bar its {percent(report.confidence)}"
        " confidence interval. A bar inside the green area (up to 1) is within the tolerance, one"
        " beyond it exceeds it, one that crosses its edge is undecided."
    )


def how_to_read_windows(variable: VariableResult) -> str:
    """The caption of the windows."""
    return (
        f"Some windows of {variable.name}, in order of time. Each prediction starts from the"
        " measured state and then runs by the spec alone, on the measured controls. The bar at"
        " the end of the prediction is the tolerance: the measured line should end inside it."
    )


def how_to_read_errors(report: Report, variable: VariableResult) -> str:
    """The caption of the errors over time."""
    return (
        f"Error of {variable.name} {seconds(report.horizon)} into each window, over the trace"
        " (left) and counted (right). The green band is the tolerance; the judgement is of all"
        " windows together, so single ones may lie outside. The orange mark is the"
        f" mean with its {percent(report.confidence)} confidence interval: away from zero, the"
        " robot errs to one side. A drift or steps along the trace mean that something changed."
    )


def how_to_read_the_map(names: tuple[str, ...]) -> str:
    """The caption of the errors over the phase space."""
    over = " and ".join(names)
    colors = (
        ""
        if len(names) == 1
        else " Blue is below the prediction, orange above it; outlined dots"
        " are beyond the tolerance."
    )
    return (
        f"The same errors over where the windows ran ({over}), in tolerances.{colors} One sign in"
        " one place and the other elsewhere means that the structure of the field differs, not"
        " its scale."
    )


def how_to_read_coverage(coverage: Coverage) -> str:
    """The caption of the coverage map."""
    if len(coverage.axes) <= 2:
        return (
            "The declared region in cells, with the effective samples in each: blue cells were"
            f" seen ({coverage.enough} or more)."
        )
    return (
        "The declared region, seen along pairs of its axes: the bluer, the larger the share of"
        f" cells behind it that was seen ({coverage.enough} or more effective samples)."
    )


def about_coverage(coverage: Coverage | None) -> tuple[str, ...]:
    """How much of the region was seen, and whether that is enough."""
    if coverage is None:
        return ("The spec declares no region that the trace must cover.",)
    enough = "enough" if coverage.is_reached else "too little"
    names = ", ".join(axis.name for axis in coverage.axes)
    if coverage.required == 0.0:
        share = percent(coverage.share)
        return (f"The judged windows went through {share} of {names}; the spec requires none.",)
    sentence = (
        f"The judged windows went through {percent(coverage.share)} of the declared region"
        f" ({names}); the spec asks for {percent(coverage.required)}: {enough} for a pass."
    )
    return (sentence,)


def about_variable(report: Report, variable: VariableResult) -> tuple[str, ...]:
    """What is known of one variable's noise and of where it errs most."""
    noise = variable.noise
    size = quantity(noise.sigma, variable.unit)
    sentences = [
        f"It is declared at {variable.origin}.",
        f"Measurement noise: {size} ({noise.method}, {noise.samples} samples).",
    ]
    if noise.quantum > 0.0:
        sentences.append(
            f"The sensor's values come in steps of {quantity(noise.quantum, variable.unit)}."
        )
    scatter = quantity(variable.scatter, variable.unit)
    sentences.append(f"Windows in the same situation scatter by {scatter} around their mean.")
    if variable.systematic > 0.0:
        size = quantity(variable.systematic, variable.unit)
        sentences.append(
            f"An error of {size} at least is systematic: it repeats whenever the robot is in the"
            " same situation."
        )
    if variable.worst is not None:
        sentences.append(about_region(report, variable, variable.worst))
    return tuple(sentences)


def about_region(report: Report, variable: VariableResult, region: RegionMean) -> str:
    """Where the mean error is largest, and how large it is there."""
    place = where(region, variable.unit, report.units) or "over all windows"
    return (
        f"The mean error is largest {place}: {quantity(region.mean, variable.unit)}"
        f" ({ranged(region.interval, variable.unit)}, {region.windows} windows,"
        f" {region.standing})."
    )
