"""Rules that leave as soon as they hold: their `until` holds wherever their `when` does."""

from typing import Final

import numpy as np

from compiler.declare import Declarations
from compiler.findings import Findings
from runtime.program import Kind, State
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.tree import Expr
from spec_schema.places import Path

POINTS: Final = 400
SEED: Final = 20261122


def check_leaving(
    when: Expr, until: Expr, path: Path, declared: Declarations, findings: Findings
) -> None:
    """A warning where at none of the points at which a rule holds it would go on.

    The points are all over the domains of what is read, and the same every time.
    """
    held = [point for point in _points(declared) if evaluate(when, point)]
    if held and all(evaluate(until, point) for point in held):
        message = "the rule leaves as soon as it holds: its 'until' holds wherever its 'when' does"
        remedy = "turn the comparison of 'until' round, or say with 'lasts' for how long it goes on"
        findings.warning("S329", (*path, "until"), message, remedy)


def _points(declared: Declarations) -> list[dict[str, float]]:
    random = np.random.Generator(np.random.Philox(SEED))
    columns = {
        variable.name: np.round(drawn) if _is_discrete(variable) else drawn
        for variable in declared.variables
        for drawn in [random.uniform(variable.low, variable.high, POINTS)]
    }
    fixed = {constant.name: constant.value for constant in declared.constants}
    return [
        fixed | {name: float(column[i]) for name, column in columns.items()} for i in range(POINTS)
    ]


def _is_discrete(variable: object) -> bool:
    return isinstance(variable, State) and variable.kind is Kind.DISCRETE
