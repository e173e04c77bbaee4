"""Intervals of doubles, rounded outward: what a computed value can be.

`low` and `high` bound every value that is a number (infinities included); `nan` tells whether it
may also be none. An interval without numbers has low > high. The ends of arithmetic are exact
within one unit in the last place, those of math.h's functions within four on the libraries we
know; so they are moved outward by that and one more.
(Moore, Kearfott, Cloud: Introduction to Interval Analysis, 2009.)
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import final

EPSILON = math.ulp(1.0)


@final
@dataclass(frozen=True, slots=True)
class Interval:
    """All numbers in [low, high], and perhaps nan."""

    low: float
    high: float
    nan: bool = False

    @property
    def is_empty(self) -> bool:
        """Whether no number is in it."""
        return self.low > self.high

    @property
    def is_unbounded(self) -> bool:
        """Whether an infinity is in it."""
        return not self.is_empty and (math.isinf(self.low) or math.isinf(self.high))

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high


def nothing() -> Interval:
    """No number at all: every value is nan."""
    return Interval(math.inf, -math.inf, nan=True)


def outward(low: float, high: float, *, ulps: int, nan: bool) -> Interval:
    """The interval, its ends moved outward by at least `ulps` units in the last place."""
    return Interval(
        math.nextafter(_moved(low, -ulps), -math.inf),
        math.nextafter(_moved(high, ulps), math.inf),
        nan,
    )


def _moved(value: float, ulps: int) -> float:
    if ulps in {-1, 1} or math.isinf(value):
        return value
    return value + abs(value) * EPSILON * ulps


def hull(intervals: Iterable[Interval]) -> Interval:
    """The smallest interval around them all."""
    found = tuple(intervals)
    low, high = min(part.low for part in found), max(part.high for part in found)
    return Interval(low, high, any(part.nan for part in found))


def clamped(a: Interval, low: float, high: float) -> Interval:
    """The part between two limits that no computed value oversteps."""
    return Interval(max(a.low, low), min(a.high, high), a.nan) if not a.is_empty else a


def restricted(a: Interval, low: float, high: float) -> Interval:
    """The part of an operand in a function's domain; what lies outside gives nan."""
    outside = a.low < low or a.high > high
    inside = Interval(max(a.low, low), min(a.high, high), a.nan or outside)
    return nothing() if inside.is_empty else inside


def around(corners: Iterable[float], *, ulps: int, nan: bool) -> Interval:
    """Around values computed at corners; those that are nan are left out (0*inf, inf/inf)."""
    values = [value for value in corners if not math.isnan(value)]
    return outward(min(values), max(values), ulps=ulps, nan=nan) if values else nothing()


def rising(function: Callable[[float], float]) -> Callable[[Interval], Interval]:
    """A non-decreasing function of math.h on intervals inside its domain."""

    def on_interval(a: Interval) -> Interval:
        return outward(_at(function, a.low), _at(function, a.high), ulps=4, nan=a.nan)

    return on_interval


def _at(function: Callable[[float], float], value: float) -> float:
    try:
        return function(value)
    except OverflowError:
        return math.copysign(math.inf, value)


def add(a: Interval, b: Interval) -> Interval:
    """The sum; inf - inf is nan."""
    nan = a.nan or b.nan or (a.is_unbounded and b.is_unbounded)
    low, high = a.low + b.low, a.high + b.high
    low = -math.inf if math.isnan(low) else low
    return outward(low, math.inf if math.isnan(high) else high, ulps=1, nan=nan)


def negate(a: Interval) -> Interval:
    """-a, exactly."""
    return Interval(-a.high, -a.low, a.nan)


def subtract(a: Interval, b: Interval) -> Interval:
    """The difference."""
    return add(a, negate(b))


def multiply(a: Interval, b: Interval) -> Interval:
    """The product; 0 * inf is nan, but 0 times anything finite is 0."""
    nan = a.nan or b.nan or (0.0 in a and b.is_unbounded) or (0.0 in b and a.is_unbounded)
    corners = [x * y if x and y else 0.0 for x in (a.low, a.high) for y in (b.low, b.high)]
    return around(corners, ulps=1, nan=nan)


