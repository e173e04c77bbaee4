"""Things, lights and areas that lie where nothing can: outside of the walls, or in one another."""

from itertools import combinations

from compiler.findings import Findings
from compiler.world.overlap import overlap, overlap_floor, within
from compiler.world.shapes import HERE, Corners
from runtime.world.model import Disc, Light, Polygon, Scatter, Shape, Thing, World
from spec_schema.places import Path


def check_inside(world: World, findings: Findings) -> None:
    """A finding for each thing, light and area of a scatter that is not where the floor is."""
    for thing in world.things:
        _check_thing(thing, world, findings)
    for one, other in combinations(world.things, 2):
        _check_apart(one, other, findings)
    for light in world.lights:
        _check_light(light, world, findings)
    for scatter in world.scattered:
        _check_area(scatter, world, findings)


def _check_thing(thing: Thing, world: World, findings: Findings) -> None:
    """What is fixed may stand in a wall, as a cupboard does; what moves would be jammed there."""
    path: Path = ("things", thing.name, "at")
    if not overlap_floor(thing.shape, thing.pose, world.arena):
        message = f"{thing.name} lies outside the walls of {world.name}"
        findings.error("S327", path, message, _where(world.arena))
    elif not thing.is_fixed and not within(thing.shape, thing.pose, world.arena):
        message = f"{thing.name} would start in a wall of {world.name}"
        findings.error("S327", path, message, "move it, or write 'fixed: true'")


def _check_apart(one: Thing, other: Thing, findings: Findings) -> None:
    """What is fixed may be made of several things; what moves would be pushed out at once."""
    meets = one.low < other.high and other.low < one.high
    if one.is_fixed and other.is_fixed:
        return
    if meets and overlap(one.shape, one.pose, other.shape, other.pose):
        moving, still = (other, one) if one.is_fixed else (one, other)
        message = f"{moving.name} would start inside {still.name}"
        findings.error("S327", ("things", moving.name, "at"), message, "move one of them")


def _check_light(light: Light, world: World, findings: Findings) -> None:
    if light.on:
        return
    spot = Shape((Disc(0.0, 0.0, 0.0),), ())
    if not within(spot, light.pose, world.arena):
        message = f"{light.name} shines outside the walls of {world.name}"
        findings.error("S327", ("lights", light.name, "at"), message, _where(world.arena))


def _check_area(scatter: Scatter, world: World, findings: Findings) -> None:
    if scatter.area is None:
        return
    left, low, right, high = scatter.area
    area = Shape((), (Polygon(((left, low), (right, low), (right, high), (left, high))),))
    if left < right and low < high and not overlap_floor(area, HERE, world.arena):
        message = f"the area of {scatter.name} has no floor within the walls of {world.name}"
        path: Path = ("scatter", scatter.name, "area")
        findings.error("S327", path, message, _where(world.arena))


def _where(arena: Corners) -> str:
    """From where to where the floor goes."""
    xs, ys = ([corner[axis] for corner in arena] for axis in (0, 1))
    spans = [f"{name} from {min(v):g} to {max(v):g} m" for name, v in (("x", xs), ("y", ys))]
    return f"the floor is {spans[0]} and {spans[1]}"
