"""Bounds of few digits: the shortest decimal number between two others."""

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal


def shortest_between(low: float, high: float, near: float) -> float:
    """The decimal number of fewest digits in [low, high]; of several the one nearest to `near`.

    >>> shortest_between(0.4996, 0.5003, 0.5001), shortest_between(0.12, 0.19, 0.18)
    (0.5, 0.18)
    >>> shortest_between(0.41, 0.83, 0.42), shortest_between(-3.0, 4.0, 2.0)
    (0.5, 0.0)
    """
    if low <= 0.0 <= high:
        return 0.0
    top = math.floor(math.log10(max(abs(low), abs(high)))) + 1
    for exponent in range(top, top - 18, -1):
        first, last = _ceiling(low, exponent), _floor(high, exponent)
        if first <= last:
            k = min(max(round(near / 10.0**exponent), first), last)
            return min(max(float(f"{k}e{exponent}"), low), high)
    return high


def of_digits(value: float, digits: int, *, up: bool) -> float:
    """The nearest number of so many digits that is not below a value, or that is not above it.

    >>> of_digits(2.9999, 2, up=False), of_digits(2.9999, 1, up=True), of_digits(0.3, 2, up=True)
    (2.9, 3.0, 0.3)
    """
    rounding = ROUND_CEILING if up else ROUND_FLOOR
    return float(Context(prec=digits, rounding=rounding).create_decimal(repr(value)))


def _ceiling(value: float, exponent: int) -> int:
    """The first multiple of 10^exponent that is not below a number, exact in decimals."""
    scaled = Decimal(repr(value)).scaleb(-exponent)
    return int(scaled.to_integral_value(ROUND_CEILING))


def _floor(value: float, exponent: int) -> int:
    return -_ceiling(-value, exponent)


def snapped(above: float, up_to: float, near: float) -> float:
    """A bound in (above, up_to] of few digits, or the one right above `above` if that has fewer.

    A rule holds where lower <= x < upper. So a bound right above 0.9 reads "x <= 0.9" as an upper
    and "x > 0.9" as a lower one.
    """
    short = shortest_between(above, up_to, near)
    return short if short > above else math.nextafter(above, math.inf)


def just_below(bound: float) -> float | None:
    """The number that `bound` stands right above, if that has fewer digits; else None."""
    below = math.nextafter(bound, -math.inf)
    return below if len(repr(below)) + 4 < len(repr(bound)) else None
