"""What keeps a world from being drawn or run: one that was read from a file may hold anything."""

from collections.abc import Iterator, Sequence
from typing import Final

from runtime.world.model import Pose, Shape, Thing, World

FARTHEST: Final = 1e7
"""Metres from the origin: beyond it millimetres can't be told from rounding."""
CORNERS: Final = 3


def faults_of_world(world: World) -> Iterator[str]:
    """What is wrong with a world, each in a sentence; nothing where it is sound."""
    if len(world.arena) < CORNERS:
        yield f"the arena has {len(world.arena)} corners"
    elif not _is_near(world.arena) or any(len({p[k] for p in world.arena}) == 1 for k in (0, 1)):
        yield "the arena has no area, or reaches too far"
    yield from faults_of_things(world.things)
    names = {thing.name for thing in world.things}
    for scatter in world.scattered:
        yield from faults_of_things([scatter.prototype])
    scattered = {scatter.name for scatter in world.scattered}
    for light in world.lights:
        if light.on and light.on not in names and light.on.rpartition("_")[0] not in scattered:
            yield f"the light '{light.name}' stands on '{light.on}', which is not there"
        if not _is_placed(light.pose):
            yield f"the light '{light.name}' is too far away"


def faults_of_things(things: Sequence[Thing]) -> Iterator[str]:
    """What is wrong with things, each in a sentence."""
    if len({thing.name for thing in things}) != len(things):
        yield "two things have one name"
    for thing in things:
        if not is_shape(thing.shape) or not _is_placed(thing.pose):
            yield f"'{thing.name}' has no shape, or is too far away"


def is_shape(shape: Shape) -> bool:
    """Whether it is a footprint: discs with a radius, and polygons with corners, one at least."""
    discs = all(0.0 < d.radius <= FARTHEST and _is_near([(d.x, d.y)]) for d in shape.discs)
    polygons = all(len(p.vertices) >= CORNERS and _is_near(p.vertices) for p in shape.polygons)
    return discs and polygons and bool(shape.discs or shape.polygons)


def _is_placed(pose: Pose) -> bool:
    return _is_near([(pose.x, pose.y)])


def _is_near(points: Sequence[tuple[float, float]]) -> bool:
    return all(abs(x) <= FARTHEST and abs(y) <= FARTHEST for x, y in points)
