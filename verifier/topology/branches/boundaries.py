"""Where on a control something ceases to hold: bisection, and the bifurcation that is there."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeVar, final

from verifier.topology.branches.bifurcations import Difference, difference, signature
from verifier.topology.features import Portrait

CLOSE: Final = 1e-7
"""How closely a change among fixed points is located, as a share of the control's domain."""

COARSE: Final = 4e-4
"""The same of a change that cycles or basins are needed for."""

BIRTH: Final = 0.03
"""A cycle is born too small to be seen: a bifurcation of a point so near, as a share of the
control's domain, is where it came from."""

MOST_HALVINGS: Final = 40
MOST_WIDENINGS: Final = 24

Kind = TypeVar("Kind")
Look = Callable[[float], Portrait]


@final
@dataclass(frozen=True, slots=True)
class Bracket:
    """Two values of a control, something is different at `low` and at `high`."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        """Half way between the two."""
        return 0.5 * (self.low + self.high)


def narrowed(bracket: Bracket, kind_at: Callable[[float], Kind], width: float) -> Bracket:
    """The bracket by bisection, where `kind_at` differs from that at its low end, to `width`."""
    at_low = kind_at(bracket.low)
    for _ in range(MOST_HALVINGS):
        if bracket.high - bracket.low <= width:
            break
        middle = bracket.middle
        if kind_at(middle) == at_low:
            bracket = Bracket(middle, bracket.high)
        else:
            bracket = Bracket(bracket.low, middle)
    return bracket


def explained(
    bracket: Bracket, span: float, points_at: Look, everything_at: Look
) -> tuple[Bracket, Difference]:
    """The bifurcation within a narrow bracket, or of a fixed point just beside it.

    span: the width of the control's domain. points_at, everything_at: portraits at a value,
    without and with cycles; beyond the domain they are those of its edge.
    """
    found = _among_points(bracket, span, points_at)
    if found is not None:
        return found
    low, high = everything_at(bracket.low), everything_at(bracket.high)
    if signature(low) != signature(high):
        around = Bracket(bracket.low - BIRTH * span, bracket.high + BIRTH * span)
        found = _among_points(around, span, points_at)
    return found or (bracket, difference(low, high))


def _among_points(
    bracket: Bracket, span: float, points_at: Look
) -> tuple[Bracket, Difference] | None:
    """What happens to the fixed points within the bracket, and where."""
    if signature(points_at(bracket.low))[0] == signature(points_at(bracket.high))[0]:
        return None
    narrow = _hyperbolic(
        narrowed(bracket, lambda value: signature(points_at(value))[0], CLOSE * span),
        CLOSE * span,
        points_at,
    )
    found = difference(points_at(narrow.low), points_at(narrow.high))
    return None if found.is_none else (narrow, found)


def _hyperbolic(bracket: Bracket, step: float, points_at: Look) -> Bracket:
    """The bracket, widened until the types of all points are decided at both ends.

    Near a bifurcation they are not: the tables are not that exact.
    """
    low, high = bracket.low, bracket.high
    for _ in range(MOST_WIDENINGS):
        if -1 in signature(points_at(low))[0]:
            low -= step
        elif -1 in signature(points_at(high))[0]:
            high += step
        else:
            break
        step *= 1.5
    return Bracket(low, high)
