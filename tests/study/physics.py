"""The physics of worlds: pushing against a second implementation, speed, and hours in a crowd.

Run it: `python -m tests.study.physics [hours]`, or `make study-world`. The figures of
`docs/adr/0021` come from here; beside them stand those of `world.md`, measured before building.
"""

import math
import sys
import time
from collections.abc import Callable

import numpy as np
import pymunk

from runtime.world.audit import Cause
from runtime.world.model import Body, DriveKind
from runtime.world.world import SimulatedWorld
from tests.runtime.world.quasi_static import pushed
from tests.runtime.world.worlds import STEP, body, box, drive, scatter, simulated, thing, world

HOUR = 3600.0
LOOK = 0.1
"""Seconds between looks at energies."""
BEFORE = {0.01: "3 mm, 2 deg", 0.03: "5 mm, 2 deg", 0.05: "5 mm, 2 deg"}
"""What world.md found with four feet, by offset; its contact friction is not told."""


def crowd(robot: Body, seed: int) -> SimulatedWorld:
    """60 movable and 20 fixed boxes, four walls, and a robot."""
    scattered = [
        scatter("free", 60, box(0.2, 0.15)),
        scatter("fixed", 20, box(0.2, 0.15), fixed=1.0),
    ]
    return simulated(world(size=(6.0, 5.0), scattered=scattered), (robot, None), seed=seed)


def wander(sim: SimulatedWorld, seconds: float, seed: int) -> tuple[float, float]:
    """Drive at random, mostly ahead; the most energy (J) of the robot, and of all boxes."""
    random = np.random.default_rng(seed)
    until = sim.time + seconds
    most = (0.0, 0.0)
    while sim.time < until:
        turn, lasts = random.uniform(-2.0, 2.0), random.uniform(0.3, 2.0)
        ways = (random.uniform(-0.2, 0.5),)
        if len(sim.inhabitants[0].channels) == 3:
            ways = tuple(random.uniform(-0.5, 0.5, 2))
        for _ in range(math.ceil(lasts / LOOK)):
            drive(sim, *ways, turn, seconds=LOOK)
            now = energies(sim)
            most = (max(most[0], now[0]), max(most[1], now[1]))
    return most


def energies(sim: SimulatedWorld) -> tuple[float, float]:
    """Kinetic energy (J) of the robot now, and of all boxes together."""
    own = sim._space.bodies[-1]
    boxes = (
        kinetic(body)
        for body in sim._space.space.bodies
        if body.body_type == pymunk.Body.DYNAMIC and body is not own and not body.is_sleeping
    )
    return kinetic(own), sum(boxes)


def kinetic(body: pymunk.Body) -> float:
    """Energy of motion (J)."""
    return 0.5 * (body.mass * abs(body.velocity) ** 2 + body.moment * body.angular_velocity**2)


def push(offset: float, friction: float) -> tuple[float, float]:
    """Errors of position (mm) and heading (degrees) of a box of 12 x 20 cm pushed by 0.3 m."""
    crate = thing("crate", box(0.12, 0.2), (1.0, 1.0, 0.0), friction=friction)
    robot = body(mass=20.0, friction=1.0)
    sim = simulated(world([crate]), (robot, (0.82, 1.0 + offset, 0.0)))
    drive(sim, 0.05, 0.0, seconds=6.0)
    drive(sim, 0.0, 0.0, seconds=0.2)
    (x, y, heading), (reached, *_) = sim.poses().tolist()
    corners = crate.shape.polygons[0].vertices
    start, gone = (0.82, 1.0 + offset), reached - 0.82
    wanted = pushed(corners, (1.0, 1.0, 0.0), start, 0.12, gone, friction, steps=800)
    return 1e3 * math.dist((x, y), wanted[:2]), math.degrees(abs(heading - wanted[2]))


def per_second(sim: SimulatedWorld, run: Callable[[], object]) -> float:
    """Steps of a scenario per second of the processor."""
    steps, began = sim.steps, time.process_time()
    run()
    return (sim.steps - steps) / (time.process_time() - began)


def speeds() -> None:
    """Steps per processor second, and what of a step is not the physics."""
    sim = crowd(body(), 1)
    wander(sim, 2.0, 1)
    rate = per_second(sim, lambda: wander(sim, 60.0, 1))
    print(f"60 + 20 boxes, sleeping on   {rate:8.0f} steps/s  {rate * STEP:5.0f} x real time")
    sim = crowd(body(), 1)
    sim._space.space.sleep_time_threshold = math.inf
    rate = per_second(sim, lambda: wander(sim, 20.0, 1))
    print(f"60 + 20 boxes, all awake     {rate:8.0f} steps/s  {rate * STEP:5.0f} x real time")
    crate = thing("crate", box(0.12, 0.2), (1.0, 1.0, 0.0))
    sim = simulated(world([crate], size=(40.0, 3.0)), (body(), (0.8, 1.01, 0.0)))
    rate = per_second(sim, lambda: drive(sim, 0.2, 0.0, seconds=60.0))
    print(f"one box that is pushed       {rate:8.0f} steps/s  {rate * STEP:5.0f} x real time")
    sim = simulated(world(), (body(), (2.0, 1.5, 0.0)))
    drive(sim, 0.1, 1.0, seconds=0.5)
    all_ = per_second(sim, lambda: drive(sim, 0.1, 1.0, seconds=60.0))
    began = time.process_time()
    for _ in range(14_400):
        sim._space.space.step(STEP)
    alone = (time.process_time() - began) / 14_400
    print(f"a robot alone: {1e6 / all_:.1f} µs a step, {1e6 * alone:.1f} of them physics")


def main(hours: int) -> None:
    """Print all tables."""
    print("a box pushed by 0.3 m: errors against 144 pressure points (wanted: 6 mm, 3 deg at most)")
    print("  contact friction  offset    here              world.md")
    for friction in (0.0, 0.06, 0.36):
        for offset, before in BEFORE.items():
            away, turned = push(offset, friction)
            print(
                f"  {friction:16.2f}  {1e3 * offset:3.0f} mm  {away:5.1f} mm, {turned:3.1f} deg"
                f"  {before}"
            )
    speeds()
    bodies = {
        "round, two wheels": body(),
        "rectangular, two wheels": body(shape=box(0.3, 0.2)),
        "round, holonomic": body(DriveKind.HOLONOMIC),
        "rectangular, holonomic": body(DriveKind.HOLONOMIC, shape=box(0.3, 0.2)),
    }
    for seed, (name, robot) in enumerate(list(bodies.items())[:hours], 1):
        sim = crowd(robot, seed)
        own, boxes = wander(sim, HOUR, seed)
        found = sim.audit()
        stuck = sum(jam.end - jam.begin for jam in found.jams)
        wedged = sum(jam.cause is Cause.WEDGED for jam in found.jams)
        print(
            f"an hour, {name}: {1e3 * found.depth:.2f} mm deep at the worst, {found.pair} "
            f"(wanted: 2; world.md: 1.4); {len(found.jams)} jams, {wedged} of them wedged, "
            f"{stuck:.0f} s in all; energy at most {own:.3f} J of the robot, {boxes:.3f} of boxes",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4)
