"""Why the verdict is what it is, and what to do next: sentences for a tired engineer."""

from collections.abc import Sequence

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Unit
from verifier.fidelity.judging.evidence import Evidence
from verifier.flags import runs_of
from verifier.report.report import (
    CellAxis,
    Coverage,
    Interval,
    Standing,
    VariableResult,
)
from verifier.report.situations import where
from verifier.report.wording import listed, number, percent, quantity, seconds, span

EXPLAINS = 0.5
"""A proportional error is worth a sentence where it explains this share of the squared error."""
LOUD = 0.5
"""Noise below this share of the tolerance leaves room for a verdict."""
GROWN = 3.0
"""Noise that grows so many times over the horizon is worth a word about the field."""
HOPELESS = 100.0
"""Where so many times the data were needed, more data is no advice."""
LEAST_MORE = 1.5
"""Data that left a verdict open are asked for so many times over, at least: estimates are rough."""


def what_is_systematic() -> str:
    """The word that every sentence on a FAIL uses, explained once."""
    return (
        "systematic is what repeats whenever the robot is in the same situation: neither the noise"
        " of the sensors nor chance explains it"
    )


def proportion(evidence: Evidence, result: VariableResult) -> list[str]:
    """Whether the robot simply moves more, or less, than predicted."""
    error, moved = _declared(evidence, result)
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
        f" {quantity(figure.interval.high, unit)} (95 %){_beside(result)}"
    )


def _beside(result: VariableResult) -> str:
    if result.allowed_scatter <= 0.0:
        return ""
    allowed = quantity(result.allowed_scatter, result.unit)
    return f", beside the scatter of {allowed} that the spec allows"


def unmoved(result: VariableResult) -> list[str]:
    """Whether a spec in which nothing moves would have passed as well."""
    if not result.hardly_moves:
        return []
    return [
        (
            f"{result.name} itself moves by {quantity(result.moved, result.unit)} in"
            f" {number(result.declared.horizon)} s here: a spec in which it stays where it is would"
            " pass as well"
        )
    ]


def undecided(result: VariableResult, units: dict[str, Unit]) -> str:
    """Why a variable cannot be judged from this trace."""
    figure, unit = result.declared, result.unit
    if figure.windows == 0:
        return f"{result.name} has no sample at the end of any window"
    limit = _allowed(result)
    departs = (
        f"{result.name} may or may not stay within {quantity(result.tolerance, unit)} over"
        f" {number(figure.horizon)} s{_beside(result)}: it departs by"
        f" {quantity(figure.departure, unit)}"
    )
    if not np.isfinite(figure.interval.high):
        return f"{departs}, and {_windows(figure.windows)} are too few to tell how surely"
    if figure.interval.low > limit:
        return (
            f"{departs}, but not alike in the same situation: windows scatter by"
            f" {quantity(result.scatter, unit)}, and only {quantity(result.systematic, unit)} is"
            " shown to repeat; the robot is restless, or something moves it that the spec does"
            " not know"
        )
    if figure.interval.high > limit:
        return (
            f"{departs}, and the 95 % interval is {_interval(figure.interval, unit)}"
            f" ({_windows(figure.windows)})"
        )
    open_ones = [r for r in result.regions if r.standing is not Standing.WITHIN]
    region = max(open_ones, key=lambda r: max(abs(r.interval.low), abs(r.interval.high)))
    place = where(region, result.unit, units)
    return (
        f"{departs} over all, but {f'{place} ' if place else ''}on average by"
        f" {quantity(region.mean, unit)} (95 % interval {_interval(region.interval, unit)},"
        f" {region.windows} windows)"
    )


def too_noisy(result: VariableResult) -> list[str]:
    """That the noise of the sensors alone fills the tolerance, and what would help."""
    figure, unit = result.declared, result.unit
    allowed = _allowed(result)
    if figure.noise <= allowed:
        return []
    quiet = [f.horizon for f in result.horizons if f.noise <= LOUD * allowed]
    early = result.horizons[0]
    grown = figure.noise / max(early.noise, 1e-300)
    growth = (
        f", and the field carries apart what starts together: {number(grown)} times as much as"
        f" after {number(early.horizon)} s"
        if grown > GROWN
        else ""
    )
    remedy = f"a horizon of at most {number(quiet[-1])} s, or a " if quiet else "a "
    return [
        (
            f"the noise of the sensors makes {quantity(figure.noise, unit)} of {result.name} at the"
            f" horizon, more than the {quantity(allowed, unit)} allowed{growth}; {remedy}"
            f"sensor {number(figure.noise / (LOUD * allowed))} times as quiet would tell"
        )
    ]


