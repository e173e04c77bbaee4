"""The axes of tables to be: intervals of variables."""

from dataclasses import dataclass
from typing import final

from compiler.declare import Declarations
from runtime.arrays import Array, frozen
from runtime.program import Kind, State


@final
@dataclass(frozen=True, slots=True)
class Range:
    """An axis to be: the interval of a variable, and a node count where the user fixed one."""

    name: str
    low: float
    high: float
    periodic: bool
    fixed: int | None = None


def range_of(name: str, declared: Declarations, fixed: int | None = None) -> Range:
    """The axis of a table over the variable."""
    part = declared.variable(name)
    periodic = isinstance(part, State) and part.kind is Kind.PERIODIC
    return Range(name, part.low, part.high, periodic, fixed)


def scales(names: tuple[str, ...], declared: Declarations) -> Array:
    """What one of each variable's own unit is in SI (k,)."""
    return frozen([declared.variable(name).unit.scale for name in names])
