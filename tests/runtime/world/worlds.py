"""Small worlds by hand, for the tests of the physics."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from runtime.program import Origin
from runtime.world.drive import CHANNELS
from runtime.world.model import (
    Body,
    Disc,
    Drive,
    DriveKind,
    Polygon,
    Pose,
    Scatter,
    Shape,
    Thing,
    World,
)
from runtime.world.world import Inhabitant, SimulatedWorld

STEP = 1.0 / 240.0
NOWHERE = Origin("", "", "")


def box(length: float, width: float) -> Shape:
    x, y = length / 2.0, width / 2.0
    return Shape((), (Polygon(((-x, -y), (x, -y), (x, y), (-x, y))),))


def round_(radius: float) -> Shape:
    return Shape((Disc(0.0, 0.0, radius),), ())


def thing(
    name: str,
    shape: Shape,
    pose: tuple[float, float, float],
    *,
    is_fixed: bool = False,
    mass: float = 1.0,
    friction: float = 0.3,
    floor: float = 0.4,
    heights: tuple[float, float] = (0.0, 0.3),
) -> Thing:
    low, high = heights
    return Thing(name, shape, Pose(*pose), is_fixed, mass, friction, floor, low, high, 0.0, "")


def body(
    kind: DriveKind = DriveKind.DIFFERENTIAL,
    *,
    shape: Shape | None = None,
    mass: float = 3.0,
    traction: float = 0.8,
    friction: float = 0.2,
    high: float = 0.1,
) -> Body:
    drive = Drive(kind, 0.2, traction, 0.5, 3.0, 2.0, 20.0)
    return Body("body", "", shape or round_(0.12), mass, friction, 0.0, high, drive, (), NOWHERE)


def world(
    things: Sequence[Thing] = (),
    *,
    size: tuple[float, float] = (4.0, 3.0),
    scattered: Sequence[Scatter] = (),
) -> World:
    x, y = size
    arena = ((0.0, 0.0), (x, 0.0), (x, y), (0.0, y))
    return World("world", "", arena, 0.3, 0.0, tuple(things), tuple(scattered), (), NOWHERE)


def simulated(
    model: World,
    *robots: tuple[Body, tuple[float, float, float] | None],
    seed: int = 1,
    step: float = STEP,
) -> SimulatedWorld:
    inhabitants = [
        Inhabitant(f"r{k}", part, None if at is None else Pose(*at), CHANNELS[part.drive.kind])
        for k, (part, at) in enumerate(robots)
    ]
    return SimulatedWorld(model, inhabitants, step, seed)


def drive(sim: SimulatedWorld, *values: float, seconds: float, robot: int = 0) -> None:
    """Command a robot and let time pass."""
    sim.command(robot, np.array(values), np.ones(len(values), dtype=np.bool_))
    for _ in range(math.ceil(seconds / sim.step - 1e-9)):
        sim.advance()


def scatter(
    name: str,
    count: int,
    shape: Shape,
    *,
    fixed: float = 0.0,
    sizes: tuple[float, float] = (0.7, 1.3),
    gap: float = 0.05,
) -> Scatter:
    prototype = replace(thing(name, shape, (0.0, 0.0, 0.0)), mass=1.0)
    return Scatter(name, count, prototype, sizes, fixed, gap, None, "")