def allow_scatter(result: VariableResult) -> list[str]:
    """What to write where single runs scatter, and that is as it should be."""
    figure, unit = result.declared, result.unit
    if figure.interval.low <= _allowed(result):
        return []
    return [
        (
            f"if {result.name} may scatter like that, write `fidelity: {{scatter: {{{result.name}:"
            f" {quantity(result.scatter, unit)}}}}}`; else log what moves the robot, and let the"
            " field read it"
        )
    ]


def more_data(results: Sequence[VariableResult], judged: float) -> list[str]:
    """How much data of this kind would decide about variables that nothing but data is short of."""
    if not results:
        return []
    if not all(np.isfinite(result.declared.interval.high) for result in results):
        horizon = results[0].declared.horizon
        return [too_few(horizon)]
    factors = {result.name: times_more(result) for result in results}
    many = [result for result in results if factors[result.name] > HOPELESS]
    hopeless = [result.name for result in many if _is_near(result)]
    short = [result.name for result in many if not _is_near(result)]
    told = []
    if short:
        told.append(
            f"{seconds(judged)} of judged data tell too little about {listed(short)}: record many"
            " times as much"
        )
    if hopeless:
        verb, whose = ("departs", "its") if len(hopeless) == 1 else ("depart", "their")
        told.append(
            f"{listed(hopeless)} {verb} by just about {whose} tolerance: more data of this kind"
            " will hardly decide; reconsider the tolerance or the spec"
        )
    others = [name for name, factor in factors.items() if factor <= HOPELESS]
    if others:
        enough = max(factors[name] for name in others) * judged
        told.append(
            f"about {seconds(enough)} of judged data like these (now {seconds(judged)}) would"
            f" decide about {listed(others)}, if departures stay what they are"
        )
    return told


def _is_near(result: VariableResult) -> bool:
    """Whether it departs by about what is allowed."""
    return 0.5 <= result.declared.departure / _allowed(result) <= 2.0


def too_few(horizon: float) -> str:
    """How much data gives an interval at all."""
    return (
        f"record longer: {seconds(6.0 * horizon)} of judged data (six horizons) is the least"
        " that gives an interval"
    )


def times_more(result: VariableResult) -> float:
    """By how much data has to be multiplied until an interval no longer holds the tolerance.

    Of the departure; where that is decided, of the mean in the part that departs most surely.
    """
    at, allowed = result.declared, _allowed(result)
    if at.interval.low <= allowed <= at.interval.high:
        edge = at.interval.low if at.departure > allowed else at.interval.high
        far, gap = edge - at.departure, allowed - at.departure
    else:
        mean, interval = result.mean, result.mean_interval
        if result.worst is not None:
            mean, interval = result.worst.mean, result.worst.interval
        far, gap = 0.5 * (interval.high - interval.low), at.tolerance - abs(mean)
    return max(LEAST_MORE, float((far / (gap or 1e-300)) ** 2))


def _allowed(result: VariableResult) -> float:
    """What single windows may depart by (root mean square): the tolerance, and the scatter."""
    return float(np.hypot(result.tolerance, result.allowed_scatter))


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
    """Which values to record, axis by axis."""
    seen = coverage.samples >= coverage.enough
    advice = []
    for position, axis in enumerate(coverage.axes):
        others = tuple(i for i in range(seen.ndim) if i != position)
        empty = np.asarray(~np.any(seen, axis=others))
        ranges = _unseen_ranges(axis, empty)
        if ranges:
            through = axis.name if axis.values else f"{axis.name} from"
            advice.append(f"record {through} {listed(ranges)}, too: not seen at all")
    if advice:
        return advice
    return ["record more combinations: every axis was covered, but not jointly"]


def _unseen_ranges(axis: CellAxis, empty: Booleans) -> list[str]:
    if axis.values:
        return [name for name, is_empty in zip(axis.values, empty, strict=True) if is_empty]
    edges = np.linspace(axis.low, axis.high, axis.count + 1)
    return [span(edges[a], edges[b], axis.unit) for a, b in runs_of(empty)]


def _declared(evidence: Evidence, result: VariableResult) -> tuple[Array, Array]:
    """Errors at the declared horizon, and predicted ways to there, of the counted windows."""
    errors = evidence.errors[-1][evidence.index_of(result.name)]
    kept = evidence.kept(errors)
    return errors.mean[kept], errors.moved[kept]


def _interval(interval: Interval, unit: Unit) -> str:
    return span(interval.low, interval.high, unit)


def _windows(count: int) -> str:
    return "1 window" if count == 1 else f"{count} overlapping windows"
