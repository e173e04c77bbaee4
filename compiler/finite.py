"""Whether a formula is finite, as far as that can be told without tables.

A table begins with a few nodes on each axis. Those on the edges of the box are looked at here, of
the same sums of terms that become tables. Compiling looks at many more places.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.ranges import Range, range_of
from compiler.references import MOST_AXES
from compiler.terms import TooManyCasesError, summands
from spec_schema.behavior import BehaviorSpec
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.rewrite import names_in, simplify, substitute
from spec_schema.expressions.tree import Expr, Number
from spec_schema.field_forms import Formula, Step
from spec_schema.field_modes import Modes

NODES: Final = 5
"""On an axis, its ends among them, as the coarsest table has them."""
REMEDY: Final = (
    "shrink the domain so that it leaves this place out, or guard the expression with "
    "`where(...)` or `max(...)`"
)


def check_finite(
    spec: BehaviorSpec, declared: Declarations, rates: Mapping[str, Expr], findings: Findings
) -> None:
    """A finding where a formula that is to be tabulated is seen not to be finite."""
    if spec.table.keep != "tables" or not isinstance(spec.field.form, Formula | Step | Modes):
        return
    place = next(
        (
            found
            for state in declared.driven
            for part in _parts(rates[state.name], declared)
            if (found := _place(part, declared)) is not None
        ),
        None,
    )
    if place is not None:
        message = not_finite(list(place), list(place.values()))
        findings.error("S243", ("field",), message, REMEDY, key=True)


def not_finite(names: Sequence[str], values: Sequence[float]) -> str:
    """The sentence on a place where a field is not finite.

    >>> not_finite(["x"], [-1.0])
    'the field is not finite at x = -1 (SI units)'
    """
    at = ", ".join(f"{name} = {value:.6g}" for name, value in zip(names, values, strict=True))
    return f"the field is not finite at {at} (SI units)"


def _parts(rate: Expr, declared: Declarations) -> Iterator[Expr]:
    """What of a rate becomes tables; nothing where that can't be told, which compiling tells."""
    discrete = {name: len(values) for name, values in declared.values.items()}
    constants: dict[str, Expr] = {c.name: Number(c.value) for c in declared.constants}
    try:
        found = summands(rate, declared.continuous, discrete)
    except TooManyCasesError:
        return
    for summand in found:
        yield simplify(substitute(summand.part, constants))


def _place(part: Expr, declared: Declarations) -> dict[str, float] | None:
    """A place on the edges of the box where the part is not finite; None where none is seen."""
    over = [v.name for v in declared.variables if v.name in names_in(part)]
    ranges = [range_of(name, declared) for name in over]
    if not over or len(over) > MOST_AXES:
        return None
    for values in _on_edges(ranges):
        place = dict(zip(over, values, strict=True))
        if not math.isfinite(evaluate(part, place)):
            return place
    return None


def _on_edges(ranges: Sequence[Range]) -> Iterator[tuple[float, ...]]:
    """The first nodes of each axis, where all the others are at an end."""
    ends = [(r.low, r.high) for r in ranges]
    for i, along in enumerate(ranges):
        inner = [along.low + k * (along.high - along.low) / (NODES - 1) for k in range(NODES)]
        yield from product(*(inner if i == j else end for j, end in enumerate(ends)))
