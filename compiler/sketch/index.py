"""What index theory asks of a region of the plane beside what was drawn in it.

H. Poincare, "Sur les courbes definies par une equation differentielle", 1881-86: an attractor, a
repeller and a whole closed orbit count +1, a saddle -1; where the field points inward (or outward)
all along the border of a region, what it holds counts +1 in all. A region that is entered from all
sides needs an attractor; one that is left to all sides, a repeller.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final, Literal, TypeAlias, final

import numpy as np

from compiler.sketch.algebra import between, plus, scaled
from compiler.sketch.drawing import Pair
from runtime.arrays import Array

Sort: TypeAlias = Literal["attractor", "repeller", "saddle"]
Border: TypeAlias = Literal["inward", "outward"]

SWAPPED: Final[dict[Sort, Sort]] = {
    "attractor": "repeller",
    "repeller": "attractor",
    "saddle": "saddle",
}
"""What each is when time runs backwards."""
ASIDE: Final = 0.35
"""A join closer to a repeller than this share of its length goes round it."""
HALFWAY: Final = 0.5
"""How far at most what is added goes, of the way to the next orbit."""
CONE: Final = 0.3
"""Cosine of the widest angle between a saddle's way and what it leads to."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Item:
    """A feature of a region as index theory sees it; a closed orbit is an attractor or a repeller.

    at: (2,) in the frame, at the controls' defaults; place: the same in the plane. ends: of a
    saddle, two places that its way out leads along; None where it is drawn or still open. way:
    (2,) its drawn way out. inward: `ends` are those of its way in instead. why: of what was added.
    """

    sort: Sort
    name: str
    at: Array
    place: Pair
    ends: tuple[Pair, Pair] | None = None
    way: Array | None = None
    inward: bool = False
    why: str = ""


@final
@dataclass(frozen=True, slots=True)
class Ground:
    """Where features are added. half: the half widths of the frame.

    room: how far the nearest orbit is from a place (2,) in a direction (2,); inf where none is.
    """

    half: Pair
    room: Callable[[Array, Array], float]


def index_of(items: Sequence[Item]) -> int:
    """What the features count in all."""
    return sum(-1 if item.sort == "saddle" else 1 for item in items)


def completed(items: Sequence[Item], border: Border, ground: Ground) -> tuple[Item, ...]:
    """The items with the fewest that index theory asks for beside them, for a border all one way.

    Saddles whose way out is open get one. An empty tuple where no way was found.
    """
    if border == "outward":
        backwards = tuple(_backwards(item) for item in items)
        return tuple(_backwards(item) for item in completed(backwards, "inward", ground))
    found = _with_ends(tuple(items))
    for _ in range(2 * len(found) + 4):
        lacking = index_of(found) - 1
        if lacking == 0 and any(item.sort == "attractor" for item in found):
            return _with_ends(found)
        extra = _saddle(found, ground) if lacking > 0 else _goal(found, ground)
        if extra is None:
            return ()
        found = (*found, extra)
    return ()


def _backwards(item: Item) -> Item:
    """The item when time runs backwards: a saddle's ways change places."""
    way = item.way if item.way is None else np.array([-item.way[1], item.way[0]])
    return replace(item, sort=SWAPPED[item.sort], way=way, inward=not item.inward)


def _with_ends(items: tuple[Item, ...]) -> tuple[Item, ...]:
    """Open ways out of saddles led along their two nearest attractors, on either side if any."""
    return tuple(
        replace(item, ends=_ends(item, items), inward=False)
        if item.sort == "saddle" and item.ends is None and item.way is None
        else item
        for item in items
    )


def _ends(saddle: Item, items: Sequence[Item]) -> tuple[Pair, Pair] | None:
    goals = sorted(_of("attractor", items), key=lambda goal: _apart(goal, saddle))
    for first, second in combinations(goals, 2):
        if np.dot(first.at - saddle.at, second.at - saddle.at) < 0.0:
            return first.place, second.place
    return (saddle.place, goals[0].place) if goals else None


def _of(sort: Sort, items: Sequence[Item]) -> tuple[Item, ...]:
    return tuple(item for item in items if item.sort == sort)


def _apart(first: Item, second: Item) -> float:
    return float(np.linalg.norm(first.at - second.at))


