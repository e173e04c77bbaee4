"""What a diagnosis says, in sentences."""

from typing import Final

import numpy as np

from runtime.program import Unit
from verifier.diagnosis.altered import Effect, Values
from verifier.diagnosis.candidates.readings import Reading
from verifier.diagnosis.naming import kind_of, slip_of
from verifier.diagnosis.parameters import Parameter
from verifier.report import situations
from verifier.report.diagnosis import CandidateKind, DepartureAfter, FittedNumber
from verifier.report.report import Interval, RegionMean, Standing
from verifier.report.wording import listed, number, percent, quantity, suffix

MOST: Final = 3
"""So many names in a row, at most."""


def with_doubt(value: float, interval: Interval, unit_scale: float) -> str:
    """`0.46 ± 0.01`, rounded to the doubt; without it where there is no interval.

    >>> with_doubt(0.45967, Interval(0.4496, 0.4697), 1.0)
    '0.46 ± 0.01'
    """
    half = 0.5 * (interval.high - interval.low) / unit_scale
    if not np.isfinite(half) or half <= 0.0:
        return number(value / unit_scale)
    digits = int(max(0, min(9, -np.floor(np.log10(half)))))
    if half * 10.0**digits < 1.95:
        digits = min(digits + 1, 9)
    doubt = f"{half:.{digits}f}"
    plain = f"{value / unit_scale:.{digits}f}"
    return f"{_trimmed(plain, doubt)[0]} ± {_trimmed(plain, doubt)[1]}"


def _trimmed(plain: str, doubt: str) -> tuple[str, str]:
    """Without zeros that both end in behind the point."""
    while "." in plain and plain[-1] == "0" and doubt[-1] == "0":
        plain, doubt = plain[:-1].rstrip("."), doubt[:-1].rstrip(".")
    return plain, doubt


def of_parameter(parameter: Parameter, value: float, interval: Interval, *, moved: bool) -> str:
    """`v1 is 0.46 ± 0.01 m/s (spec 0.5)`."""
    unit = parameter.unit
    found = f"{with_doubt(value, interval, unit.scale)}{suffix(unit)}"
    spec = number(parameter.spec / unit.scale)
    so = (
        "" if moved else ", which agrees" if interval.low <= parameter.spec <= interval.high else ""
    )
    return f"{parameter.label} is {found} (spec {spec}{so})"


def of_candidate(effect: Effect, values: Values, numbers: tuple[FittedNumber, ...]) -> str:
    """What the robot or the log would have to be like."""
    kind, names = kind_of(effect, values), listed(list(effect.applies_to))
    found = [
        f"{with_doubt(abs(n.value), n.interval, n.unit.scale)}{suffix(n.unit)}" for n in numbers
    ]
    subject = effect.subject or names
    size = found[0] if found else ""
    side = "early" if values and values[0] > 0.0 else "late"
    verb = "act" if len(effect.applies_to) > 1 else "acts"
    if kind is CandidateKind.REGION:
        return _in_a_region(effect, numbers, size)
    if kind is CandidateKind.TERM:
        return _with_a_term(effect, numbers[0])
    if kind is CandidateKind.BOUND:
        return _with_a_bound(effect, numbers[0])
    said = {
        CandidateKind.DEAD_TIME: f"{subject} {verb} {size} later than the spec says",
        CandidateKind.LATE_LOG: f"the log tells {names} {size} {side}",
        CandidateKind.CLOCK_OFFSET: f"the stamps of {subject} are {size} {side} beside those of the"
        " other topics",
        CandidateKind.LAG: f"{subject} acts through a first-order lag of {size}",
        CandidateKind.SATURATION: f"{subject} saturates at {size}",
        CandidateKind.DEAD_ZONE: f"{subject} has a dead zone of {size} to either side",
        CandidateKind.SIGN: f"{names} has the wrong sign",
        CandidateKind.SWAPPED_AXES: f"{names} are swapped",
    }
    if kind is CandidateKind.UNIT_SLIP:
        return f"{names} looks like {slip_of(effect, values)}"
    return said[kind] if kind in said else of_scalar(effect, numbers[0])


