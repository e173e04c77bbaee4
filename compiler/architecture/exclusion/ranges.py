"""What the numbers of a program can be over a box of its states and controls: computed ones.

Arithmetic is rounded outward (`spec_schema.expressions.bounds`), which holds for what the machine
computes: rounding never changes the order of two numbers, so what lies between two doubles is
rounded to a number between them.
"""

import math
from collections.abc import Mapping
from typing import Final, TypeAlias

from compiler.architecture.codes import tree_of
from compiler.architecture.exclusion.table_ranges import Ends, columns_over
from runtime.code import Code
from runtime.flow import Source, rate_of
from runtime.program import Program
from runtime.tape import Sum
from spec_schema.expressions import interval
from spec_schema.expressions.bounds import interval_of
from spec_schema.expressions.interval import Interval

Box: TypeAlias = Mapping[str, Ends]

LARGEST: Final = 1e300
"""What may be greater is taken as no number: it may overflow where it is added up, divided by a
period, or multiplied with a normal random number, which is below 40 in a double."""


def ends_of(code: Code, box: Box) -> Ends | None:
    """The least and the greatest value; None where it may be no finite number."""
    return _finite(interval_of(tree_of(code), box))


def rates_over(program: Program, box: Box) -> dict[str, Ends | None]:
    """The rate of each state that the field moves (of a map: its next value) over a box."""
    columns = _columns(program, box)
    return {
        state.name: _of_rate(rate_of(program, i, Source.TABLES), box, columns)
        for i, state in enumerate(program.states)
        if state.name in program.field.driven
    }


def jumps_over(program: Program, box: Box) -> dict[str, Ends | None]:
    """Where the states may jump to, at a change of the mode."""
    found: dict[str, Ends | None] = {}
    for guard in program.field.guards:
        for name, code in guard.resets:
            ends, before = ends_of(code, box), found.get(name, (math.inf, -math.inf))
            found[name] = None if ends is None or before is None else hull(before, ends)
    return found


def hull(one: Ends, other: Ends) -> Ends:
    """From the lower of the beginnings to the higher of the ends."""
    return min(one[0], other[0]), max(one[1], other[1])


def _columns(program: Program, box: Box) -> list[list[Ends]] | None:
    """Of each table what its columns may be; None where it may be looked up at no number."""
    known = dict(box)
    for coordinate in program.field.coordinates:
        ends = ends_of(coordinate.code, box)
        if ends is None:
            return None
        known[coordinate.name] = ends
    return [columns_over(table, known) for table in program.field.tables]


def _of_rate(rate: Code | Sum, box: Box, columns: list[list[Ends]] | None) -> Ends | None:
    if isinstance(rate, Code):
        return ends_of(rate, box)
    if columns is None:
        return None
    total = Interval(0.0, 0.0)
    for code, table, column in rate.parts:
        ends = ends_of(code, box)
        if ends is None:
            return None
        part = Interval(*ends)
        if table >= 0:
            part = interval.multiply(part, Interval(*columns[table][column]))
        total = interval.add(total, part)
    return _finite(total)


def _finite(found: Interval) -> Ends | None:
    if found.nan or found.is_empty or max(-found.low, found.high) > LARGEST:
        return None
    return found.low, found.high
