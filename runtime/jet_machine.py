"""The machine over boxes: runs postfix code on jets, operation by operation as the machine does."""

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np

from runtime.arrays import Booleans
from runtime.code import ARITY, Code
from runtime.intervals import (
    LOOSE,
    Interval,
    Real,
    add,
    chosen,
    cosine,
    even_rising,
    exactly,
    holds_zero,
    inverse,
    is_zero,
    magnitude,
    multiply,
    negative,
    outward,
    rising,
    root,
    sine,
    square,
    subtract,
    within,
)
from runtime.jets import (
    EITHER,
    NOTHING,
    ONE,
    SURE,
    UNBOUNDED,
    Jet,
    composed,
    constant,
    jet_choice,
    jet_difference,
    jet_maximum,
    jet_minimum,
    jet_product,
    jet_quotient,
    jet_sum,
    stepwise,
    unbounded,
)

LARGEST_POWER: Final = 64.0
"""Whole powers up to it are powers, others go through the logarithm."""


def run_over_boxes(codes: Sequence[Code], register: Mapping[str, Jet]) -> list[Jet]:
    """The jets of `codes`, where the entries of the register have the jets `register`.

    Equal parts of the codes are worked out once.
    """
    known: dict[tuple[str, ...], Jet] = {}
    with np.errstate(all="ignore"):
        return [_run(code, register, known) for code in codes]


def _run(code: Code, register: Mapping[str, Jet], known: dict[tuple[str, ...], Jet]) -> Jet:
    stack: list[tuple[str, Jet]] = []
    for token in code.tokens:
        arity = ARITY.get(token, 0)
        operands = stack[len(stack) - arity :]
        del stack[len(stack) - arity :]
        key = (token, *(name for name, _ in operands))
        if key not in known:
            known[key] = _applied(token, [jet for _, jet in operands], register)
        stack.append((str(id(known[key])), known[key]))
    ((_, result),) = stack
    return result


def _applied(token: str, operands: list[Jet], register: Mapping[str, Jet]) -> Jet:
    if token in OPERATIONS:
        return OPERATIONS[token](*operands)
    if token in register:
        return register[token]
    return constant(_literal(float(token)))


def _literal(value: float) -> Interval:
    return exactly(value)


def _negated(a: Jet) -> Jet:
    return Jet(negative(a.value), None if a.slopes is None else negative(a.slopes), a.sure)


def _size(a: Jet) -> Jet:
    low, high = a.value.low, a.value.high
    slope = Interval(np.where(low >= 0.0, 1.0, -1.0), np.where(high <= 0.0, -1.0, 1.0))
    slope = chosen(is_zero(a.value), Interval(np.asarray(-1.0), np.asarray(1.0)), slope)
    return composed(magnitude(a.value), slope, a)


def _sign(a: Jet) -> Jet:
    value = Interval(np.sign(a.value.low), np.sign(a.value.high))
    return stepwise(value, np.asarray(value.low == value.high), a)


def _clipped(a: Jet, low: Jet, high: Jet) -> Jet:
    return jet_minimum(jet_maximum(a, low), high)


def _root(a: Jet) -> Jet:
    value = root(a.value)
    return composed(value, inverse(add(value, value)), a, np.asarray(a.value.low >= 0.0))


def _hypotenuse(a: Jet, b: Jet) -> Jet:
    value = root(add(square(a.value), square(b.value)))
    over = inverse(value)
    to_a, to_b = (within(multiply(one.value, over), -1.0, 1.0) for one in (a, b))
    sum_ = jet_sum(composed(value, to_a, a), composed(NOTHING, to_b, b))
    return Jet(value, sum_.slopes, sum_.sure)


def _exponential(a: Jet) -> Jet:
    value = rising(np.exp, a.value)
    value = Interval(np.maximum(value.low, 0.0), value.high)
    return composed(value, value, a)


def _logarithm(a: Jet) -> Jet:
    positive = within(a.value, 0.0, np.inf)
    sure = np.asarray(a.value.low > 0.0)
    return composed(rising(np.log, positive), inverse(positive), a, sure)


def _sine(a: Jet) -> Jet:
    return composed(sine(a.value), cosine(a.value), a)


def _cosine(a: Jet) -> Jet:
    return composed(cosine(a.value), negative(sine(a.value)), a)


def _tangent(a: Jet) -> Jet:
    return jet_quotient(_sine(a), _cosine(a))


