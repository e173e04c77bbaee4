"""The parts of phase space and control domain in which a robot is judged, each on its own.

Windows are divided like the leaves of a k-d tree (Bentley 1975): at the median of that quantity
which still varies most, as long as both halves hold enough independent windows. Where they ran
decides, never how they ended, so that the parts do not favour any verdict. Values of a discrete
variable are told apart first.
"""

from dataclasses import dataclass, field
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers

LEAST: Final = 8
"""So many clusters of windows a part has at least: Student's t with seven degrees of freedom."""
DEEPEST: Final = 4
"""A trace is divided so often at most: into 16 parts."""
STILL: Final = 1e-6
"""A quantity that varies less than this share of its size has no parts."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Condition:
    """One quantity (W,) by which windows are told apart.

    turn: the period of a periodic one, else 0. noise: the standard deviation of its sensor's.
    """

    name: str
    values: Array
    is_discrete: bool
    turn: float = 0.0
    noise: float = 0.0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Part:
    """Which windows (W,) are in it, and the bounds of the quantities that set them apart."""

    members: Booleans
    bounds: dict[str, tuple[float, float]] = field(default_factory=dict)


def parts_of(
    conditions: tuple[Condition, ...], clusters: Integers, least: int = LEAST
) -> tuple[Part, ...]:
    """The parts, with at least so many clusters each.

    Windows in none of them have a discrete value that was seen too rarely; where all were, there
    is one part.
    """
    whole = Part(np.ones(len(clusters), dtype=bool))
    parts = [whole]
    for each in conditions:
        if each.is_discrete:
            parts = [finer for part in parts for finer in _valued(part, each, clusters)]
    parts = parts or [whole]
    smooth = tuple(each for each in conditions if not each.is_discrete)
    spreads = np.array([_spread(each.values) for each in smooth])
    leaves = [
        leaf
        for part in parts
        for leaf in _divided(part, smooth, spreads, (clusters, least), DEEPEST)
    ]
    return tuple(leaves)


def _valued(part: Part, each: Condition, clusters: Integers) -> list[Part]:
    """The part, one for each value that is seen often enough."""
    values = np.unique(each.values[part.members])
    if len(values) < 2:
        return [part]
    found = []
    for value in values:
        members = part.members & (each.values == value)
        if _count(members, clusters) >= LEAST:
            found.append(Part(members, part.bounds | {each.name: (float(value), float(value))}))
    return found


def _divided(
    part: Part,
    conditions: tuple[Condition, ...],
    spreads: Array,
    enough: tuple[Integers, int],
    depth: int,
) -> list[Part]:
    """The leaves below a part; the quantity that varies most is tried first.

    enough: the cluster (W,) of each window, and how many a part must have.
    """
    here = np.array([_spread(each.values[part.members]) for each in conditions])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(spreads > 0.0, here / spreads, 0.0)
    order = np.argsort(-np.round(share, 3), kind="stable") if depth > 0 else ()
    for place in order:
        each = conditions[place]
        values = each.values[part.members]
        if share[place] <= 0.0 or np.ptp(values) <= STILL * np.max(np.abs(values)):
            continue
        middle = float(np.median(values))
        halves = [part.members & (each.values <= middle), part.members & (each.values > middle)]
        if all(_count(half, enough[0]) >= enough[1] for half in halves):
            low, high = part.bounds.get(each.name, (float(values.min()), float(values.max())))
            ends = ((low, middle), (middle, high))
            return [
                leaf
                for half, bounds in zip(halves, ends, strict=True)
                for leaf in _divided(
                    Part(half, part.bounds | {each.name: bounds}),
                    conditions,
                    spreads,
                    enough,
                    depth - 1,
                )
            ]
    return [part]


def _spread(values: Array) -> float:
    return float(np.std(values)) if len(values) else 0.0


def _count(members: Booleans, clusters: Integers) -> int:
    return len(np.unique(clusters[members]))
