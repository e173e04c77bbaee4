"""Building operations from simplified operands: the few laws that are safe on doubles.

Every law keeps the value to rounding wherever the unsimplified operation is finite. `0*x = 0`,
`x - x = 0` and `0/x = 0` hold for the finite, non-zero x at which the left side is a number.
Laws that could turn a nan or an infinity of a finite x into a number (`x/x = 1`) are left out.
"""

import math
from collections.abc import Callable

from spec_schema.expressions.evaluate import operate
from spec_schema.expressions.tree import Apply, Expr, Number, same

ZERO = Number(0.0)
ONE = Number(1.0)


def build(op: str, *operands: Expr) -> Expr:
    """The operation on simplified operands, simplified."""
    numbers = [part.value for part in operands if isinstance(part, Number)]
    if len(numbers) == len(operands):
        value = operate(op, *numbers)
        if math.isfinite(value):
            return Number(value)
    law = LAWS.get(op)
    found = law(*operands) if law else None
    return Apply(op, operands) if found is None else found


def is_number(expr: Expr, value: float) -> bool:
    """Whether the expression is this literal."""
    return isinstance(expr, Number) and expr.value == value


def _negated(expr: Expr) -> Expr | None:
    """`x` where the expression is `-x` (or a negative literal), else None."""
    if isinstance(expr, Number) and expr.value < 0:
        return Number(-expr.value)
    return expr.operands[0] if isinstance(expr, Apply) and expr.op == "neg" else None


def _sum(a: Expr, b: Expr) -> Expr | None:
    if is_number(a, 0.0):
        return b
    if is_number(b, 0.0):
        return a
    if (positive := _negated(b)) is not None:
        return build("sub", a, positive)
    if isinstance(a, Apply) and (positive := _negated(a)) is not None:
        return build("sub", b, positive)
    return None


def _difference(a: Expr, b: Expr) -> Expr | None:
    if is_number(b, 0.0):
        return a
    if is_number(a, 0.0):
        return build("neg", b)
    if (positive := _negated(b)) is not None:
        return build("add", a, positive)
    return ZERO if same(a, b) else None


def _product(a: Expr, b: Expr) -> Expr | None:
    if isinstance(b, Number) and not isinstance(a, Number):
        return build("mul", b, a)
    if isinstance(a, Number):
        return _multiple(a.value, b)
    for factor, other in ((a, b), (b, a)):
        if isinstance(factor, Apply) and factor.op == "neg":
            return build("neg", build("mul", factor.operands[0], other))
        if (scaled := _scaled(factor)) is not None:
            return build("mul", Number(scaled[0]), build("mul", scaled[1], other))
    return _merged(a, b)


def _multiple(factor: float, b: Expr) -> Expr | None:
    if factor == 0.0:
        return ZERO
    if factor == 1.0:
        return b
    if factor == -1.0:
        return build("neg", b)
    if isinstance(b, Apply) and b.op == "neg":
        return build("mul", Number(-factor), b.operands[0])
    if (scaled := _scaled(b)) is not None and _is_normal(factor * scaled[0]):
        return build("mul", Number(factor * scaled[0]), scaled[1])
    return None


def _scaled(expr: Expr) -> tuple[float, Expr] | None:
    """(c, x) where the expression is `c*x` with a literal c."""
    if isinstance(expr, Apply) and expr.op == "mul" and isinstance(expr.operands[0], Number):
        return expr.operands[0].value, expr.operands[1]
    return None


def _is_normal(value: float) -> bool:
    """Whether folding into this literal loses no digits to overflow or underflow."""
    return 1e-300 < abs(value) < 1e300


def _merged(a: Expr, b: Expr) -> Expr | None:
    """x**m * x**n = x**(m + n) for whole m, n > 0."""
    (base, m), (other, n) = _whole_power(a), _whole_power(b)
    return build("pow", base, Number(m + n)) if same(base, other) else None


def _whole_power(expr: Expr) -> tuple[Expr, float]:
    if isinstance(expr, Apply) and expr.op == "pow":
        base, exponent = expr.operands
        if isinstance(exponent, Number) and exponent.value.is_integer() and exponent.value > 0:
            return base, exponent.value
    return expr, 1.0


def _quotient(a: Expr, b: Expr) -> Expr | None:
    if is_number(b, 1.0):
        return a
    if is_number(a, 0.0):
        return None if is_number(b, 0.0) else ZERO
    if isinstance(a, Apply) and a.op == "neg":
        return build("neg", build("div", a.operands[0], b))
    if isinstance(b, Apply) and b.op == "neg":
        return build("neg", build("div", a, b.operands[0]))
    scaled = _scaled(a)
    if scaled and isinstance(b, Number) and b.value and _is_normal(scaled[0] / b.value):
        return build("mul", Number(scaled[0] / b.value), scaled[1])
    return None


def _power(a: Expr, b: Expr) -> Expr | None:
    if is_number(b, 1.0):
        return a
    if is_number(b, 0.0) or is_number(a, 1.0):
        return ONE
    base, m = _whole_power(a)
    if m > 1 and isinstance(b, Number) and b.value.is_integer() and b.value > 0:
        return Apply("pow", (base, Number(m * b.value)))
    return None


def _opposite(a: Expr) -> Expr | None:
    if isinstance(a, Apply) and a.op == "neg":
        return a.operands[0]
    if isinstance(a, Apply) and a.op == "sub":
        return build("sub", a.operands[1], a.operands[0])
    if (scaled := _scaled(a)) is not None:
        return build("mul", Number(-scaled[0]), scaled[1])
    return None


def _choice(condition: Expr, a: Expr, b: Expr) -> Expr | None:
    if isinstance(condition, Number):
        return a if condition.value != 0 else b
    return a if same(a, b) else None


def _absolute(a: Expr) -> Expr | None:
    if isinstance(a, Apply) and a.op == "neg":
        return build("abs", a.operands[0])
    return a if isinstance(a, Apply) and a.op == "abs" else None


def _extreme(a: Expr, b: Expr) -> Expr | None:
    return a if same(a, b) else None


LAWS: dict[str, Callable[..., Expr | None]] = {
    "add": _sum,
    "sub": _difference,
    "mul": _product,
    "div": _quotient,
    "pow": _power,
    "neg": _opposite,
    "where": _choice,
    "abs": _absolute,
    "min": _extreme,
    "max": _extreme,
}
"""What an operation is by law, or None where no law applies."""
