"""What values an expression can take over a box: interval arithmetic, rounded outward.

Sound, not sharp: every computed number lies in the bounds, and a name that occurs twice may widen
them. A nan never counts as a value.
"""

import math
from collections.abc import Callable, Mapping

from spec_schema.expressions import interval
from spec_schema.expressions.interval import (
    Interval,
    around,
    clamped,
    hull,
    nothing,
    outward,
    restricted,
    rising,
)
from spec_schema.expressions.tree import Apply, Expr, Name, Number, fold, same

TOO_FAR = 1e8
"""Beyond this angle the place within a turn is not worth finding."""


def bounds(expr: Expr, box: Mapping[str, tuple[float, float]]) -> tuple[float, float]:
    """The least and the greatest value where each name lies in its interval of the box.

    (nan, nan) where the expression is a number nowhere; texts must be resolved.

    >>> from spec_schema.expressions.parse import parse
    >>> low, high = bounds(parse("x**2 - 1"), {"x": (-1.0, 2.0)})
    >>> round(low, 12), round(high, 12)
    (-1.0, 3.0)
    """
    found = interval_of(expr, box)
    return (math.nan, math.nan) if found.is_empty else (found.low, found.high)


def interval_of(expr: Expr, box: Mapping[str, tuple[float, float]]) -> Interval:
    """What `bounds` says, and whether the value may be nan."""

    def visit(node: Expr, operands: tuple[Interval, ...]) -> Interval:
        match node:
            case Number(value=value):
                return Interval(value, value)
            case Name(name=name):
                return Interval(*box[name])
            case Apply(op="mul", operands=(a, b)) if same(a, b):
                return interval.power(operands[0], Interval(2.0, 2.0))
            case Apply(op=op) if op in TRUTH:
                return TRUTH[op](*operands)
            case Apply(op=op):
                empty = any(part.is_empty for part in operands) and op not in {"pow", "hypot"}
                return nothing() if empty else OPERATIONS[op](*operands)
        raise AssertionError("texts are resolved before an expression is bounded")

    return fold(expr, visit)


NO, YES, MAYBE = Interval(0.0, 0.0), Interval(1.0, 1.0), Interval(0.0, 1.0)


def _decided(*, can_be: bool, can_fail: bool) -> Interval:
    if can_be and can_fail:
        return MAYBE
    return YES if can_be else NO


def _less(a: Interval, b: Interval) -> Interval:
    """Whether a < b; nan is less than nothing."""
    never = a.is_empty or b.is_empty or a.low >= b.high
    always = a.high < b.low and not a.nan and not b.nan
    return _decided(can_be=not never, can_fail=not always)


def _at_most(a: Interval, b: Interval) -> Interval:
    never = a.is_empty or b.is_empty or a.low > b.high
    always = a.high <= b.low and not a.nan and not b.nan
    return _decided(can_be=not never, can_fail=not always)


def _equal(a: Interval, b: Interval) -> Interval:
    never = a.is_empty or b.is_empty or a.low > b.high or b.low > a.high
    always = a.low == a.high == b.low == b.high and not a.nan and not b.nan
    return _decided(can_be=not never, can_fail=not always)


def _can_be_true(a: Interval) -> bool:
    """Every number but 0 is true, and so is nan."""
    return a.nan or (not a.is_empty and (a.low != 0 or a.high != 0))


def _can_be_false(a: Interval) -> bool:
    return 0.0 in a


def _and(a: Interval, b: Interval) -> Interval:
    return _decided(
        can_be=_can_be_true(a) and _can_be_true(b), can_fail=_can_be_false(a) or _can_be_false(b)
    )


def _not(a: Interval) -> Interval:
    return _decided(can_be=_can_be_false(a), can_fail=_can_be_true(a))


def _or(a: Interval, b: Interval) -> Interval:
    return _not(_and(_not(a), _not(b)))


def _where(condition: Interval, a: Interval, b: Interval) -> Interval:
    chosen = [a] * _can_be_true(condition) + [b] * _can_be_false(condition)
    return hull(chosen)


TRUTH: dict[str, Callable[..., Interval]] = {
    "lt": _less,
    "gt": lambda a, b: _less(b, a),
    "le": _at_most,
    "ge": lambda a, b: _at_most(b, a),
    "eq": _equal,
    "ne": lambda a, b: _not(_equal(a, b)),
    "and": _and,
    "or": _or,
    "not": _not,
    "where": _where,
}
"""What also has a value where an operand has none."""


def _reaches(a: Interval, phase: float) -> bool:
    """Whether phase + 2 k pi is in the interval (or so near that rounding can't tell)."""
    slack = 1e-12 * max(1.0, abs(a.low), abs(a.high))
    first = math.ceil((a.low - slack - phase) / math.tau)
    return first <= math.floor((a.high + slack - phase) / math.tau)


