"""The unit of a part of a formula, worked out from those of its names.

Angles have no dimension, so `1/s^2` times `rad` could be called either: where the part is of the
rate's dimension it is told in the rate's unit, else in that of a name in it of the same dimension.
"""

from collections.abc import Mapping
from fractions import Fraction
from typing import Final

from runtime.program import Program, Unit
from spec_schema.dimension import DIMENSIONLESS, Dimension, describe, power, product, quotient
from spec_schema.units import parse_unit
from verifier.diagnosis.wraps import Tree, Wrap, tree_of
from verifier.fidelity.stretches.needs import parts_of

ALIKE: Final = frozenset({"add", "sub", "neg", "abs", "min", "max", "clip", "mod"})
"""What these give is in the unit of what they are given."""


def per_second(unit: Unit) -> Unit:
    """The unit of the rate of something that is in `unit`.

    >>> [per_second(Unit(text, 1.0)).text for text in ("m", "m/s", "1")]
    ['m/s', 'm/s^2', '1/s']
    """
    text = unit.text or "1"
    return Unit(f"{text}^2" if text.endswith("/s") else f"{text}/s", unit.scale)


def unit_of(wrap: Wrap, program: Program) -> Unit:
    """The unit in which people read a part of the rate of `wrap.name`."""
    units = {name: part.unit for name, part in parts_of(program).items()}
    units |= {constant.name: constant.unit for constant in program.constants}
    rate = per_second(units[wrap.name])
    if wrap.is_whole:
        return rate
    found = _dimension(tree_of(wrap.code), units)
    named = (units[token] for token in wrap.code.tokens if token in units)
    same = (unit for unit in (rate, *named) if _of_unit(unit) == found)
    return next(same, Unit(describe(found), 1.0))


def _dimension(tree: Tree, units: Mapping[str, Unit]) -> Dimension:
    """Of functions none, as of a sine."""
    name, operands = tree
    if name in units:
        return _of_unit(units[name])
    below = [_dimension(each, units) for each in operands]
    if name == "mul":
        return product(*below)
    if name == "div":
        return quotient(*below)
    if name == "pow" and operands[1][0] not in units and not operands[1][1]:
        return power(below[0], Fraction(operands[1][0]))
    if name in ALIKE:
        return next((each for each in below if each != DIMENSIONLESS), DIMENSIONLESS)
    return DIMENSIONLESS


def _of_unit(unit: Unit) -> Dimension:
    return parse_unit(unit.text or "1").dimension
