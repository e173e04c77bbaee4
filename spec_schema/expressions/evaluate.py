"""The value of an expression in plain Python: slow, exact to the meaning in `tree.py`."""

import math
from collections.abc import Callable, Mapping

from spec_schema.expressions.tree import Apply, Expr, Name, Number, fold


def evaluate(expr: Expr, values: Mapping[str, float]) -> float:
    """The value where the names have `values` (KeyError for one that has none).

    >>> from spec_schema.expressions.parse import parse
    >>> evaluate(parse("where(x > 0, 2*x, 1/0)"), {"x": 3.0})
    6.0
    """

    def value_of(node: Expr, operands: tuple[float, ...]) -> float:
        match node:
            case Number(value=value):
                return value
            case Name(name=name):
                return values[name]
            case Apply(op=op):
                return operate(op, *operands)
        raise AssertionError("texts are resolved before an expression is evaluated")

    return fold(expr, value_of)


def operate(op: str, *operands: float) -> float:
    """One operation on doubles; IEEE where Python would raise."""
    if any(map(math.isnan, operands)) and op not in WITH_NAN:
        return math.nan
    return OPERATIONS[op](*operands)


def _divide(a: float, b: float) -> float:
    if b:
        return a / b
    return math.nan if a == 0 else math.copysign(math.inf, a) * math.copysign(1.0, b)


def _modulo(a: float, b: float) -> float:
    return math.nan if b == 0 or math.isinf(a) else a % b


def _power(a: float, b: float) -> float:
    try:
        return math.pow(a, b)
    except ValueError:
        if a != 0:
            return math.nan
        return math.copysign(math.inf, a) if b % 2 == 1 else math.inf
    except OverflowError:
        return -math.inf if a < 0 and b % 2 == 1 else math.inf


def _wrap(angle: float) -> float:
    if math.isinf(angle):
        return math.nan
    rest = math.remainder(angle, math.tau)
    return math.pi if rest <= -math.pi else rest


def _sign(a: float) -> float:
    return float((a > 0) - (a < 0))


def _log(a: float) -> float:
    if a == 0:
        return -math.inf
    return math.log(a) if a > 0 else math.nan


def _floor(a: float) -> float:
    return a if math.isinf(a) else float(math.floor(a))


def _larger(a: float, b: float) -> float:
    return max(b, a)


def _smaller(a: float, b: float) -> float:
    return min(b, a)


def _within(function: Callable[[float], float]) -> Callable[[float], float]:
    """The function of math.h, nan outside its domain."""

    def value(a: float) -> float:
        try:
            return function(a)
        except ValueError:
            return math.nan
        except OverflowError:
            return function(math.copysign(1.0, a)) * math.inf

    return value


WITH_NAN = frozenset({"lt", "le", "gt", "ge", "eq", "ne", "and", "or", "not", "where"}) | {
    "pow",
    "hypot",
}
"""What decides itself what a nan becomes: nan**0 = 1**nan = 1, hypot(inf, nan) = inf."""

OPERATIONS: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": _divide,
    "mod": _modulo,
    "pow": _power,
    "neg": lambda a: -a,
    "lt": lambda a, b: float(a < b),
    "le": lambda a, b: float(a <= b),
    "gt": lambda a, b: float(a > b),
    "ge": lambda a, b: float(a >= b),
    "eq": lambda a, b: float(a == b),
    "ne": lambda a, b: float(a != b),
    "and": lambda a, b: float(a != 0 and b != 0),
    "or": lambda a, b: float(a != 0 or b != 0),
    "not": lambda a: float(a == 0),
    "where": lambda condition, a, b: a if condition != 0 else b,
    "abs": abs,
    "sign": _sign,
    "min": _smaller,
    "max": _larger,
    "clip": lambda a, low, high: _smaller(_larger(a, low), high),
    "hypot": math.hypot,
    "atan2": math.atan2,
    "floor": _floor,
    "wrap": _wrap,
    "log": _log,
    "sqrt": _within(math.sqrt),
    "exp": _within(math.exp),
    "sin": _within(math.sin),
    "cos": _within(math.cos),
    "tan": _within(math.tan),
    "asin": _within(math.asin),
    "acos": _within(math.acos),
    "atan": math.atan,
    "sinh": _within(math.sinh),
    "cosh": _within(math.cosh),
    "tanh": math.tanh,
}
"""What each operation of `ARITY` does. The order of operands is that of the call."""