def _waving(function: Callable[[float], float], top: float) -> Callable[[Interval], Interval]:
    """`sin` or `cos`, whose maxima stand at top + 2 k pi, its minima half a turn further."""

    def on_interval(a: Interval) -> Interval:
        if max(-a.low, a.high) > TOO_FAR:
            return Interval(-1.0, 1.0, a.nan or a.is_unbounded)
        values = [function(a.low), function(a.high)]
        values += [1.0] * _reaches(a, top) + [-1.0] * _reaches(a, top + math.pi)
        return clamped(around(values, ulps=4, nan=a.nan), -1.0, 1.0)

    return on_interval


def _tangent(a: Interval) -> Interval:
    poles = (math.pi / 2, -math.pi / 2)
    if max(-a.low, a.high) > TOO_FAR or any(_reaches(a, pole) for pole in poles):
        return Interval(-math.inf, math.inf, a.nan or a.is_unbounded)
    return rising(math.tan)(a)


def _wrapped(a: Interval) -> Interval:
    if -math.pi < a.low and a.high <= math.pi:
        return a
    nan = a.nan or a.is_unbounded
    if nan or max(-a.low, a.high) > TOO_FAR or _reaches(a, math.pi):
        return Interval(-math.pi, math.pi, nan)
    ends = (math.remainder(a.low, math.tau), math.remainder(a.high, math.tau))
    return Interval(*ends, a.nan)


def _angle(y: Interval, x: Interval) -> Interval:
    """Without the cut (y = 0, x < 0) and the origin the corners hold the extremes."""
    nan = y.nan or x.nan
    if 0.0 in y and x.low <= 0:
        return outward(-math.pi, math.pi, ulps=1, nan=nan)
    corners = (math.atan2(v, u) for v in (y.low, y.high) for u in (x.low, x.high))
    return around(corners, ulps=4, nan=nan)


def _hypot(a: Interval, b: Interval) -> Interval:
    if a.is_empty or b.is_empty:
        # hypot(nan, inf) is inf, with any other number nan.
        other = b if a.is_empty else a
        infinite = other.is_unbounded and not other.is_empty
        return Interval(math.inf, math.inf, nan=True) if infinite else nothing()
    a, b = interval.absolute(a), interval.absolute(b)
    ends = (math.hypot(a.low, b.low), math.hypot(a.high, b.high))
    return clamped(outward(*ends, ulps=4, nan=a.nan or b.nan), 0.0, math.inf)


def _log(a: Interval) -> Interval:
    return rising(lambda x: math.log(x) if x > 0 else -math.inf)(a)


def _cosh(a: Interval) -> Interval:
    return clamped(rising(math.cosh)(interval.absolute(a)), 1.0, math.inf)


def _acos(a: Interval) -> Interval:
    return outward(math.acos(a.high), math.acos(a.low), ulps=4, nan=a.nan)


def _clip(a: Interval, low: Interval, high: Interval) -> Interval:
    return interval.smaller(interval.larger(a, low), high)


def _sign(a: Interval) -> Interval:
    return Interval(float((a.low > 0) - (a.low < 0)), float((a.high > 0) - (a.high < 0)), a.nan)


def _floor(a: Interval) -> Interval:
    low, high = (x if math.isinf(x) else float(math.floor(x)) for x in (a.low, a.high))
    return Interval(low, high, a.nan)


def _inside(
    function: Callable[[Interval], Interval], low: float, high: float
) -> Callable[[Interval], Interval]:
    """A function with a domain: what lies outside of it gives nan."""

    def on_interval(a: Interval) -> Interval:
        inside = restricted(a, low, high)
        return inside if inside.is_empty else function(inside)

    return on_interval


OPERATIONS: dict[str, Callable[..., Interval]] = {
    "add": interval.add,
    "sub": interval.subtract,
    "mul": interval.multiply,
    "div": interval.divide,
    "mod": interval.modulo,
    "pow": interval.power,
    "neg": interval.negate,
    "abs": interval.absolute,
    "min": interval.smaller,
    "max": interval.larger,
    "clip": _clip,
    "hypot": _hypot,
    "atan2": _angle,
    "sign": _sign,
    "floor": _floor,
    "wrap": _wrapped,
    "sqrt": _inside(lambda a: clamped(rising(math.sqrt)(a), 0.0, math.inf), 0.0, math.inf),
    "exp": lambda a: clamped(rising(math.exp)(a), 0.0, math.inf),
    "log": _inside(_log, 0.0, math.inf),
    "sin": _waving(math.sin, math.pi / 2),
    "cos": _waving(math.cos, 0.0),
    "tan": _tangent,
    "asin": _inside(rising(math.asin), -1.0, 1.0),
    "acos": _inside(_acos, -1.0, 1.0),
    "atan": rising(math.atan),
    "sinh": rising(math.sinh),
    "cosh": _cosh,
    "tanh": rising(math.tanh),
}
"""What has a value only where every operand has one (`pow` and `hypot` know their exceptions)."""
