"""Writes the table of common units from pint: `python -m spec_schema.unit_table`."""

import json

from spec_schema.pint_units import look_up
from spec_schema.unit_names import TABLE

PREFIXED: dict[str, str] = {
    "m": "n u µ m c d k",
    "s": "n u µ m",
    "g": "u m k",
    "A": "u m k",
    "K": "m",
    "mol": "m",
    "rad": "u m",
    "Hz": "m k M G",
    "N": "m k",
    "Pa": "h k M",
    "J": "m k M",
    "W": "m k M",
    "Wh": "m k",
    "Ah": "m",
    "V": "u m k",
    "C": "m",
    "F": "p n u m",
    "H": "u m",
    "T": "n u m",
    "bar": "m",
    "L": "m",
    "l": "m",
    "lx": "k",
    "ohm": "m k M",
    "S": "m",
}
"""Units that are common with prefixes, and with which ones."""

PLAIN = (
    "cd min h hr d deg ° arcmin arcsec turn revolution rpm rps mph kph knot "
    "ft in inch yd mile lb oz lbf psi atm hectare lux lm sr t % percent permille ppm "
    "meter meters metre metres millimeter millimeters centimeter centimeters kilometer kilometers "
    "second seconds sec millisecond milliseconds minute minutes hour hours day days hertz kilogram "
    "kilograms gram grams newton pascal joule watt volt ampere kelvin radian radians degree degrees"
)
"""Units that are common as they are."""


def as_text() -> str:
    """The table as JSON, a unit a line: SI scale, and exponents of m, kg, s, A, K, mol, cd."""
    lines = [f"{json.dumps(name, ensure_ascii=False)}: {_entry(name)}" for name in _names()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _names() -> list[str]:
    prefixed = {p + unit for unit, prefixes in PREFIXED.items() for p in ("", *prefixes.split())}
    return sorted(prefixed.union(PLAIN.split()))


def _entry(name: str) -> str:
    known = look_up(name)
    assert known is not None, f"pint knows no unit {name}"
    scale, exponents = known
    assert scale is not None, f"{name} is no multiple of an SI unit"
    assert all(exponent.is_integer() for exponent in exponents), f"{name} has a fractional power"
    return json.dumps([scale, [int(exponent) for exponent in exponents]])


if __name__ == "__main__":
    TABLE.write_text(as_text(), encoding="utf-8")
