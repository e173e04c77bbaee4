"""The light on the floor at the end of a run, fine enough for a poster's shadows."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.scenario import Robot, Scenario
from runtime.world.geometry import Outline, Plan
from runtime.world.light import LightMap, Sources
from runtime.world.model import Pose, Thing
from runtime.world.rays import parts_of
from specc.figures.scene import Glow

CELLS: Final = 800
"""Along the longer side of the floor."""


def last_light(
    scenario: Scenario, things: Sequence[Thing], poses: Array, time: float
) -> Glow | None:
    """The light with everything at `poses` (things + robots, 3); None where there are no lights."""
    world = scenario.world
    if not world.lights or not np.isfinite(poses).all():
        return None
    count, arena = len(things), np.array(world.arena, dtype=np.float64)
    plan = Plan(
        tuple(map(_of_thing, things, poses[:count])),
        tuple(map(_of_robot, scenario.robots, poses[count:])),
        arena,
    )
    low, high = arena.min(axis=0), arena.max(axis=0)
    wide, deep = (high - low).tolist()
    cells = [max(round(CELLS * side / max(wide, deep)), 1) for side in (wide, deep)]
    shone = LightMap(
        parts_of(plan.geometry),
        Sources(world.lights, plan.geometry),
        (*low.tolist(), *high.tolist()),
        (cells[0], cells[1]),
        world.ambient,
    )
    return Glow(shone.xs, shone.ys, np.array([time]), shone.lux[np.newaxis].astype(np.float32))


def _of_thing(thing: Thing, pose: Array) -> Outline:
    return Outline(thing.name, thing.shape, _pose(pose), thing.low, thing.high, thing.transmittance)


def _of_robot(robot: Robot, pose: Array) -> Outline:
    body = robot.body
    return Outline(robot.name, body.shape, _pose(pose), body.low, body.high, 0.0)


def _pose(at: Array) -> Pose:
    x, y, heading = at.tolist()
    return Pose(x, y, heading)