def _arc_sine(a: Jet) -> Jet:
    inside = within(a.value, -1.0, 1.0)
    return composed(rising(np.arcsin, inside), _steep(inside), a, _in_unit(a))


def _arc_cosine(a: Jet) -> Jet:
    inside = within(a.value, -1.0, 1.0)
    falling = negative(rising(lambda x: -np.arccos(x), inside))
    return composed(falling, negative(_steep(inside)), a, _in_unit(a))


def _steep(a: Interval) -> Interval:
    return inverse(root(subtract(ONE, square(a))))


def _in_unit(a: Jet) -> Booleans:
    return np.asarray((a.value.low >= -1.0) & (a.value.high <= 1.0))


def _arc_tangent(a: Jet) -> Jet:
    return composed(rising(np.arctan, a.value), inverse(add(ONE, square(a.value))), a)


def _arc_tangent_2(y: Jet, x: Jet) -> Jet:
    """The angle of (x, y): on a box beside the cut its extremes lie at the corners."""
    a, b = y.value, x.value
    corners = [np.arctan2(v, u) for v in (a.low, a.high) for u in (b.low, b.high)]
    low, high = np.minimum.reduce(corners), np.maximum.reduce(corners)
    value = outward(low - LOOSE * np.abs(low), high + LOOSE * np.abs(high))
    cut = holds_zero(a) & (b.low <= 0.0)
    turn = Interval(np.asarray(-np.pi - 1e-15), np.asarray(np.pi + 1e-15))
    value = chosen(cut, turn, value)
    over = inverse(add(square(a), square(b)))
    by_y, by_x = multiply(b, over), negative(multiply(a, over))
    both = jet_sum(composed(NOTHING, by_y, y), composed(NOTHING, by_x, x))
    slopes = None if both.slopes is None else unbounded(both.slopes, cut)
    return Jet(value, slopes, both.sure)


def _hyperbolic_sine(a: Jet) -> Jet:
    return composed(rising(np.sinh, a.value), even_rising(np.cosh, a.value), a)


def _hyperbolic_cosine(a: Jet) -> Jet:
    return composed(even_rising(np.cosh, a.value), rising(np.sinh, a.value), a)


def _hyperbolic_tangent(a: Jet) -> Jet:
    value = rising(np.tanh, a.value)
    slope = subtract(ONE, square(within(value, -1.0, 1.0)))
    return composed(value, Interval(np.maximum(slope.low, 0.0), slope.high), a)


def _floor(a: Jet) -> Jet:
    value = Interval(np.floor(a.value.low), np.floor(a.value.high))
    return stepwise(value, np.asarray(value.low == value.high), a)


def _remainder(a: Jet, b: Jet) -> Jet:
    """Python's %: a - b floor(a / b), with the sign of b."""
    turns = _floor(jet_quotient(a, b))
    inside = jet_difference(a, jet_product(b, turns))
    low = np.where(b.value.low < 0.0, b.value.low, 0.0)
    high = np.where(b.value.high > 0.0, b.value.high, 0.0)
    decided = turns.value.low == turns.value.high
    value = chosen(decided, inside.value, Interval(low, high))
    return Jet(value, inside.slopes, np.asarray(inside.sure & turns.sure))


def _wrapped(a: Jet) -> Jet:
    """An angle in (-pi, pi], by the double nearest to a turn."""
    turn = exactly(2.0 * np.pi)
    middle = subtract(multiply(a.value, inverse(turn)), exactly(0.5))
    turns = Interval(np.ceil(middle.low), np.ceil(middle.high))
    decided = np.asarray(turns.low == turns.high)
    shifted = subtract(a.value, multiply(turns, turn))
    value = chosen(decided, shifted, Interval(np.asarray(-np.pi), np.asarray(np.pi)))
    if a.slopes is None:
        return Jet(value, None, a.sure)
    jumps = ~decided & ~is_zero(a.slopes)
    return Jet(value, unbounded(a.slopes, jumps), a.sure)


def _power(a: Jet, b: Jet) -> Jet:
    n = b.value.low
    if b.slopes is None and n.ndim == 0 and n == b.value.high:
        return _constant_power(a, float(n))
    jet = _exponential(jet_product(b, _logarithm(a)))
    # Powers of what may be negative exist here and there; nothing is said of them.
    loose = np.asarray(a.value.low <= 0.0)
    return Jet(chosen(loose, UNBOUNDED, jet.value), jet.slopes, np.asarray(jet.sure & ~loose))


