"""Why the verdict is what it is, and what to do next: sentences for a tired engineer."""

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Unit
from verifier.fidelity.shooting.study import Study
from verifier.report.report import Coverage, Interval, RegionMean, Standing, VariableResult
from verifier.report.wording import listed, number, percent, quantity, seconds, span

EXPLAINS = 0.5
"""A proportional error is worth a sentence where it explains this share of the squared error."""
HOPELESS = 100.0
"""Where so many times the data were needed, more data is no advice."""


def exceeded(result: VariableResult) -> str:
    """The variable, by how much, against what."""
    figure, unit = result.declared, result.unit
    if figure.standing is Standing.EXCEEDED:
        return (
            f"{result.name} departs by {quantity(figure.departure, unit)} after"
            f" {number(figure.horizon)} s (95 % interval {_interval(figure.interval, unit)});"
            f" {quantity(result.tolerance, unit)} is allowed"
        )
    return (
        f"{result.name} departs by {quantity(figure.departure, unit)} after"
        f" {number(figure.horizon)} s over all, but in a part of the region by more than the"
        f" {quantity(result.tolerance, unit)} that is allowed"
    )


def worst(result: VariableResult, units: dict[str, Unit]) -> list[str]:
    """Where it is worst and in which direction; nothing where no part stands out."""
    region = result.worst
    if region is None or region.interval.low <= 0.0 <= region.interval.high:
        return []
    side = "above" if region.mean > 0.0 else "below"
    ends = sorted([abs(region.interval.low), abs(region.interval.high)])
    return [
        (
            f"{result.name} is worst for {where(region, units)}: there the robot ends"
            f" {quantity(abs(region.mean), result.unit)} {side} the prediction on average (95 %"
            f" interval {span(ends[0], ends[1], result.unit)}, {region.windows} windows)"
        )
    ]


def proportion(study: Study, result: VariableResult) -> list[str]:
    """Whether the robot simply moves more, or less, than predicted."""
    error, moved = _declared(study, result)
    if not np.any(moved) or not np.any(error):
        return []
    slope = float(np.sum(error * moved) / np.sum(moved**2))
    explained = 1.0 - float(np.sum((error - slope * moved) ** 2) / np.sum(error**2))
    if explained < EXPLAINS:
        return []
    return [
        (
            f"{result.name} moves {number(1.0 + slope)} times as far as predicted, which explains"
            f" {percent(explained)} of its squared error"
        )
    ]


def within(result: VariableResult) -> str:
    """What a PASS claims."""
    figure, unit = result.declared, result.unit
    return (
        f"{result.name} stays within {quantity(result.tolerance, unit)} over"
        f" {number(figure.horizon)} s: it departs by {quantity(figure.departure, unit)}, at most"
        f" {quantity(figure.interval.high, unit)} (95 %)"
    )


def unmoved(study: Study, result: VariableResult) -> list[str]:
    """Whether a spec in which nothing moves would have passed as well."""
    error, moved = _declared(study, result)
    way = float(np.sqrt(np.mean((error + moved) ** 2)))
    if way > result.tolerance:
        return []
    return [
        (
            f"{result.name} itself moves by {quantity(way, result.unit)} in"
            f" {number(result.declared.horizon)} s here: a spec in which it stays where it is would"
            " pass as well"
        )
    ]


def undecided(result: VariableResult) -> str:
    """Why a variable cannot be judged from this trace."""
    figure, unit = result.declared, result.unit
    if figure.windows == 0:
        return f"{result.name} has no sample at the end of any window"
    return (
        f"{result.name} may or may not stay within {quantity(result.tolerance, unit)} over"
        f" {number(figure.horizon)} s: it departs by {quantity(figure.departure, unit)}, and the"
        f" 95 % interval is {_interval(figure.interval, unit)} ({figure.windows} overlapping"
        " windows)"
    )


def more_data(result: VariableResult, judged: float) -> str:
    """How much data of this kind would decide about a variable."""
    figure = result.declared
    if not np.isfinite(figure.interval.high):
        return (
            f"record longer: {seconds(6.0 * figure.horizon)} of judged driving (six horizons) is"
            " the least that gives an interval"
        )
    is_above = figure.departure > figure.tolerance
    edge = figure.interval.low if is_above else figure.interval.high
    factor = ((edge - figure.departure) / (figure.tolerance - figure.departure or 1e-300)) ** 2
    if factor > HOPELESS:
        return (
            f"{result.name} departs by just about its tolerance: more data of this kind will"
            " hardly decide; reconsider the tolerance or the spec"
        )
    return (
        f"about {seconds(factor * judged)} of judged driving like this (now {seconds(judged)})"
        f" would decide about {result.name}, if its departure stays what it is"
    )


def scope(coverage: Coverage) -> str:
    """How far a PASS reaches where no region was declared."""
    names = listed([axis.name for axis in coverage.axes])
    return (
        f"the spec declares no region, so this holds where the robot was: in"
        f" {percent(coverage.share)} of the domain of {names}"
    )


def uncovered(coverage: Coverage) -> str:
    """That too little of the region was seen."""
    names = listed([axis.name for axis in coverage.axes])
    return (
        f"only {percent(coverage.share)} of the region of {names} was seen,"
        f" {percent(coverage.required)} is required"
    )


def unseen(coverage: Coverage) -> list[str]:
    """Which values to drive through, axis by axis."""
    seen = coverage.samples >= coverage.enough
    advice = []
    for position, axis in enumerate(coverage.axes):
        others = tuple(i for i in range(seen.ndim) if i != position)
        empty = np.asarray(~np.any(seen, axis=others))
        edges = np.linspace(axis.low, axis.high, axis.count + 1)
        ranges = [span(edges[a], edges[b], axis.unit) for a, b in _runs(empty)]
        if ranges:
            advice.append(f"drive with {axis.name} from {listed(ranges)}: not seen at all")
    if advice:
        return advice
    return ["drive through more combinations: every axis was covered, but not jointly"]


def where(region: RegionMean, units: dict[str, Unit]) -> str:
    """A region in words: `x from 0 to 1 m, v from -1 to 0 m/s`."""
    return ", ".join(
        f"{name} from {span(low, high, units[name])}" for name, (low, high) in region.bounds.items()
    )


def _declared(study: Study, result: VariableResult) -> tuple[Array, Array]:
    """Errors at the declared horizon, and predicted ways to there, of the counted windows."""
    j = [each.state.name for each in study.plan.samples].index(result.name)
    errors = study.shots.errors[-1][j]
    kept = np.isfinite(errors.mean) & ~study.shots.is_lost
    return errors.mean[kept], errors.moved[kept]


def _interval(interval: Interval, unit: Unit) -> str:
    return span(interval.low, interval.high, unit)


def _runs(flags: Booleans) -> list[tuple[int, int]]:
    """Start and end (exclusive) of each run of true flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int64), [0]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
