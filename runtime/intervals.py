"""Interval arithmetic over arrays, rounded outward: what a number may be, given what others may be.

An `Interval` holds every value that a real expression takes; it is wider than need be, never
narrower (Moore, Kearfott, Cloud 2009). A value that nowhere exists (the root of a negative number)
is NaN at both ends; where it exists in part of the box, the interval speaks of that part.

The four operations and the root are rounded correctly by IEEE 754: one step to the next number
outward makes them safe. Functions of the mathematics library are off by at most 4 units in the last
place (numpy's own limit for its tests), and sine and cosine by 2**-51 absolutely: `_loosened`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans

Real: TypeAlias = Callable[[Array], Array]

LOOSE: Final = 2.0**-50
"""Four units in the last place, relative."""

ABSOLUTE: Final = 2.0**-51
"""What a sine or cosine may be off by."""

TURN: Final = 2.0 * np.pi

FAR: Final = 2.0**30
"""Arguments of sine and cosine beyond it are taken as any angle."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Interval:
    """All numbers from `low` to `high`, for each entry of the arrays; NaN at both for none."""

    low: Array
    high: Array


def exactly(value: float | Array) -> Interval:
    """The interval of one number."""
    number = np.asarray(value, dtype=np.float64)
    return Interval(number, number)


def whole(shape: tuple[int, ...]) -> Interval:
    """All real numbers."""
    return Interval(np.full(shape, -np.inf), np.full(shape, np.inf))


def outward(low: Array, high: Array) -> Interval:
    """The interval, each end moved to the next number outward."""
    return Interval(np.nextafter(low, -np.inf), np.nextafter(high, np.inf))


def is_zero(a: Interval) -> Booleans:
    """Where an interval is exactly 0."""
    return np.asarray((a.low == 0.0) & (a.high == 0.0))


def holds_zero(a: Interval) -> Booleans:
    """Where an interval contains 0."""
    return np.asarray((a.low <= 0.0) & (a.high >= 0.0))


def add(a: Interval, b: Interval) -> Interval:
    """A + b."""
    return outward(a.low + b.low, a.high + b.high)


def negative(a: Interval) -> Interval:
    """-a."""
    return Interval(-a.high, -a.low)


def subtract(a: Interval, b: Interval) -> Interval:
    """A - b."""
    return outward(a.low - b.high, a.high - b.low)


def multiply(a: Interval, b: Interval) -> Interval:
    """A b; what is exactly 0 stays so, also beside an unbounded factor."""
    products = (a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high)
    low = np.minimum(np.minimum(products[0], products[1]), np.minimum(products[2], products[3]))
    high = np.maximum(np.maximum(products[0], products[1]), np.maximum(products[2], products[3]))
    nothing = np.isnan(a.low) | np.isnan(b.low)
    if np.any(np.isnan(low) & ~nothing):  # 0 * inf
        known = [np.where(np.isnan(p), 0.0, p) for p in products]
        low = np.where(nothing, np.nan, np.minimum.reduce(known))
        high = np.where(nothing, np.nan, np.maximum.reduce(known))
    zero = (is_zero(a) | is_zero(b)) & ~nothing
    wide = outward(low, high)
    return Interval(np.where(zero, 0.0, wide.low), np.where(zero, 0.0, wide.high))


def inverse(a: Interval) -> Interval:
    """1 / a; all numbers where a contains 0 inside or is 0 (the machine's 1/0 is infinite)."""
    low, high = 1.0 / a.high, 1.0 / a.low
    result = outward(low, high)
    open_ = holds_zero(a)
    if not np.any(open_):
        return result
    # From one side of zero the inverse is bounded on one side.
    at_low, at_high = open_ & (a.low == 0.0), open_ & (a.high == 0.0)
    low = np.where(open_, np.where(at_low, result.low, -np.inf), result.low)
    high = np.where(open_, np.where(at_high, result.high, np.inf), result.high)
    high = np.where(at_low, np.inf, high)
    low = np.where(at_high, -np.inf, low)
    none = is_zero(a)
    return Interval(np.where(none, -np.inf, low), np.where(none, np.inf, high))


