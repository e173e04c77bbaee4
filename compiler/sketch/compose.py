"""From a drawing to a design: region within region, completed by what theory says is missing."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from compiler.declare import Declarations
from compiler.sketch.design import Design, Family, Node, Region, Ridge, Ring
from compiler.sketch.drawing import Drawing, Orbit, Point
from compiler.sketch.frame import Frame, SketchRefusedError, frame_of
from compiler.sketch.index import SWAPPED, Border, Ground, Item, Sort, completed, index_of
from compiler.sketch.loops import Loop, loops_of
from compiler.sketch.polygons import distance_along, encloses, sees_all, viewpoint
from compiler.sketch.refusals import refuse_coincidences, refuse_flat_directions, refuse_outside
from compiler.sketch.separatrices import ridge_of
from runtime.arrays import Array
from spec_schema.expressions.tree import Expr
from spec_schema.places import Path

INSERTED: Final = 0.6
"""Where an orbit that theory adds runs: this share of the way out to the next one."""


def compose(drawing: Drawing, declared: Declarations) -> Design:
    """The design of a drawing.

    Raises:
        SketchRefusedError: no field of the plane can look like this, or none that we can build.
    """
    frame = frame_of(drawing, declared)
    refuse_outside(drawing, frame, declared)
    refuse_flat_directions(drawing, frame, declared)
    loops = loops_of(drawing, frame)
    nodes = [Node(point, frame.spot(point.at)) for point in drawing.points]
    ridges = [ridge_of(line, drawing, frame) for line in drawing.lines]
    refuse_coincidences(nodes, ridges, loops, frame, declared)
    builder = _Builder(frame, tuple(loops), tuple(nodes), tuple(ridges))
    return Design(drawing, frame, builder.region(-1, None), drawing.arrows)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Builder:
    """What the parts of a design are put together from."""

    frame: Frame
    loops: tuple[Loop, ...]
    nodes: tuple[Node, ...]
    ridges: tuple[Ridge, ...]

    def owner(self, at: Array) -> int:
        """The innermost loop around a place, -1 where there is none."""
        around = [i for i, loop in enumerate(self.loops) if encloses(loop.vertices, at)]
        return next((i for i in around if not any(self.loops[j].parent == i for j in around)), -1)

    def room(self, at: Array, way: Array) -> float:
        """How far the nearest orbit is from a place in a direction; inf where none is."""
        far = [distance_along(loop.vertices, at, way) for loop in self.loops]
        return min(far, default=np.inf)

    def region(self, owner: int, border: Border | None) -> Region:
        """What stands right inside loop `owner`, completed for a border that is crossed so."""
        nodes = tuple(n for n in self.nodes if self.owner(n.spot.at) == owner)
        ridges = tuple(r for r in self.ridges if self.owner(r.saddle) == owner)
        families = tuple(self.family(i) for i, lp in enumerate(self.loops) if lp.parent == owner)
        items = [_item(node, self.frame) for node in nodes]
        items += [_ridge_item(ridge, self.frame) for ridge in ridges]
        items += [_family_item(family, self.frame) for family in families]
        if border is None:
            border = _free_border(items)
        if border is None:
            return Region(nodes, ridges, families, None)
        found = completed(items, border, Ground(self.frame.half, self.room))
        astray = [item for item in found if item.why and self.owner(item.at) != owner]
        if not found or astray:
            raise _incomplete(items, self._path(owner, items), border)
        rate = _pace(nodes, ridges, families)
        return Region(_finished(nodes, found, rate, self.frame), ridges, families, border)

    def _path(self, owner: int, items: Sequence[Item]) -> Path:
        if owner >= 0:
            return self.loops[owner].orbit.path
        named = {node.point.name: node.point.path for node in self.nodes}
        return next((named[item.name] for item in items if item.name in named), ("field", "sketch"))

    def family(self, outermost: int) -> Family:
        """The orbits from `outermost` inward, as far as nothing else is between them."""
        chain = [outermost]
        while (inner := self._only_child(chain[-1])) is not None and viewpoint(
            [self.loops[i].vertices for i in (*chain, inner)]
        ) is not None:
            chain.append(inner)
        held = [n for n in self.nodes if self.owner(n.spot.at) == chain[-1]]
        alone = self._is_alone(chain[-1], held)
        curves = [self.loops[i].vertices for i in chain]
        centre = held[0].spot.at if alone and held else viewpoint(curves)
        if centre is None or not all(sees_all(curve, centre) for curve in curves):
            raise _not_star_shaped(self.loops[chain[0]].orbit, held if alone else [])
        rings = [Ring(self.loops[i].orbit, self.loops[i].vertices) for i in reversed(chain)]
        if not alone:
            return self._hollow(chain[-1], centre, rings)
        core = held[0] if held else self._core(centre, rings[0])
        sort: Sort = "attractor" if core.point.kind == "attractor" else "repeller"
        return Family(centre, _alternating(sort, rings), core, None)

    def _only_child(self, owner: int) -> int | None:
        """The one orbit that is all that an orbit holds."""
        children = [i for i, loop in enumerate(self.loops) if loop.parent == owner]
        beside = [n for n in self.nodes if self.owner(n.spot.at) == owner]
        beside_too = [r for r in self.ridges if self.owner(r.saddle) == owner]
        return children[0] if len(children) == 1 and not beside and not beside_too else None

    def _is_alone(self, owner: int, held: Sequence[Node]) -> bool:
        """Whether an orbit holds nothing, or one node that does not move in the frame."""
        children = [i for i, loop in enumerate(self.loops) if loop.parent == owner]
        ridges = [r for r in self.ridges if self.owner(r.saddle) == owner]
        few = len(held) == 0 or (
            len(held) == 1
            and held[0].point.kind != "saddle"
            and not held[0].spot.controls
            and sees_all(self.loops[owner].vertices, held[0].spot.at)
        )
        return few and not children and not ridges

    def _core(self, centre: Array, ring: Ring) -> Node:
        """The point that an empty orbit must enclose: it sends out what the orbit draws in."""
        kind: Sort = "repeller" if ring.orbit.attracts else "attractor"
        place = self.frame.place(centre)
        rate = ring.orbit.strength
        why = f"an orbit encloses a point, and '{ring.orbit.name}' encloses none"
        name = f"{kind} inside {ring.orbit.name}"
        point = Point(name, kind, place, (rate, rate), None, None, ring.orbit.path, why)
        return Node(point, self.frame.spot(place))

    def _hollow(self, owner: int, centre: Array, rings: list[Ring]) -> Family:
        """A family around a region of several features."""
        border: Border = "outward" if rings[0].orbit.attracts else "inward"
        wanted: Sort = "repeller" if border == "outward" else "attractor"
        inner = self._sorts_in(owner)
        if wanted not in inner and SWAPPED[wanted] in inner:
            rings = [_inserted(SWAPPED[wanted], rings[0], INSERTED), *rings]
            border = "inward" if border == "outward" else "outward"
        around: Sort = "repeller" if border == "outward" else "attractor"
        return Family(centre, _alternating(around, rings), None, self.region(owner, border))

    def _sorts_in(self, owner: int) -> set[Sort]:
        sorts: set[Sort] = {n.point.kind for n in self.nodes if self.owner(n.spot.at) == owner}
        children = [loop for loop in self.loops if loop.parent == owner]
        return sorts | {_sort(loop.orbit) for loop in children}


def _item(node: Node, frame: Frame) -> Item:
    way = None
    if node.point.kind == "saddle" and node.point.directions is not None:
        way = frame.vector(node.point.directions[1]).at
    return Item(node.point.kind, node.point.name, node.spot.at, node.point.at, way=way)


def _ridge_item(ridge: Ridge, frame: Frame) -> Item:
    along = ridge.through[-1] - ridge.through[0]
    way = np.array([-along[1], along[0]])
    return Item("saddle", ridge.line.name, ridge.saddle, frame.place(ridge.saddle), way=way)


def _family_item(family: Family, frame: Frame) -> Item:
    orbit = family.rings[-1].orbit
    return Item(_sort(orbit), orbit.name, family.centre, frame.place(family.centre))


def _sort(orbit: Orbit) -> Sort:
    return "attractor" if orbit.attracts else "repeller"


def _free_border(items: Sequence[Item]) -> Border | None:
    """How the sketch as a whole is entered: inward if anything attracts, else outward.

    None for a saddle alone, which is entered from two sides.
    """
    if any(item.sort == "attractor" for item in items):
        return "inward"
    if any(item.sort == "repeller" for item in items):
        return "outward"
    return None if len(items) == 1 else "inward"


def _pace(nodes: Sequence[Node], ridges: Sequence[Ridge], families: Sequence[Family]) -> Expr:
    """The rate of what is added: that of the first feature that was drawn."""
    rates = [node.point.rates[0] for node in nodes] + [ridge.line.rates[1] for ridge in ridges]
    return [*rates, *(family.rings[-1].orbit.strength for family in families)][0]


def _finished(
    nodes: tuple[Node, ...], items: Sequence[Item], rate: Expr, frame: Frame
) -> tuple[Node, ...]:
    """The nodes with their ways out, and those that were added."""
    drawn = {node.point.name: node for node in nodes}
    found = [
        replace(drawn[item.name], ends=item.ends, inward=item.inward)
        for item in items
        if not item.why and item.name in drawn
    ]
    for item in items:
        if item.why:
            path = nodes[0].point.path if nodes else ("field", "sketch")
            rates = (rate, rate)
            point = Point(item.name, item.sort, item.place, rates, None, None, path, item.why)
            found.append(Node(point, frame.spot(item.place), item.ends, item.inward))
    return tuple(found)


def _alternating(inner: Sort, rings: Sequence[Ring]) -> tuple[Ring, ...]:
    """The rings with one between any two neighbors that both draw in, or both send out."""
    found: list[Ring] = []
    for ring in rings:
        if _sort(ring.orbit) == inner:
            found.append(_inserted(SWAPPED[inner], ring, 0.5))
        found.append(ring)
        inner = _sort(ring.orbit)
    return tuple(found)


def _inserted(sort: Sort, outer: Ring, share: float) -> Ring:
    """An orbit that must run inside `outer`, going round as fast as that one."""
    verb = "draws in" if sort == "repeller" else "sends out"
    why = f"what is inside '{outer.orbit.name}' {verb} as it does itself: an orbit parts them"
    name = f"orbit inside {outer.orbit.name}"
    orbit = replace(outer.orbit, name=name, attracts=sort == "attractor", why=why)
    return Ring(orbit, outer.vertices, share)


def _incomplete(items: Sequence[Item], path: Path, border: Border) -> SketchRefusedError:
    entered = "entered" if border == "inward" else "left"
    message = (
        f"a region that is {entered} on all sides holds features that count +1 in all "
        f"(attractors, repellers and orbits +1, saddles -1); these count "
        f"{_signed(index_of(items))}, and no way was found to complete them"
    )
    return SketchRefusedError("S267", path, message, "draw the missing attractors and repellers")


def _signed(count: int) -> str:
    return f"{count:+d}" if count else "0"


def _not_star_shaped(orbit: Orbit, held: Sequence[Node]) -> SketchRefusedError:
    seen = f"from '{held[0].point.name}' inside" if held else "from any place inside"
    message = f"not all of '{orbit.name}' can be seen {seen}, and only such orbits can be filled"
    return SketchRefusedError("S265", orbit.path, message, "draw it rounder, or move the point")
