"""What features of a portrait are called where something else speaks of them.

One name in text, pictures and JSON: numbers with four significant digits, in the users' units.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from verifier.topology.features import Attractor, AxisRange, Cycle, Portrait

DIGITS: Final = 4
"""Significant digits of a number in a name."""

EXACT: Final = 1e-9
"""Less than this share of an axis is a rounding error beside zero."""

SAMPLED: Final = 1e-3
"""So finely, as a share of an axis, the middle of a cycle is known from its points."""


def attractor_names(portrait: Portrait) -> tuple[str, ...]:
    """Of each attractor of the basins: `stable node at x = 0.8, y = 0`, `cycle of period 5 s`."""
    found = portrait.basins.attractors if portrait.basins else ()
    cycles = cycle_names(portrait)
    return tuple(
        cycles[each.index] if each.is_cycle else point_name(portrait, each.index) for each in found
    )


def attractor_tags(portrait: Portrait) -> tuple[str, ...]:
    """The same, shorter: `(0.8, 0)`, `x = 0.8` on one axis, `the cycle of period 5 s`."""
    found = portrait.basins.attractors if portrait.basins else ()
    cycles = cycle_names(portrait)
    return tuple(
        f"the {cycles[each.index]}" if each.is_cycle else _tag(portrait, each) for each in found
    )


def point_name(portrait: Portrait, index: int) -> str:
    """A fixed point by its type and place."""
    point = portrait.fixed_points[index]
    return f"{point.kind} at {place(portrait.axes, point.at.tolist())}"


def place(axes: Sequence[AxisRange], at: Sequence[float], digits: int = DIGITS) -> str:
    """A place: `x = 0.8, y = 0`."""
    return ", ".join(
        f"{axis.name} = {_number(axis, value, digits)}"
        for axis, value in zip(axes, at, strict=True)
    )


def cycle_names(portrait: Portrait) -> tuple[str, ...]:
    """Of each cycle: by its period; like ones also by their middle, or their reach."""
    if portrait.every > 0.0:
        names = [f"orbit of period {len(c.points) - 1}" for c in portrait.cycles]
    else:
        names = [f"cycle of period {c.period:.{DIGITS}g} s" for c in portrait.cycles]
    ways: tuple[Callable[[Portrait, Cycle], str], ...] = (_middle, _reach)
    for way in ways:
        count = Counter(zip(names, (c.stability for c in portrait.cycles), strict=True))
        names = [
            f"{name} {way(portrait, cycle)}" if count[name, cycle.stability] > 1 else name
            for name, cycle in zip(names, portrait.cycles, strict=True)
        ]
    return tuple(names)


def _middle(portrait: Portrait, cycle: Cycle) -> str:
    """Half-way between the lowest and the highest value on each axis: `about (0, 1)`."""
    middle = 0.5 * (cycle.points.min(axis=0) + cycle.points.max(axis=0))
    values = [_rounded(axis, v) for axis, v in zip(portrait.axes, middle.tolist(), strict=True)]
    return f"about {_in_brackets(portrait.axes, values)}"


def _reach(portrait: Portrait, cycle: Cycle) -> str:
    """From where to where it goes on the first axis: `(x from -1.5 to 1.5)`."""
    axis = portrait.axes[0]
    ends = (cycle.points[:, 0].min(), cycle.points[:, 0].max())
    low, high = (_number(axis, _rounded(axis, float(end)), DIGITS) for end in ends)
    return f"({axis.name} from {low} to {high})"


def _tag(portrait: Portrait, attractor: Attractor) -> str:
    """The place of a fixed point in brackets; with more digits where another would be the same."""
    ends = [portrait.fixed_points[a.index].at.tolist() for a in _points(portrait)]
    at = portrait.fixed_points[attractor.index].at.tolist()
    for digits in (DIGITS, 6, 9):
        same = [_in_brackets(portrait.axes, other, digits) for other in ends]
        tag = _in_brackets(portrait.axes, at, digits)
        if same.count(tag) == 1:
            break
    return tag


def _points(portrait: Portrait) -> list[Attractor]:
    found = portrait.basins.attractors if portrait.basins else ()
    return [each for each in found if not each.is_cycle]


def _in_brackets(axes: Sequence[AxisRange], at: Sequence[float], digits: int = DIGITS) -> str:
    if len(at) == 1:
        return place(axes, at, digits)
    values = (_number(axis, value, digits) for axis, value in zip(axes, at, strict=True))
    return f"({', '.join(values)})"


def _rounded(axis: AxisRange, value: float) -> float:
    """To a power of ten in the axis' own unit, the largest that tells `SAMPLED` of it."""
    decimals = int(np.ceil(-np.log10(SAMPLED * axis.width / axis.unit.scale)))
    return round(value / axis.unit.scale, decimals) * axis.unit.scale


def _number(axis: AxisRange, value: float, digits: int) -> str:
    clean = 0.0 if abs(value) < EXACT * axis.width else value
    return f"{clean / axis.unit.scale + 0.0:.{digits}g}"
