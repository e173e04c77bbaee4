"""Quantities of a book as cells of tables: exact, in the spec's own units."""

from collections.abc import Iterable
from typing import Final

from runtime.arbiter import Read
from runtime.program import Control, Kind, State, Unit
from specc.figures.quantities import multiple_of_pi, number, quantity

DIGITS: Final = 6
FAR: Final = 1e300
"""What a body says of a reading that has no limits."""
SECOND: Final = Unit("s", 1.0)
NOTHING: Final = "–"
KINDS: Final = {Kind.CONTINUOUS: "number", Kind.PERIODIC: "angle", Kind.DISCRETE: "one of"}


def exact(value: float, unit: Unit) -> str:
    """A value (SI) with all digits that matter: `0.7 m`."""
    return quantity(value, unit, DIGITS)


def range_of(part: State | Control | Read) -> str:
    """`0.2 … 8 m`, `−π … π rad, periodic`, or the values of a discrete one."""
    if not isinstance(part, Control) and part.kind is Kind.DISCRETE:
        return ", ".join(f"`{value}`" for value in part.values) or span(
            part.low, part.high, part.unit
        )
    text = span(part.low, part.high, part.unit)
    is_round = not isinstance(part, Control) and part.kind is Kind.PERIODIC
    return f"{text}, periodic" if is_round else text


def span(low: float, high: float, unit: Unit) -> str:
    """Two ends with one unit."""
    if unit.text == "rad" and _is_pi(low) and _is_pi(high):
        return f"{multiple_of_pi(low)} … {multiple_of_pi(high)} rad"
    if max(-low, high) > FAR:
        return f"any, in {unit_of(unit)}"
    return f"{number(low / unit.scale, DIGITS)} … {exact(high, unit)}"


def _is_pi(value: float) -> bool:
    return value == 0.0 or (multiple_of_pi(value) in {"π", "−π", "2π"} and abs(value) > 3.14159)


def unit_of(unit: Unit) -> str:
    """The unit as people write it; a number without one has a dash."""
    return NOTHING if unit.text in {"", "1"} else unit.text


def milliseconds(value: float) -> str:
    """A period or a delay."""
    if value == 0.0:
        return "0"
    return f"{number(value * 1e3, DIGITS)} ms" if value < 1.0 else f"{number(value, DIGITS)} s"


def listed(words: Iterable[str], nothing: str = NOTHING) -> str:
    """Words in one cell."""
    return ", ".join(words) or nothing
