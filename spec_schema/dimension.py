"""Physical dimensions: the exponents of m, kg, s, A, K, mol, cd. Angles and shares have none."""

from fractions import Fraction
from typing import TypeAlias

Dimension: TypeAlias = tuple[Fraction, ...]

BASES = ("m", "kg", "s", "A", "K", "mol", "cd")
DIMENSIONLESS: Dimension = (Fraction(0),) * len(BASES)


def describe(dimension: Dimension) -> str:
    """The dimension as a unit that `parse_unit` reads back.

    >>> describe((Fraction(1), Fraction(1), Fraction(-2), *DIMENSIONLESS[3:]))
    'kg*m/s^2'
    """
    order = sorted(zip(BASES, dimension, strict=True), key=lambda part: part[0] != "kg")
    above = [_power(base, e) for base, e in order if e > 0]
    below = [_power(base, -e) for base, e in order if e < 0]
    numerator = "*".join(above) or "1"
    if len(below) > 1:
        return f"{numerator}/({'*'.join(below)})"
    return "/".join([numerator, *below])


def _power(base: str, exponent: Fraction) -> str:
    if exponent == 1:
        return base
    return f"{base}^{exponent}" if exponent.denominator == 1 else f"{base}^({exponent})"


def product(a: Dimension, b: Dimension) -> Dimension:
    """The dimension of a product of quantities."""
    return tuple(x + y for x, y in zip(a, b, strict=True))


def quotient(a: Dimension, b: Dimension) -> Dimension:
    """The dimension of a quotient of quantities."""
    return tuple(x - y for x, y in zip(a, b, strict=True))


def power(a: Dimension, exponent: Fraction) -> Dimension:
    """The dimension of a power of a quantity."""
    return tuple(x * exponent for x in a)