def _constant_power(a: Jet, n: float) -> Jet:
    if n == 2.0:
        return jet_product(a, a)
    is_whole = n == np.floor(n) and abs(n) <= LARGEST_POWER
    if n < 0.0:
        return jet_quotient(constant(ONE), _constant_power(a, -n))
    if is_whole:
        slope = multiply(exactly(n), _whole_power(a.value, n - 1.0)) if n > 0.0 else NOTHING
        return composed(_whole_power(a.value, n), slope, a)
    base = within(a.value, 0.0, np.inf)
    value = rising(lambda x: np.power(x, n), base)
    slope = rising(lambda x: np.power(x, abs(n - 1.0)), base)
    slope = multiply(exactly(n), slope if n >= 1.0 else inverse(slope))
    return composed(value, slope, a, np.asarray(a.value.low >= 0.0))


def _whole_power(a: Interval, n: float) -> Interval:
    if n == 0.0:
        return ONE
    function: Real = lambda x: np.power(x, n)  # noqa: E731 - one line, used twice
    return rising(function, a) if n % 2.0 else even_rising(function, a)


def _truth(yes: Booleans, no: Booleans, *operands: Jet) -> Jet:
    """1 where `yes`, 0 where `no`, else either; a comparison with what does not exist is open."""
    sure = np.asarray(np.logical_and.reduce(np.broadcast_arrays(*[a.sure for a in operands])))
    yes, no = np.asarray(yes & sure), np.asarray(no & sure)
    value = chosen(yes, ONE, chosen(no, NOTHING, EITHER))
    jet = stepwise(value, np.asarray(yes | no), *operands)
    return Jet(jet.value, jet.slopes, SURE)


def _less(a: Jet, b: Jet) -> Jet:
    return _truth(a.value.high < b.value.low, a.value.low >= b.value.high, a, b)


def _less_or_equal(a: Jet, b: Jet) -> Jet:
    return _truth(a.value.high <= b.value.low, a.value.low > b.value.high, a, b)


def _equal(a: Jet, b: Jet) -> Jet:
    gap = subtract(a.value, b.value)
    same = (a.value.low == b.value.high) & (a.value.high == b.value.low)
    return _truth(np.asarray(same), ~holds_zero(gap), a, b)


def _denied(a: Jet) -> Jet:
    return _truth(is_zero(a.value), ~holds_zero(a.value), a)


def _both(a: Jet, b: Jet) -> Jet:
    yes = ~holds_zero(a.value) & ~holds_zero(b.value)
    return _truth(yes, is_zero(a.value) | is_zero(b.value), a, b)


def _either(a: Jet, b: Jet) -> Jet:
    yes = ~holds_zero(a.value) | ~holds_zero(b.value)
    return _truth(yes, is_zero(a.value) & is_zero(b.value), a, b)


OPERATIONS: Final[dict[str, Callable[..., Jet]]] = {
    "add": jet_sum,
    "sub": jet_difference,
    "mul": jet_product,
    "div": jet_quotient,
    "mod": _remainder,
    "pow": _power,
    "neg": _negated,
    "lt": _less,
    "le": _less_or_equal,
    "gt": lambda a, b: _less(b, a),
    "ge": lambda a, b: _less_or_equal(b, a),
    "eq": _equal,
    "ne": lambda a, b: _denied(_equal(a, b)),
    "and": _both,
    "or": _either,
    "not": _denied,
    "where": jet_choice,
    "abs": _size,
    "sign": _sign,
    "min": jet_minimum,
    "max": jet_maximum,
    "clip": _clipped,
    "sqrt": _root,
    "hypot": _hypotenuse,
    "exp": _exponential,
    "log": _logarithm,
    "sin": _sine,
    "cos": _cosine,
    "tan": _tangent,
    "asin": _arc_sine,
    "acos": _arc_cosine,
    "atan": _arc_tangent,
    "atan2": _arc_tangent_2,
    "sinh": _hyperbolic_sine,
    "cosh": _hyperbolic_cosine,
    "tanh": _hyperbolic_tangent,
    "floor": _floor,
    "wrap": _wrapped,
}
"""Every operation of `runtime.code.ARITY` on jets."""
