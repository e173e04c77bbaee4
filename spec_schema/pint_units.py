"""The door to pint: what one unit is in SI. Importing it costs half a second, so few do."""

from fractions import Fraction
from functools import cache
from typing import Any, SupportsFloat, cast

import pint

BASES: dict[str, int] = {
    "[length]": 0,
    "[mass]": 1,
    "[time]": 2,
    "[current]": 3,
    "[temperature]": 4,
    "[substance]": 5,
    "[luminosity]": 6,
}
"""Where each of pint's dimensions stands in ours: m, kg, s, A, K, mol, cd."""


@cache
def look_up(name: str) -> tuple[float | None, tuple[float, ...]] | None:
    """SI scale and exponents of the unit with this single name; None where we can use none.

    The scale is None for what is no plain multiple of an SI unit: degrees Celsius, decibels.
    """
    registry = _registry()
    try:
        unit = registry.Unit(name)
        factor, _ = registry.get_base_units(unit)
        dimensions = dict(unit.dimensionality)
        definition = registry._units[str(unit)]  # noqa: SLF001  # pint has no public way to ask
    except (pint.errors.PintError, AttributeError, KeyError, TypeError, ValueError):
        return None
    if not dimensions.keys() <= BASES.keys():
        return None
    exponents = [0.0] * len(BASES)
    for dimension, exponent in dimensions.items():
        exponents[BASES[dimension]] = float(cast("SupportsFloat", exponent))
    return float(cast("SupportsFloat", factor)) if definition.is_multiplicative else None, tuple(
        exponents
    )


@cache
def _registry() -> pint.UnitRegistry[Any]:
    return pint.UnitRegistry(non_int_type=Fraction)  # exact, so that a foot is 0.3048 m
