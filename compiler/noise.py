"""The noise of a behavior: how far chance moves its driven states, as expressions in SI."""

from collections.abc import Mapping

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.quantities import si_value
from compiler.scope import Scope, checked
from runtime.code import Code
from runtime.program import Noise
from spec_schema.behavior import BehaviorSpec
from spec_schema.expressions.parse import parse
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr, Number
from spec_schema.faults import ExpressionError
from spec_schema.load import Loaded
from spec_schema.suggest import did_you_mean, there_are


def read_noise(
    spec: BehaviorSpec, declared: Declarations, scope: Scope, findings: Findings
) -> dict[str, Expr]:
    """The trees of the sizes, by state: a number or quantity is a literal in SI."""
    driven = [state.name for state in declared.driven]
    found: dict[str, Expr] = {}
    for name, size in spec.noise.items():
        if name not in driven:
            remedy = did_you_mean(name, driven) or there_are(driven)
            message = f"'{name}' is no driven state"
            findings.error("S208", ("noise", name), message, remedy, key=True)
            continue
        expr = _size(name, size, declared, scope, findings)
        if expr is not None:
            found[name] = expr
    return found


def lower_noise(noise: Mapping[str, Expr], loaded: Loaded) -> tuple[Noise, ...]:
    """The sizes as the machine runs them."""
    return tuple(
        Noise(name, Code(to_postfix(expr)), loaded.origin(("noise", name)))
        for name, expr in noise.items()
    )


def _size(
    name: str, size: float | str, declared: Declarations, scope: Scope, findings: Findings
) -> Expr | None:
    path, unit = ("noise", name), declared.units.get(name)
    if isinstance(size, str) and _reads_something(size):
        return checked(size, path, scope, unit, f"the noise of '{name}'", findings)
    value = si_value(size, unit, path, findings)
    if value is None:
        return None
    if value < 0.0:
        message = f"the noise of '{name}' is a standard deviation (got {size})"
        findings.error("S212", path, message, "write a number of 0 or more")
    return Number(value)


def _reads_something(text: str) -> bool:
    """Whether a text is an expression, and no quantity such as `20 deg`."""
    try:
        return bool(names_in(parse(text)))
    except ExpressionError:
        return not (text.strip()[:1].isdigit() or text.strip()[:1] in "+-.")
