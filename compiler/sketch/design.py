"""What is to be built from a drawing: its features in regions, with those that theory adds.

An orbit divides the plane; nested orbits with nothing between them and one middle are a family.
A region holds points, separatrices and families, and its border is crossed one way all along.
"""

from dataclasses import dataclass
from typing import final

from compiler.sketch.drawing import Arrow, Drawing, Line, Orbit, Pair, Point
from compiler.sketch.frame import Frame, Spot
from compiler.sketch.index import Border
from runtime.arrays import Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Node:
    """A fixed point. ends: of a saddle with open directions, two places of its way out.

    inward: `ends` are those of its way in.
    """

    point: Point
    spot: Spot
    ends: tuple[Pair, Pair] | None = None
    inward: bool = False


@final
@dataclass(frozen=True, eq=False, slots=True)
class Ridge:
    """A separatrix. through: (V, 2) in the frame; saddle: (2,), on the polyline or beside it."""

    line: Line
    through: Array
    saddle: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Ring:
    """An orbit of a family. vertices: (V, 2) in the frame; share: of an added one, where it runs.

    An added ring has the vertices of its outer neighbor, and runs at `share` of the way from what
    is inside to that neighbor.
    """

    orbit: Orbit
    vertices: Array
    share: float = 1.0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Family:
    """Orbits about one centre (2,), the innermost first. core: the point in the middle.

    inside: what the innermost orbit holds, where that is more than a point in the middle; then
    `core` is None.
    """

    centre: Array
    rings: tuple[Ring, ...]
    core: Node | None
    inside: "Region | None"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Region:
    """What stands side by side. border: how the region is entered or left; None: either way."""

    nodes: tuple[Node, ...]
    ridges: tuple[Ridge, ...]
    families: tuple[Family, ...]
    border: Border | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Design:
    """A drawing with everything that it needs, in its frame."""

    drawing: Drawing
    frame: Frame
    region: Region
    arrows: tuple[Arrow, ...]

    @property
    def nodes(self) -> tuple[Node, ...]:
        """Every fixed point but those of separatrices."""
        return tuple(node for region in regions_of(self.region) for node in _nodes(region))

    @property
    def ridges(self) -> tuple[Ridge, ...]:
        """Every separatrix."""
        return tuple(ridge for region in regions_of(self.region) for ridge in region.ridges)

    @property
    def families(self) -> tuple[Family, ...]:
        """Every family of orbits."""
        return tuple(family for region in regions_of(self.region) for family in region.families)


def regions_of(region: Region) -> tuple[Region, ...]:
    """A region and all regions inside it."""
    inner = [family.inside for family in region.families if family.inside is not None]
    return (region, *(found for part in inner for found in regions_of(part)))


def _nodes(region: Region) -> tuple[Node, ...]:
    cores = tuple(family.core for family in region.families if family.core is not None)
    return (*region.nodes, *cores)
