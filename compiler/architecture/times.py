"""The step that all times share: the longest that divides them, and what makes it short."""

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Final

from compiler.architecture.parts import Parts
from compiler.findings import Findings
from spec_schema.places import Path

LEAST_STEP: Final = Fraction(1, 10_000)
"""Seconds: below this a step of the world costs more than it tells."""
SHORT_STEP: Final = Fraction(1, 2000)
"""Seconds: a shorter step is hardly ever meant, and a run takes ten times as many as usual."""
USUAL_STEP: Final = Fraction(1, 240)
"""Seconds: the longest step of a scenario that does not say another."""
ROUND: Final = tuple(Fraction(n, 1000) for n in (1, 5, 10))
"""Multiples of these are proposed."""
FINEST: Final = 10**7
"""Times are read as fractions of a second with at most this denominator."""


def seconds(value: float) -> str:
    """A time as one writes it.

    >>> seconds(0.05), seconds(2.0)
    ('50 ms', '2 s')
    """
    return f"{value:.4g} s" if value >= 1.0 else f"{1000 * value:.4g} ms"


def exact(value: float) -> Fraction:
    """A time as the fraction that was meant: 1/30 s is no whole number of nanoseconds."""
    return Fraction(value).limit_denominator(FINEST)


def common(times: Iterable[Fraction]) -> Fraction:
    """The longest time that divides all of them; 0 where there are none."""
    found = Fraction(0)
    for time in times:
        denominator = math.lcm(found.denominator, time.denominator)
        whole = math.gcd(
            found.numerator * (denominator // found.denominator),
            time.numerator * (denominator // time.denominator),
        )
        found = Fraction(whole, denominator)
    return found


def _times_of(parts: Parts) -> list[tuple[Path, float]]:
    """Every time that the step must divide, and where it stands; sensors' at the body."""
    sensors = () if parts.body is None else parts.body.body.sensors
    of_body: Path = ("body",)
    found = [(of_body, time) for s in sensors for time in (s.every, s.latency)]
    for part in parts.nodes.values():
        found += [((*part.path, "period"), part.period)]
        found += [((*part.path, "response_time"), part.response_time)]
    return found


def check_common_step(parts: Parts, findings: Findings) -> None:
    """A finding at the first time that leaves no step of 0.1 ms."""
    shared = Fraction(0)
    for path, time in _times_of(parts):
        if time == 0.0:
            continue
        with_it = common((shared, exact(time)))
        if with_it < LEAST_STEP:
            message = f"no step of 0.1 ms or more divides {seconds(time)} and the times before it"
            remedy = "write times that are multiples of one another, or of 1 ms"
            if shared:
                near = max(round(exact(time) / shared), 1) * shared
                remedy = f"write {seconds(float(near))}"
            findings.error("S352", path, message, remedy)
            return
        shared = with_it
    if 0 < shared < SHORT_STEP:
        times = {exact(time): path for path, time in reversed(_times_of(parts)) if time > 0.0}
        message, remedy = short_step(times)
        findings.warning("S355", times[_forcing(times)[0]], message, remedy)


def step_of(shared: Fraction, longest: Fraction) -> Fraction:
    """The longest step up to `longest` that divides `shared`, where that is above 0."""
    return shared / math.ceil(shared / longest)


def short_step(times: Iterable[Fraction]) -> tuple[str, str]:
    """What is told of times whose common step is short, and what to write instead."""
    known = sorted(set(times), reverse=True)
    step, forcing = common(known), _forcing(known)
    rest = common(time for time in known if time not in forcing)
    written = " and ".join(seconds(float(time)) for time in forcing)
    message = (
        f"{written} and the other times have no longer step in common than "
        f"{seconds(float(step))}, so a run takes {round(USUAL_STEP / step)} times the usual steps"
    )
    return message, "; ".join(_nearby(time, rest) for time in forcing)


def _forcing(times: Iterable[Fraction]) -> list[Fraction]:
    """Those without any one of which the step would not be short, or else those that are odd."""
    known = list(dict.fromkeys(times))
    alone = [time for time in known if not 0 < common(o for o in known if o != time) < SHORT_STEP]
    odd = [time for time in known if time % SHORT_STEP]
    return alone or odd or known


def _nearby(time: Fraction, rest: Fraction) -> str:
    """The nearest round time that does with the rest, and one that allows a longer step."""
    found: list[tuple[Fraction, Fraction]] = []
    for unit in ROUND:
        near = max(round(time / unit), 1) * unit
        step = step_of(common((rest, near)), USUAL_STEP)
        if step >= SHORT_STEP and all(step > known for _, known in found):
            found.append((near, step))
    told = " or ".join(f"{seconds(float(t))} (a step of {seconds(float(s))})" for t, s in found)
    return f"write {told or 'a multiple of the others'} instead of {seconds(float(time))}"
