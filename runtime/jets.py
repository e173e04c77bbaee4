"""Jets: what a value may be over a box, and its derivatives by the axes of the box.

Forward differentiation over intervals (Moore, Kearfott, Cloud 2009, chapter 6). Derivatives of
kinks are the hull of those on both sides (Clarke's generalised derivative, for which the mean value
theorem holds), of jumps all numbers. m: axes; N: boxes.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.intervals import (
    Interval,
    add,
    chosen,
    exactly,
    holds_zero,
    hull,
    inverse,
    is_zero,
    multiply,
    negative,
    square,
    subtract,
    whole,
)

ONE: Final = exactly(1.0)
NOTHING: Final = exactly(0.0)
EITHER: Final = Interval(np.asarray(0.0), np.asarray(1.0))
UNBOUNDED: Final = whole(())


@final
@dataclass(frozen=True, eq=False, slots=True)
class Jet:
    """Values (N,) and slopes (m, N) over N boxes; slopes are None for what no axis moves.

    sure: where the value exists everywhere in the box.
    """

    value: Interval
    slopes: Interval | None
    sure: Booleans


SURE: Final[Booleans] = np.asarray(True)  # noqa: FBT003 - an array of one


def constant(value: Interval) -> Jet:
    """A value that depends on no axis."""
    return Jet(value, None, SURE)


def composed(value: Interval, derivative: Interval, a: Jet, sure: Booleans = SURE) -> Jet:
    """A function of a jet: its value, and its derivative there."""
    slopes = None if a.slopes is None else multiply(derivative, a.slopes)
    return Jet(value, slopes, np.asarray(a.sure & sure))


def stepwise(value: Interval, decided: Booleans, *operands: Jet) -> Jet:
    """A function that is constant where it is `decided`, and may jump elsewhere."""
    slopes: Interval | None = None
    for a in operands:
        if a.slopes is not None:
            jump = ~decided & ~is_zero(a.slopes)
            part = chosen(jump, UNBOUNDED, NOTHING)
            slopes = part if slopes is None else hull(slopes, part)
    return Jet(value, slopes, _sure(*operands))


def jet_sum(a: Jet, b: Jet) -> Jet:
    """A + b."""
    return Jet(add(a.value, b.value), _added(a.slopes, b.slopes), _sure(a, b))


def jet_difference(a: Jet, b: Jet) -> Jet:
    """A - b."""
    minus = None if b.slopes is None else negative(b.slopes)
    return Jet(subtract(a.value, b.value), _added(a.slopes, minus), _sure(a, b))


def jet_product(a: Jet, b: Jet) -> Jet:
    """A product; a square where both are the same."""
    if a is b:
        return composed(square(a.value), multiply(exactly(2.0), a.value), a)
    slopes = _added(_scaled(a.slopes, b.value), _scaled(b.slopes, a.value))
    return Jet(multiply(a.value, b.value), slopes, _sure(a, b))


def jet_quotient(a: Jet, b: Jet) -> Jet:
    """A quotient; it does not exist where b is 0."""
    over = inverse(b.value)
    value = multiply(a.value, over)
    minus = None if b.slopes is None else multiply(negative(value), b.slopes)
    slopes = _scaled(_added(a.slopes, minus), over)
    return Jet(value, slopes, np.asarray(_sure(a, b) & ~holds_zero(b.value)))


def jet_minimum(a: Jet, b: Jet) -> Jet:
    """The smaller of two."""
    value = Interval(np.minimum(a.value.low, b.value.low), np.minimum(a.value.high, b.value.high))
    return Jet(value, _slopes_of_either(a, b, a.value, b.value), _sure(a, b))


def jet_maximum(a: Jet, b: Jet) -> Jet:
    """The larger of two."""
    value = Interval(np.maximum(a.value.low, b.value.low), np.maximum(a.value.high, b.value.high))
    return Jet(value, _slopes_of_either(a, b, b.value, a.value), _sure(a, b))


def jet_choice(condition: Jet, a: Jet, b: Jet) -> Jet:
    """`a` where the condition is not 0, else `b`; a jump where an axis decides."""
    c = condition.value
    yes = (condition.sure & ((c.low > 0.0) | (c.high < 0.0))).astype(np.bool_)
    no = (condition.sure & is_zero(c)).astype(np.bool_)
    open_ = ~yes & ~no
    value = chosen(yes, a.value, chosen(no, b.value, hull(a.value, b.value)))
    slopes = _chosen_slopes(yes, no, a, b)
    if condition.slopes is not None:
        jump = open_ & ~is_zero(condition.slopes)
        slopes = chosen(jump, UNBOUNDED, slopes or NOTHING)
    sure = np.where(yes, a.sure, np.where(no, b.sure, a.sure & b.sure))
    return Jet(value, slopes, np.asarray(sure, dtype=np.bool_))


def _slopes_of_either(a: Jet, b: Jet, small: Interval, large: Interval) -> Interval | None:
    """Slopes of a where `small` lies below `large`, of b where above, else of either."""
    return _chosen_slopes(
        np.asarray(small.high <= large.low), np.asarray(large.high <= small.low), a, b
    )


def _chosen_slopes(is_a: Booleans, is_b: Booleans, a: Jet, b: Jet) -> Interval | None:
    if a.slopes is None and b.slopes is None:
        return None
    of_a, of_b = a.slopes or NOTHING, b.slopes or NOTHING
    return chosen(is_a, of_a, chosen(is_b, of_b, hull(of_a, of_b)))


def _added(a: Interval | None, b: Interval | None) -> Interval | None:
    if a is None or b is None:
        return b if a is None else a
    return add(a, b)


def _scaled(slopes: Interval | None, factor: Interval) -> Interval | None:
    return None if slopes is None else multiply(factor, slopes)


def _sure(*operands: Jet) -> Booleans:
    sure = SURE
    for a in operands:
        sure = np.asarray(sure & a.sure)
    return sure


def unbounded(slopes: Interval, where: Array | Booleans) -> Interval:
    """`slopes`, all numbers where a condition holds."""
    return chosen(np.asarray(where, dtype=np.bool_), UNBOUNDED, slopes)
