"""Boxes made smaller by what must hold in them (HC4: Benhamou and others 1999).

A comparison bounds its two sides; each operation hands its bound down to its operands. Bounds are
of computed values, so each is moved outward by what rounding can do before it is handed down.
"""

import math
from collections.abc import Callable, Mapping
from typing import Final, TypeAlias

from compiler.architecture.exclusion.formula import EQUAL, LESS, MORE, NONE, Atom
from spec_schema.expressions import interval
from spec_schema.expressions.bounds import interval_of
from spec_schema.expressions.interval import Interval
from spec_schema.expressions.tree import Apply, Expr, Name

Box: TypeAlias = Mapping[str, tuple[float, float]]
Handed: TypeAlias = tuple[Interval, ...]


def contracted(atom: Atom, box: Box) -> dict[str, tuple[float, float]] | None:
    """The part of the box where the atom can hold; None where that is nothing."""
    found = dict(box)
    if atom.allowed & NONE:
        return found
    left, right = interval_of(atom.left, box), interval_of(atom.right, box)
    if left.is_empty or right.is_empty:
        return None
    low, high = -math.inf, math.inf
    sides = [[low, high], [low, high]]
    if not atom.allowed & MORE:
        sides[0][1], sides[1][0] = right.high, left.low
    if not atom.allowed & LESS:
        sides[0][0], sides[1][1] = right.low, left.high
    for term, (least, most) in zip((atom.left, atom.right), sides, strict=True):
        if not _hand_down(term, Interval(least, most), found):
            return None
    return found


def possible(atom: Atom, box: Box) -> int:
    """The relations that its two sides can have in the box."""
    a, b = interval_of(atom.left, box), interval_of(atom.right, box)
    found = NONE if a.nan or b.nan else 0
    if a.is_empty or b.is_empty:
        return NONE
    found |= LESS if a.low < b.high else 0
    found |= MORE if a.high > b.low else 0
    return found | (EQUAL if a.low <= b.high and b.low <= a.high else 0)


def _hand_down(term: Expr, bound: Interval, box: dict[str, tuple[float, float]]) -> bool:
    """Narrow the names below `term`, whose value is a number in `bound`; False for nothing."""
    waiting: list[tuple[Expr, Interval]] = [(term, bound)]
    while waiting:
        node, given = waiting.pop()
        value = _common(interval_of(node, box), given)
        if value.is_empty:
            return False
        if isinstance(node, Name):
            box[node.name] = (value.low, value.high)
        elif isinstance(node, Apply) and node.op in DOWN:
            parts = tuple(interval_of(part, box) for part in node.operands)
            loose = interval.outward(value.low, value.high, ulps=1, nan=False)
            handed = zip(node.operands, DOWN[node.op](loose, *parts), strict=True)
            # Of what is told nothing, nothing follows: a power has a value where its base has none.
            waiting.extend((part, least) for part, least in handed if least != ALL)
    return True


def _common(a: Interval, b: Interval) -> Interval:
    return Interval(max(a.low, b.low), min(a.high, b.high))


def _sum(z: Interval, a: Interval, b: Interval) -> Handed:
    return interval.subtract(z, b), interval.subtract(z, a)


def _difference(z: Interval, a: Interval, b: Interval) -> Handed:
    return interval.add(z, b), interval.subtract(a, z)


def _product(z: Interval, a: Interval, b: Interval) -> Handed:
    return _quotient_of(z, b), _quotient_of(z, a)


def _quotient_of(z: Interval, b: Interval) -> Interval:
    return ALL if 0.0 in b else interval.divide(_with_underflow(z), b)


def _with_underflow(z: Interval) -> Interval:
    """A product that is 0, or nearly, may have been less."""
    return Interval(z.low - TINY, z.high + TINY)


def _quotient(z: Interval, a: Interval, b: Interval) -> Handed:
    if 0.0 in b:
        return ALL, ALL
    return interval.multiply(_with_underflow(z), b), _quotient_of(a, z)


def _power(z: Interval, _a: Interval, b: Interval) -> Handed:
    if not (b.low == b.high == 2.0):
        return ALL, ALL
    root = math.sqrt(max(z.high, 0.0) + TINY) * (1.0 + 1e-15)
    return Interval(-root, root), ALL


def _minimum(z: Interval, a: Interval, b: Interval) -> Handed:
    of_a = z.high if b.low > z.high else math.inf
    of_b = z.high if a.low > z.high else math.inf
    return Interval(z.low, of_a), Interval(z.low, of_b)


def _maximum(z: Interval, a: Interval, b: Interval) -> Handed:
    of_a = z.low if b.high < z.low else -math.inf
    of_b = z.low if a.high < z.low else -math.inf
    return Interval(of_a, z.high), Interval(of_b, z.high)


def _clip(z: Interval, _a: Interval, low: Interval, high: Interval) -> Handed:
    least = z.low if z.low > low.high else -math.inf
    most = z.high if z.high < high.low else math.inf
    return Interval(least, most), ALL, ALL


def _size(z: Interval, _a: Interval) -> Handed:
    return (Interval(-z.high, z.high),)


ALL: Final = Interval(-math.inf, math.inf)
TINY: Final = 2.0**-1000
DOWN: Final[Mapping[str, Callable[..., Handed]]] = {
    "add": _sum,
    "sub": _difference,
    "mul": _product,
    "div": _quotient,
    "neg": lambda z, _a: (interval.negate(z),),
    "pow": _power,
    "min": _minimum,
    "max": _maximum,
    "clip": _clip,
    "abs": _size,
}
"""What a value tells of its operands."""