def divide(a: Interval, b: Interval) -> Interval:
    """The quotient; anything where b may be 0, whose sign decides between inf and -inf."""
    nan = a.nan or b.nan or (a.is_unbounded and b.is_unbounded)
    if 0.0 in b:
        return Interval(-math.inf, math.inf, nan or 0.0 in a)
    return around((x / y for x in (a.low, a.high) for y in (b.low, b.high)), ulps=1, nan=nan)


def absolute(a: Interval) -> Interval:
    """|a|, exactly."""
    if 0.0 in a:
        return Interval(0.0, max(-a.low, a.high), a.nan)
    return a if a.low > 0 else negate(a)


def modulo(a: Interval, b: Interval) -> Interval:
    """Python's a % b, which is in [0, b] or [b, 0] (rounding may reach b)."""
    nan = a.nan or b.nan or a.is_unbounded or 0.0 in b
    if a.low >= 0.0 and a.high < b.low:
        return Interval(a.low, a.high, nan)
    low, high = min(b.low, 0.0), max(b.high, 0.0)
    if low == 0.0 and a.low >= 0.0:
        high = min(high, a.high)
    return Interval(low, high, nan)


def smaller(a: Interval, b: Interval) -> Interval:
    """min(a, b)."""
    return Interval(min(a.low, b.low), min(a.high, b.high), a.nan or b.nan)


def larger(a: Interval, b: Interval) -> Interval:
    """max(a, b)."""
    return Interval(max(a.low, b.low), max(a.high, b.high), a.nan or b.nan)


def power(a: Interval, b: Interval) -> Interval:
    """The power; a negative base has whole powers only."""
    if b.low == b.high and not b.nan and b.low.is_integer():
        return _whole_power(a, b.low)
    nan = a.nan or b.nan
    parts = []
    if a.high >= 0 and not b.is_empty:
        base = Interval(max(a.low, 0.0), a.high)
        parts.append(_positive_power(base, b))
    if a.low < 0 and _holds_whole(b):
        base = Interval(max(-a.high, 0.0), -a.low)
        size = _positive_power(base, b)
        parts.extend((size, negate(size)))
    if a.low == -math.inf and not b.is_empty:
        infinite = Interval(math.inf, math.inf)
        parts.append(_positive_power(infinite, b))  # C: (-inf)**y is inf for a broken y > 0
    if (a.nan and 0.0 in b) or (b.nan and 1.0 in a):
        parts.append(Interval(1.0, 1.0))  # nan**0 = 1**nan = 1
    if not parts:
        return nothing()
    return replace(hull(parts), nan=nan or a.low < 0)


def _holds_whole(a: Interval) -> bool:
    return a.is_unbounded or (not a.is_empty and math.ceil(a.low) <= math.floor(a.high))


def _positive_power(a: Interval, b: Interval) -> Interval:
    """Monotone in each operand, so the corners hold the extremes."""
    corners = [_pow(x, y) for x in (a.low, a.high) for y in (b.low, b.high)]
    return clamped(around(corners, ulps=4, nan=False), 0.0, math.inf)


def _whole_power(a: Interval, n: float) -> Interval:
    if n == 0.0:
        return Interval(1.0, 1.0)  # of nan, too
    if a.is_empty:
        return a
    if n < 0 and 0.0 in a:
        odd = n % 2 == 1
        return Interval(-math.inf if odd else 0.0, math.inf, a.nan)
    values = [_pow(a.low, n), _pow(a.high, n)]
    even = n % 2 == 0
    if even and 0.0 in a:
        values.append(0.0)
    # A power may be computed by n multiplications, each of which rounds.
    result = around(values, ulps=4 + int(min(abs(n), 64.0)), nan=a.nan)
    return clamped(result, 0.0, math.inf) if even else result


def _pow(base: float, exponent: float) -> float:
    try:
        return math.pow(base, exponent)
    except OverflowError:
        return -math.inf if base < 0 and exponent % 2 == 1 else math.inf
    except ValueError:
        return math.inf  # 0**negative
