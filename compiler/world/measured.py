"""Measures that are numbers and yet say nothing: of angles that wrap, of values by name."""

from collections.abc import Iterator, Mapping
from typing import Final

from compiler.findings import Findings
from compiler.requirement import Measured
from runtime.training import How
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name
from spec_schema.places import Path

TAKES_ANGLES: Final = frozenset({"sin", "cos", "tan", "wrap", "abs", *COMPARISONS})
"""What makes a number of an angle that does not jump where the angle wraps."""
DIFFERS: Final = frozenset({How.RISE, How.FALL, How.MEAN})
"""What a jump is seen in."""


def check_measured(
    expr: Expr, how: How, path: Path, known: Mapping[str, Measured], findings: Findings
) -> None:
    """A warning for each quantity whose number means nothing here."""
    for name in dict.fromkeys(_bare(expr)):
        one = known.get(name)
        if one is None:
            continue
        if one.is_periodic and how in DIFFERS:
            message = f"'{name}' jumps by a full turn where it wraps, and so would this measure"
            remedy = f"measure e.g. `abs(wrap({name} - 90 deg))`"
            findings.warning("S395", path, message, remedy)
        elif one.values:
            message = f"'{name}' is one of {', '.join(one.values)}: its number means nothing"
            remedy = f"compare it: `{name} == '{one.values[0]}'`"
            findings.warning("S395", path, message, remedy)


def _bare(expr: Expr) -> Iterator[str]:
    """The names that stand outside comparisons and functions of angles."""
    waiting = [expr]
    while waiting:
        node = waiting.pop()
        if isinstance(node, Name):
            yield node.name
        elif isinstance(node, Apply) and node.op not in TAKES_ANGLES:
            waiting.extend(reversed(node.operands))
