"""Where robots and a world meet: free places to start from, and names that sensors look for."""

from collections.abc import Sequence
from typing import Final

from compiler.findings import Findings
from compiler.world.overlap import narrowest, overlap, within
from runtime.scenario import Robot
from runtime.world.model import Polygon, Sensor, Shape, World
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean_one_of, nearest, there_are

LIGHT: Final = "light"
MOST_NAMED: Final = 3
LEEWAY: Final = 1e-3
"""Relative: what widths miss that are measured a degree apart."""


def check_starts(world: World, robots: Sequence[Robot], findings: Findings) -> None:
    """A finding for each robot that would start in a wall, a thing, or another robot."""
    fitting = [robot for robot in robots if _fits(robot, world, findings)]
    for i, robot in enumerate(fitting):
        pose, body = robot.start.pose, robot.body
        if pose is None:
            continue
        path: Path = ("robots", robot.name, "at")
        remedy = "move it, or write 'at: random'"
        if not within(body.shape, pose, world.arena):
            message = f"{robot.name} would not start within the walls of {world.name}"
            findings.error("S327", path, message, remedy)
        for thing in world.things:
            meets = thing.low < body.high and body.low < thing.high
            if meets and overlap(body.shape, pose, thing.shape, thing.pose):
                message = f"{robot.name} would start inside {thing.name}"
                findings.error("S327", path, message, remedy)
        for other in fitting[:i]:
            at, its = other.start.pose, other.body
            meets = its.low < body.high and body.low < its.high
            if at is not None and meets and overlap(body.shape, pose, its.shape, at):
                message = f"{robot.name} would start inside {other.name}"
                findings.error("S327", path, message, remedy)


def _fits(robot: Robot, world: World, findings: Findings) -> bool:
    """Whether there is a place for a robot between the walls; a finding where there is none."""
    wide = narrowest(robot.body.shape)
    floor = narrowest(Shape((), (Polygon(world.arena),)))
    if wide <= floor * (1.0 + LEEWAY):
        return True
    body, file = robot.body.name, robot.body.source.file
    message = (
        f"{robot.name} fits nowhere into {world.name}: its body {body} is {wide:.4g} m wide where "
        f"it is narrowest, and the arena {floor:.4g} m"
    )
    remedy = f"see 'shape' in {file}: a plain number there is in metres, so write '15 cm' for 0.15"
    findings.error("S327", ("robots", robot.name, "architecture"), message, remedy)
    return False


def check_sights(world: World, robots: Sequence[Robot], findings: Findings) -> None:
    """A finding for each thing that a sensor looks for and the world has not."""
    names = [
        LIGHT,
        *(light.name for light in world.lights),
        *(thing.name for thing in world.things),
    ]
    names += [f"{scatter.name}_*" for scatter in world.scattered]
    names += [robot.name for robot in robots]
    copies = {f"{s.name}_{i + 1}" for s in world.scattered for i in range(s.count)}
    for robot in robots:
        for sensor in robot.body.sensors:
            for wanted in sensor.of:
                if wanted not in names and wanted not in copies:
                    _tell(wanted, sensor, robot, world, names, findings)


def _tell(
    wanted: str,
    sensor: Sensor,
    robot: Robot,
    world: World,
    names: Sequence[str],
    findings: Findings,
) -> None:
    message = (
        f"{sensor.name} of {robot.name} looks for '{wanted}' (`of` in {_place(sensor.origin)}), "
        f"and {world.name} has none"
    )
    remedy = _meant(wanted, names) or there_are(names)
    if f"{wanted}_*" in names:
        remedy = f"write '{wanted}_*' for all copies that are scattered"
    findings.error("S322", ("robots", robot.name), message, remedy, key=True)


def _place(origin: str) -> str:
    """The file and line of an origin: `courier.yaml:12`."""
    return origin.rpartition("/")[2].rpartition(":")[0]


def _meant(wanted: str, names: Sequence[str]) -> str:
    """The name that was meant: alike, or for all copies of a scatter, or longer by an ending."""
    bare = {name.removesuffix("_*"): name for name in names}
    alike = nearest(wanted, names) or bare.get(nearest(wanted, bare) or "")
    longer = [name for name in names if name.startswith(f"{wanted}_")]
    return did_you_mean_one_of([alike] if alike else longer[:MOST_NAMED])
