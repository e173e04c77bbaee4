"""Units that a log may be in while it is read in another one: names, and what would mend it."""

import re
from dataclasses import dataclass
from typing import Final, final

from runtime.program import Binding, Unit
from spec_schema.dimension import Dimension
from spec_schema.units import UnitFault, parse_unit

WORDS: Final = {
    "deg": "degrees",
    "rad": "radians",
    "mm": "millimetres",
    "cm": "centimetres",
    "m": "metres",
    "km": "kilometres",
    "%": "percent",
    "1": "shares",
    "ms": "milliseconds",
    "s": "seconds",
}
"""Units by how people say them; others are said as they are written."""
ROOTS: Final = (("deg", "rad"), ("mm", "cm", "m", "km"))
"""Units that stand in for one another within a longer one, as in `deg/s` or `cm^2`."""
WHOLE: Final = (
    *("km/h", "m/s", "kn", "g", "kg", "ms", "s", "mA", "A", "mV", "V", "W", "kW"),
    *("Pa", "hPa", "kPa", "bar"),
)
TURNING: Final = ("rpm", "rad/s")
"""Angles and shares have the same dimension, none, and are told apart by how they are written."""
SHARES: Final = ("%", "1")
ANGULAR: Final = re.compile(r"rad|deg|rpm|turn")
CLASSIC: Final = ("degrees", "radians", "millimetres", "metres")
"""The slips that are looked for in whatever lies within its domain, too."""
ZEROES: Final = {"Celsius": (1.0, 273.15), "Fahrenheit": (5.0 / 9.0, 459.67 * 5.0 / 9.0)}
"""Temperatures whose zero is not that of kelvin: factor and offset to kelvin."""
NEAR: Final = 0.1
"""A gain within this share of a slip's factor is that slip,"""
NEARER: Final = 0.02
"""or within this one, where the factor is none of orders of magnitude."""
LARGE: Final = 10.0


@final
@dataclass(frozen=True, slots=True)
class Slip:
    """words: `degrees for radians`, what the log is in and what it was taken for.

    SI values `v` should have been `factor * v + offset`. written: the log's unit as a spec writes
    it; empty where an offset mends it.
    """

    words: str
    factor: float
    offset: float
    written: str

    @property
    def is_classic(self) -> bool:
        """Whether it is looked for where nothing hints at it."""
        return self.words.partition(" ")[0] in CLASSIC


def slips_of(unit: Unit) -> tuple[Slip, ...]:
    """What a number that was read in this unit may have been in instead.

    >>> [slip.words for slip in slips_of(Unit("rad/s", 1.0))]
    ['degrees for radians', 'rpm for rad/s']
    >>> [(slip.words, slip.offset) for slip in slips_of(Unit("K", 1.0))][:1]
    [('Celsius for kelvin', 273.15)]
    """
    text = unit.text or "1"
    try:
        dimension = parse_unit(text).dimension
    except UnitFault:
        return ()
    found = [*_of_roots(text, unit), *_of_whole(text, unit, dimension)]
    if text in {"", "1"}:
        found += [_slip("deg", "rad", parse_unit("deg").scale, "deg")]
        found += [_slip("rad", "deg", 1.0 / parse_unit("deg").scale, "")]
    if text == "K":
        found += [Slip(f"{n} for kelvin", f, offset, "") for n, (f, offset) in ZEROES.items()]
    return tuple(found)


def unit_read(own: Unit, binding: Binding | None) -> Unit:
    """The unit in which a variable of unit `own` is read from a log; an angle's is said to be one.

    >>> unit = Unit("1/s", 1.0)
    >>> unit_read(Unit("deg/s", 0.0175), Binding("w", "/w", unit, 0, 1, 0, None, (), "")).text
    'rad/s'
    """
    if binding is None or not binding.path:
        return own
    read = binding.unit
    if not ANGULAR.search(own.text) or ANGULAR.search(read.text):
        return read
    is_rate = "rpm" in own.text or "/s" in own.text
    return Unit("rad/s" if is_rate else "rad", read.scale)


def slip_by(factor: float, slips: tuple[Slip, ...]) -> Slip | None:
    """The one of these slips that a gain would mend, if it is one.

    >>> slip_by(0.0175, slips_of(Unit("rad", 1.0))).words, slip_by(0.3, slips_of(Unit("m/s", 1.0)))
    ('degrees for radians', None)
    """
    near = [s for s in slips if s.offset == 0.0 and abs(factor / s.factor - 1.0) < _room(s)]
    return min(near, key=lambda s: abs(factor / s.factor - 1.0), default=None)


def _room(slip: Slip) -> float:
    return NEAR if max(slip.factor, 1.0 / slip.factor) >= LARGE else NEARER


def _of_roots(text: str, unit: Unit) -> list[Slip]:
    found = []
    for group in ROOTS:
        own = re.search(rf"(?<![A-Za-z])({'|'.join(group)})(?![A-Za-z])", text)
        if own is None:
            continue
        for other in group:
            written = f"{text[: own.start()]}{other}{text[own.end() :]}"
            if other != own.group():
                factor = parse_unit(written).scale / unit.scale
                found.append(_slip(other, own.group(), factor, written))
    return found


def _of_whole(text: str, unit: Unit, dimension: Dimension) -> list[Slip]:
    plain = SHARES if text in SHARES else WHOLE
    tried: tuple[str, ...] = TURNING if ANGULAR.search(text) else plain
    return [
        _slip(other, text, parse_unit(other).scale / unit.scale, other)
        for other in tried
        if other != text and parse_unit(other).dimension == dimension
    ]


def _slip(log: str, taken_for: str, factor: float, written: str) -> Slip:
    words = f"{WORDS.get(log, log)} for {WORDS.get(taken_for, taken_for)}"
    return Slip(words, factor, 0.0, written)
