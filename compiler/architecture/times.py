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
