"""What one unit's name means: by the committed table, and by pint for a name that it lacks."""

import importlib
import json
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import TypeAlias

from spec_schema.dimension import Dimension

Meaning: TypeAlias = tuple[float | None, Dimension]
"""SI scale and dimension. No scale: no plain multiple of an SI unit (degrees Celsius)."""

TABLE = Path(__file__).with_name("units_table.json")


def meaning(name: str) -> Meaning | None:
    """What the name means, or None where no unit has it."""
    known = table().get(name.replace("μ", "µ"))  # Greek mu for the micro sign
    if known is None:
        # pint costs half a second to load, and a spec rarely needs a unit that the table lacks.
        known = importlib.import_module("spec_schema.pint_units").look_up(name)
    if known is None:
        return None
    scale, exponents = known
    return scale, tuple(map(Fraction, exponents))


@cache
def table() -> dict[str, tuple[float, list[int]]]:
    """The table of common units: SI scale, and exponents of m, kg, s, A, K, mol, cd."""
    loaded: dict[str, tuple[float, list[int]]] = json.loads(TABLE.read_text(encoding="utf-8"))
    return loaded
