"""Worlds in SI: the arena, the things in it, its lights."""

import math
from typing import Final

from compiler.findings import Findings
from compiler.lower_parts import origin_of
from compiler.quantities import si_value
from compiler.world.outside import check_inside
from compiler.world.shapes import (
    STRAIGHT,
    Corners,
    area_of,
    backwards,
    heights_of,
    length,
    points_of,
    pose_of,
    positive,
    shape_of,
)
from compiler.world.size import check_heights
from runtime.world.model import Light, Pose, Scatter, Thing, World
from spec_schema.faults import UnitFault
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import parse_quantity, parse_unit
from spec_schema.world import ArenaSpec, LightSpec, ScatterSpec, ThingSpec, WorldSpec

LUX: Final = parse_unit("lx")


def lower_world(spec: WorldSpec, loaded: Loaded, findings: Findings) -> World:
    """The world in SI, with a finding for each mistake."""
    arena = _arena(spec.arena, findings)
    things = tuple(_thing(name, one, loaded, findings) for name, one in spec.things.items())
    scattered = tuple(_scatter(name, one, loaded, findings) for name, one in spec.scatter.items())
    _refuse_repeated_names(spec, findings)
    lights = tuple(_light(name, one, spec, loaded, findings) for name, one in spec.lights.items())
    ambient = si_value(spec.ambient, LUX, ("ambient",), findings) or 0.0
    if ambient < 0.0:
        message = f"there is no less light than none (got {spec.ambient})"
        findings.error("S212", ("ambient",), message, "write 0 or more")
    world = World(
        name=spec.name,
        about=spec.about or "",
        arena=arena,
        wall_friction=spec.arena.friction,
        ambient=max(ambient, 0.0),
        things=things,
        scattered=scattered,
        lights=lights,
        source=origin_of(loaded),
    )
    if not findings.has_errors:
        check_inside(world, findings)
        check_heights(world, findings)
    return world


def _arena(spec: ArenaSpec, findings: Findings) -> Corners:
    path: Path = ("arena", "box")
    if spec.box is not None:
        wide, deep = (
            positive(side, "m", "a side of the arena", (*path, i), findings)
            for i, side in enumerate(spec.box)
        )
        return ((0.0, 0.0), (wide, 0.0), (wide, deep), (0.0, deep))
    path = ("arena", "polygon")
    corners = points_of(spec.polygon or (), path, findings)
    crossing = _crossing(corners)
    if crossing is not None:
        one, two = crossing
        message = f"the arena's walls cross: those after its corners {one + 1} and {two + 1}"
        findings.error("S326", path, message, "write the corners in their order round the arena")
    elif abs(area_of(corners)) < STRAIGHT:
        findings.error("S326", path, "the arena has no floor", "move its corners apart")
    elif area_of(corners) < 0.0:
        message = "the corners go round clockwise"
        remedy = f"write them the other way round: {backwards(corners)}"
        findings.error("S326", path, message, remedy)
    return corners


def _crossing(corners: Corners) -> tuple[int, int] | None:
    """Two walls that cross or touch, but for those that share a corner."""
    count = len(corners)
    for i in range(count):
        for j in range(i + 2, count):
            if i == 0 and j == count - 1:
                continue
            if _cross(corners[i], corners[i + 1], corners[j], corners[(j + 1) % count]):
                return i, j
    return None


def _cross(
    a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]
) -> bool:
    """Whether the segments ab and cd have a point in common."""
    sides = [_side(a, b, c), _side(a, b, d), _side(c, d, a), _side(c, d, b)]
    if all(side == 0.0 for side in sides):
        return all(
            max(min(a[k], b[k]), min(c[k], d[k])) <= min(max(a[k], b[k]), max(c[k], d[k]))
            for k in (0, 1)
        )
    return sides[0] * sides[1] <= 0.0 and sides[2] * sides[3] <= 0.0


