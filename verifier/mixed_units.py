"""Units that a log may be in while it is read in another one: names, and what would mend it."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

from runtime.program import Binding, Unit
from spec_schema.units import UnitFault, parse_unit

WORDS: Final = {
    "deg": "degrees",
    "degree": "degrees",
    "rad": "radians",
    "mrad": "milliradians",
    "mm": "millimetres",
    "cm": "centimetres",
    "m": "metres",
    "km": "kilometres",
    "%": "percent",
    "1": "shares",
    "us": "microseconds",
    "ms": "milliseconds",
    "s": "seconds",
    "K": "kelvin",
}
"""Units by how people say them; others are said as they are written."""
ROOTS: Final = (("deg", "rad"), ("mm", "cm", "m", "km"))
"""Units that stand in for one another within a longer one, as in `deg/s` or `cm^2`."""
ANGLES: Final = ("deg", "rad", "mrad", "deg/s", "rpm", "rad/s")
"""In which sensors tell angles. These have no dimension, and are known by how they are written."""
UNITS: Final = (
    *("mm", "cm", "km", "m", "km/h", "kn", "mm/s", "cm/s", "m/s", "ms", "us", "s", "g", "kg"),
    *("%", "1", "mA", "A", "mV", "V", "hPa", "kPa", "bar", "Pa", "mbar", "kW", "W", "l", "m^3"),
)
"""In which sensors tell what is no angle."""
ANGULAR: Final = re.compile(r"rad|deg(?!C)|rpm|turn")
CLASSIC: Final = ("deg", "rad", "mm", "m")
"""A log in these is looked for in whatever lies within its domain, too."""
ZEROES: Final = {"Celsius": (1.0, 273.15), "Fahrenheit": (5.0 / 9.0, 459.67 * 5.0 / 9.0)}
"""Temperatures whose zero is not that of kelvin: factor and offset to kelvin."""
PLAUSIBLE: Final = 0.9
"""At least this share of the samples lies within the domain, where a unit is thought of."""
NEAR: Final = 0.1
"""A gain within this share of a slip's factor is that slip,"""
NEARER: Final = 0.02
"""or within this one, where the factor is none of orders of magnitude."""
LARGE: Final = 10.0
ROUNDING: Final = 1e-9
"""Factors closer than this share are one."""


@final
@dataclass(frozen=True, slots=True)
class Slip:
    """What a log is in, and what it was taken for.

    words: as `degrees for radians`. SI values `v` should have been `factor * v + offset`. written:
    the log's unit as a spec writes it; empty where a unit cannot mend it. is_classic: whether it
    is looked for where nothing hints at it.
    """

    words: str
    written: str
    factor: float
    offset: float = 0.0
    is_classic: bool = False


def is_angular(text: str) -> bool:
    """Whether a unit is one of angles, or of what is told by them: `rad/s`, `deg`, `rpm`."""
    return ANGULAR.search(text) is not None


def alternatives(unit: Unit) -> tuple[Slip, ...]:
    """What a number that was read in this unit may have been in instead, each factor once.

    >>> [slip.words for slip in alternatives(Unit("rad/s", 1.0))]
    ['degrees for radians', 'rpm for rad/s']
    >>> [(slip.words, slip.offset) for slip in alternatives(Unit("K", 1.0))][:1]
    [('Celsius for kelvin', 273.15)]
    """
    text = unit.text or "1"
    try:
        dimension = parse_unit(text).dimension
    except UnitFault:
        return ()
    tried = [*_of_roots(text, unit), *_of_whole(text, unit)]
    if text == "1":
        degree = parse_unit("deg").scale
        tried += [_slip("deg", "rad", degree, "deg"), _slip("rad", "deg", 1.0 / degree, "")]
    if dimension == parse_unit("K").dimension and unit.scale == 1.0:
        tried += [Slip(f"{n} for kelvin", "", f, offset) for n, (f, offset) in ZEROES.items()]
    found: list[Slip] = []
    for slip in tried:
        if not any(_is_same(slip, (each.factor, each.offset)) for each in found):
            found.append(slip)
    return tuple(each for each in found if not _is_same(each, (1.0, 0.0)))


def unit_read(own: Unit, binding: Binding | None) -> Unit:
    """The unit in which a variable of unit `own` is read from a log; an angle's is said to be one.

    >>> unit = Unit("1/s", 1.0)
    >>> unit_read(Unit("deg/s", 0.0175), Binding("w", "/w", unit, 0, 1, 0, None, (), "")).text
    'rad/s'
    """
    if binding is None or not binding.path:
        return own
    read = binding.unit
    if not is_angular(own.text) or is_angular(read.text):
        return read
    is_rate = "rpm" in own.text or "/s" in own.text
    return Unit("rad/s" if is_rate else "rad", read.scale)


def slip_by(factor: float, slips: tuple[Slip, ...]) -> Slip | None:
    """The one of these slips that a gain would mend, if it is one.

    >>> slips = alternatives(Unit("rad", 1.0))
    >>> slip_by(0.0175, slips).words, slip_by(0.3, slips)
    ('degrees for radians', None)
    """
    near = [s for s in slips if s.offset == 0.0 and abs(factor / s.factor - 1.0) < _room(s)]
    return min(near, key=lambda s: abs(factor / s.factor - 1.0), default=None)


def _room(slip: Slip) -> float:
    return NEAR if max(slip.factor, 1.0 / slip.factor) >= LARGE else NEARER


def _is_same(slip: Slip, other: tuple[float, float]) -> bool:
    factor, offset = other
    return abs(slip.factor / factor - 1.0) < ROUNDING and slip.offset == offset


def _of_roots(text: str, unit: Unit) -> Iterator[Slip]:
    for group in ROOTS:
        own = re.search(rf"(?<![A-Za-z])({'|'.join(group)})(?![A-Za-z])", text)
        if own is None:
            continue
        for other in group:
            written = f"{text[: own.start()]}{other}{text[own.end() :]}"
            factor = parse_unit(written).scale / unit.scale
            yield _slip(other, own.group(), factor, written)


def _of_whole(text: str, unit: Unit) -> Iterator[Slip]:
    dimension = parse_unit(text).dimension
    for other in ANGLES if is_angular(text) else UNITS:
        if parse_unit(other).dimension == dimension:
            yield _slip(other, text, parse_unit(other).scale / unit.scale, other)


def _slip(log: str, taken_for: str, factor: float, written: str) -> Slip:
    words = f"{WORDS.get(log, log)} for {WORDS.get(taken_for, taken_for)}"
    return Slip(words, written, factor, 0.0, log in CLASSIC)