def _saddle(items: tuple[Item, ...], ground: Ground) -> Item | None:
    """A saddle between two attractors that nothing joins yet, else one beside a repeller."""
    goals = _of("attractor", items)
    joined = _joins(items)
    for first, second in sorted(combinations(goals, 2), key=lambda pair: _apart(*pair)):
        if not _connected(first, second, joined):
            return _between(first, second, items, ground)
    sources = sorted(_of("repeller", items), key=lambda source: -_free(source, items)[0])
    return _beside(sources[0], items, ground) if sources and goals else None


def _joins(items: tuple[Item, ...]) -> tuple[tuple[Item, Item], ...]:
    """For each saddle the two attractors that its ways out lead to."""
    goals = _of("attractor", items)
    found = []
    for saddle in _of("saddle", items):
        pairs = sorted(
            combinations(goals, 2), key=lambda p: _apart(p[0], saddle) + _apart(p[1], saddle)
        )
        if pairs:
            found.append(pairs[0])
    return tuple(found)


def _connected(first: Item, second: Item, joins: Sequence[tuple[Item, Item]]) -> bool:
    reached = {id(first)}
    for _ in joins:
        for a, b in joins:
            if id(a) in reached or id(b) in reached:
                reached |= {id(a), id(b)}
    return id(second) in reached


def _between(first: Item, second: Item, items: tuple[Item, ...], ground: Ground) -> Item:
    """A saddle halfway between two attractors, or aside where a repeller is in the way."""
    place, at = between(first.place, second.place, 0.5), (first.at + second.at) / 2
    length = _apart(first, second)
    for source in _of("repeller", items):
        if np.linalg.norm(source.at - at) < ASIDE * length:
            return _beside(source, items, ground)
    why = f"'{first.name}' and '{second.name}' draw apart what starts between them"
    name = f"saddle between {first.name} and {second.name}"
    return Item("saddle", name, at, place, ends=(first.place, second.place), why=why)


def _free(source: Item, items: Sequence[Item]) -> tuple[float, Array]:
    """How far the nearest other feature is, and the direction in which there is most room."""
    others = [item.at - source.at for item in items if item is not source]
    nearest = min((float(np.linalg.norm(v)) for v in others), default=1.0)
    angles = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    units = [v / max(float(np.linalg.norm(v)), 1e-12) for v in others]
    crowd = np.max([ways @ unit for unit in units], axis=0) if units else angles
    return nearest, ways[int(np.argmin(crowd))]


def _beside(source: Item, items: Sequence[Item], ground: Ground) -> Item:
    """A saddle beside a repeller, where what it sends out meets what comes from the border."""
    nearest, way = _free(source, items)
    step = min(0.8 * nearest, HALFWAY * ground.room(source.at, way)) * way
    place = _shifted(source, step, ground.half)
    why = f"what '{source.name}' sends out meets what comes from the border"
    found = Item("saddle", f"saddle beside {source.name}", source.at + step, place, why=why)
    return replace(found, ends=(source.place, place), inward=True)


def _shifted(origin: Item, step: Array, half: Pair) -> Pair:
    """The place `step` half widths of the frame away from an item: it moves with the sketch."""
    first, second = (
        plus(expr, scaled(float(share), width))
        for expr, share, width in zip(origin.place, step, half, strict=True)
    )
    return first, second


def _goal(items: tuple[Item, ...], ground: Ground) -> Item | None:
    """An attractor at the end of a saddle's way out that leads nowhere yet."""
    goals = _of("attractor", items)
    for saddle in _of("saddle", items):
        for way in _ways_out(saddle, items):
            reached = [g for g in goals if _cosine(g.at - saddle.at, way) > CONE]
            if not reached:
                others = [_apart(o, saddle) for o in items if o is not saddle]
                free = min(others, default=1.0)
                step = min(free, HALFWAY * ground.room(saddle.at, way)) * way
                why = f"the way through '{saddle.name}' must end somewhere on either side"
                name = f"point beyond {saddle.name}"
                if any(item.name == name for item in items):
                    name += ", on the other side"
                place = _shifted(saddle, step, ground.half)
                return Item("attractor", name, saddle.at + step, place, why=why)
    return None


def _cosine(a: Array, b: Array) -> float:
    return float(np.dot(a, b) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-12))


def _ways_out(saddle: Item, items: Sequence[Item]) -> tuple[Array, Array]:
    if saddle.way is not None:
        way = saddle.way
    else:
        nearest = min(_of("attractor", items), key=lambda g: _apart(g, saddle), default=None)
        way = np.array([1.0, 0.0]) if nearest is None else nearest.at - saddle.at
    unit = way / np.linalg.norm(way)
    return unit, -unit