def _side(a: tuple[float, float], b: tuple[float, float], p: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def _thing(name: str, spec: ThingSpec, loaded: Loaded, findings: Findings) -> Thing:
    path: Path = ("things", name)
    pose = pose_of(spec.at, (*path, "at"), findings)
    return _object(name, spec, pose, path, loaded, findings)


def _object(
    name: str,
    spec: ThingSpec | ScatterSpec,
    pose: Pose,
    path: Path,
    loaded: Loaded,
    findings: Findings,
) -> Thing:
    low, high = heights_of(spec.height, (*path, "height"), findings)
    return Thing(
        name=name,
        shape=shape_of(spec.shape, (*path, "shape"), findings),
        pose=pose,
        is_fixed=spec.fixed,
        mass=positive(spec.mass, "kg", "a mass", (*path, "mass"), findings),
        friction=spec.friction,
        floor=spec.floor,
        low=low,
        high=high,
        transmittance=spec.transmittance,
        origin=loaded.origin(path),
    )


def _scatter(name: str, spec: ScatterSpec, loaded: Loaded, findings: Findings) -> Scatter:
    path: Path = ("scatter", name)
    gap = length(spec.gap, (*path, "gap"), findings)
    if gap < 0.0:
        message = f"a gap can't be below 0 (got {spec.gap})"
        findings.error("S212", (*path, "gap"), message, "write 'gap: 5 cm'")
    area = None
    if spec.area is not None:
        low, high = points_of(spec.area, (*path, "area"), findings)
        area = (*low, *high)
        if not (low[0] < high[0] and low[1] < high[1]):
            message = "an area goes from its lower left to its upper right corner"
            findings.error("S212", (*path, "area"), message, "write 'area: [[0, 0], [2, 2]]'")
    return Scatter(
        name=name,
        count=spec.count,
        prototype=_object(name, spec, Pose(0.0, 0.0, 0.0), path, loaded, findings),
        sizes=(spec.sizes[0], spec.sizes[1]),
        fixed=1.0 if spec.fixed else spec.fixed_share,
        gap=max(gap, 0.0),
        area=area,
        origin=loaded.origin(path),
    )


def _refuse_repeated_names(spec: WorldSpec, findings: Findings) -> None:
    copies = {f"{name}_{i + 1}" for name, one in spec.scatter.items() for i in range(one.count)}
    for section in ("things", "lights"):
        for name in getattr(spec, section):
            taken = name in copies or (section == "lights" and name in spec.things)
            if taken:
                message = f"'{name}' is the name of something else in this world"
                findings.error("S201", (section, name), message, "rename one of them", key=True)
    for name in spec.scatter:
        if name in spec.things:
            message = f"'{name}' is declared twice: here and under 'things'"
            findings.error("S201", ("scatter", name), message, "rename one of them", key=True)


def _light(
    name: str, spec: LightSpec, world: WorldSpec, loaded: Loaded, findings: Findings
) -> Light:
    path: Path = ("lights", name)
    if spec.on is not None and spec.on not in world.things:
        known = list(world.things)
        remedy = did_you_mean(spec.on, known) or there_are(known)
        if spec.on in world.scatter:
            remedy = "only a thing with a place of its own can carry a light"
        message = f"no thing is named '{spec.on}'"
        findings.error("S322", (*path, "on"), message, remedy)
    if isinstance(spec.power, str) and spec.power.rstrip().endswith("lm"):
        _refuse_lumen(spec.power, (*path, "power"), findings)
    return Light(
        name=name,
        on=spec.on or "",
        pose=pose_of(spec.at, (*path, "at"), findings),
        height=positive(spec.height, "m", "a height", (*path, "height"), findings),
        power=positive(spec.power, "cd", "a power", (*path, "power"), findings),
        cone=positive(spec.cone, "rad", "a cone", (*path, "cone"), findings),
        origin=loaded.origin(path),
    )


def _refuse_lumen(power: str, path: Path, findings: Findings) -> None:
    """Lumen and candela are alike in dimension: what a light gives in all, and in a direction."""
    try:
        candela = parse_quantity(power).value / (4.0 * math.pi)
    except UnitFault:
        return  # which is told with its unit
    message = "the power of a light is in candela, which is lumen per steradian"
    remedy = f"write '{candela:.3g} cd' if it shines all round: 1 cd all round is 4 pi lm"
    findings.error("S125", path, message, remedy)