def _in_a_region(effect: Effect, numbers: tuple[FittedNumber, ...], size: str) -> str:
    rate, name = effect.applies_to
    way = "higher" if numbers[0].value > 0.0 else "lower"
    edge = numbers[1]
    border = f"{with_doubt(edge.value, edge.interval, edge.unit.scale)}{suffix(edge.unit)}"
    return f"the rate of {rate} is {size} {way} where {name} is {effect.detail} {border}"


def _with_a_term(effect: Effect, found: FittedNumber) -> str:
    size = with_doubt(found.value, found.interval, found.unit.scale)
    term = f"{size}{suffix(found.unit)} times {effect.detail}"
    return f"the rate of {effect.applies_to[0]} has a further term {term}"


def _with_a_bound(effect: Effect, found: FittedNumber) -> str:
    size = f"{with_doubt(found.value, found.interval, found.unit.scale)}{suffix(found.unit)}"
    return f"{effect.applies_to[0]} goes {effect.detail.format(size)}"


def of_scalar(effect: Effect, found: FittedNumber) -> str:
    """A number of the spec, a gain or an offset."""
    value = f"{with_doubt(found.value, found.interval, found.unit.scale)}{suffix(found.unit)}"
    return f"{effect.label} is {value} (spec {number(found.neutral / found.unit.scale)})"


def evidence(share: float, before: tuple[str, ...]) -> str:
    """How much it explains of what was left."""
    what = "what is left of the error" if before else "the error beyond noise"
    return f"it explains {percent(max(share, 0.0))} of {what} in windows that it was not fitted to"


def in_other_words(said: list[str]) -> str:
    """Explanations that leave the very same trace."""
    more = _or_more(len(said) - MOST)
    return f"in other words, which leave the same trace: {', or '.join(said[:MOST])}{more}"


def _or_more(count: int) -> str:
    """`, or 2 others`; nothing where there are none."""
    return f", or {count} other{'s' if count > 1 else ''}" if count > 0 else ""


def still(left: str, before: tuple[str, ...]) -> str:
    """What is beyond a tolerance even so; nothing where nothing is."""
    how = "with those before it" if before else "taken alone"
    return f"; {how}, it still leaves {left}" if left else ""


def of_reading(reading: Reading, share: float, *, was_judged: bool) -> str:
    """What speaks for another reading of the log."""
    if was_judged:
        return evidence(share, ())
    names = listed(list(reading.applies_to))
    lies = "lies within its domain" if len(reading.applies_to) == 1 else "lie within their domains"
    said = f"read so, {names} {lies}"
    return f"{said}, and the spec explains {percent(max(share, 0.0))} of how the robot moves"


def partly(share: float, count: int) -> str:
    """That `count` explanations leave most of it open."""
    if count == 1:
        return "most of the error stays unexplained"
    of = f"{percent(max(share, 0.0))} of the error beyond noise over the whole trace"
    return f"together they explain {of}; the rest stays unexplained"


def either(labels: list[str]) -> str:
    """Explanations that are as good."""
    shown = labels[:MOST]
    more = _or_more(len(labels) - MOST)
    return f"this trace can't tell it from {' or '.join(shown)}{more}"


def afterwards(after: tuple[DepartureAfter, ...]) -> tuple[str, ...]:
    """What is left once all that was taken in, and all numbers that the trace tells, are fitted."""
    over = [_left(each) for each in after if each.standing is Standing.EXCEEDED]
    under = [_left(each) for each in after if each.standing is not Standing.EXCEEDED]
    said = [f"even so {'; '.join(over)}: more than is allowed"] if over else []
    return (*said, *([f"with that {'; '.join(under)}"] if under else []))


def _left(after: DepartureAfter) -> str:
    left, allowed = quantity(after.after, after.unit), quantity(after.tolerance, after.unit)
    return f"{after.name} departs by {left} (allowed {allowed})"


def within(name: str, departure: float, tolerance: float, unit: Unit) -> str:
    """A variable that departs clearly, and may."""
    return (
        f"{name} departs by {quantity(departure, unit)}, which {quantity(tolerance, unit)} allow;"
        " nothing that was tried explains it"
    )


def where(name: str, region: RegionMean, units: dict[str, Unit]) -> str:
    """`heading still differs where heading is 0.2 to 0.4 rad and it should fall by 0.3 rad`."""
    return f"{name} still differs {situations.where(region, units[name], units)}".rstrip()