def square(a: Interval) -> Interval:
    """a², not negative."""
    size = magnitude(a)
    result = outward(size.low * size.low, size.high * size.high)
    return Interval(np.maximum(result.low, 0.0), result.high)


def magnitude(a: Interval) -> Interval:
    """The sizes |a|."""
    ends = np.abs(a.low), np.abs(a.high)
    low = np.where(holds_zero(a), 0.0, np.minimum(*ends))
    return Interval(low, np.maximum(*ends))


def hull(a: Interval, b: Interval) -> Interval:
    """The smallest interval around both; what is nowhere does not count."""
    return Interval(np.fmin(a.low, b.low), np.fmax(a.high, b.high))


def common(a: Interval, b: Interval) -> Interval:
    """What both contain; NaN where that is nothing."""
    low, high = np.maximum(a.low, b.low), np.minimum(a.high, b.high)
    empty = low > high
    return Interval(np.where(empty, np.nan, low), np.where(empty, np.nan, high))


def chosen(where: Booleans, a: Interval, b: Interval) -> Interval:
    """`a` where a condition holds, else `b`."""
    return Interval(np.where(where, a.low, b.low), np.where(where, a.high, b.high))


def within(a: Interval, low: float, high: float) -> Interval:
    """The part of an argument from `low` to `high`; NaN where there is none."""
    return common(a, Interval(np.asarray(low), np.asarray(high)))


def rising(function: Real, a: Interval) -> Interval:
    """A function that never falls."""
    return _loosened(function(a.low), function(a.high))


def even_rising(function: Real, a: Interval) -> Interval:
    """A function that is even, and rises with the size of its argument."""
    size = magnitude(a)
    return _loosened(function(size.low), function(size.high))


def sine(a: Interval) -> Interval:
    """Sin a."""
    return _wave(np.sin, a, 0.25 * TURN)


def cosine(a: Interval) -> Interval:
    """Cos a."""
    return _wave(np.cos, a, 0.0)


def root(a: Interval) -> Interval:
    """The square root of what is not negative of a."""
    some = Interval(np.maximum(a.low, 0.0), np.where(a.high < 0.0, np.nan, a.high))
    result = outward(np.sqrt(some.low), np.sqrt(some.high))
    none = np.isnan(result.high)
    return Interval(np.where(none, np.nan, np.maximum(result.low, 0.0)), result.high)


def _wave(function: Real, a: Interval, top: float) -> Interval:
    """A sine wave whose maxima lie at `top` and whole turns from there."""
    first, last = (function(np.where(np.isfinite(end), end, 0.0)) for end in (a.low, a.high))
    low, high = np.minimum(first, last) - ABSOLUTE, np.maximum(first, last) + ABSOLUTE
    far = ~(np.maximum(np.abs(a.low), np.abs(a.high)) < FAR)
    high = np.where(far | _meets(a, top), 1.0, np.minimum(high, 1.0))
    low = np.where(far | _meets(a, top + 0.5 * TURN), -1.0, np.maximum(low, -1.0))
    none = np.isnan(a.low)
    return Interval(np.where(none, np.nan, low), np.where(none, np.nan, high))


def _meets(a: Interval, at: float) -> Booleans:
    """Whether a contains, or nearly contains, `at` plus some whole number of turns."""
    first, last = (a.low - at) / TURN, (a.high - at) / TURN
    slack = 2.0**-46 * (1.0 + np.maximum(np.abs(first), np.abs(last)))
    return np.asarray(np.floor(last + slack) >= np.ceil(first - slack))


def _loosened(low: Array, high: Array) -> Interval:
    slack = [np.where(np.isfinite(end), LOOSE * np.abs(end), 0.0) for end in (low, high)]
    return outward(low - slack[0], high + slack[1])
