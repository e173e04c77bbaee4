"""The physics of worlds: pushing against a second implementation, depths, speed, and its cost.

Run it: `python -m tests.study.physics [hours]`. The figures of `docs/adr/0021` come from here.
"""

import math
import sys
import time
from collections.abc import Callable

import numpy as np

from runtime.world.model import Body, DriveKind
from runtime.world.world import SimulatedWorld
from tests.runtime.world.quasi_static import pushed
from tests.runtime.world.worlds import STEP, body, box, drive, scatter, simulated, thing, world

HOUR = 3600.0


def crowd(robot: Body, seed: int) -> SimulatedWorld:
    """60 movable and 20 fixed boxes, four walls, and a robot."""
    scattered = [
        scatter("free", 60, box(0.2, 0.15)),
        scatter("fixed", 20, box(0.2, 0.15), fixed=1.0),
    ]
    return simulated(world(size=(6.0, 5.0), scattered=scattered), (robot, None), seed=seed)


def wander(sim: SimulatedWorld, seconds: float, seed: int) -> None:
    """Drive at random, mostly ahead."""
    random = np.random.default_rng(seed)
    until = sim.time + seconds
    while sim.time < until:
        turn, lasts = random.uniform(-2.0, 2.0), random.uniform(0.3, 2.0)
        if len(sim.inhabitants[0].channels) == 2:
            drive(sim, random.uniform(-0.2, 0.5), turn, seconds=lasts)
        else:
            drive(sim, *random.uniform(-0.5, 0.5, 2), turn, seconds=lasts)


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


def per_second(sim: SimulatedWorld, run: Callable[[], None]) -> float:
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
    print("friction of the contact, offset: errors of a box pushed by 0.3 m")
    for friction in (0.0, 0.06, 0.36):
        for offset in (0.01, 0.03, 0.05):
            away, turned = push(offset, friction)
            print(f"  {friction:4.2f}  {1e3 * offset:2.0f} mm   {away:5.1f} mm  {turned:4.1f} deg")
    speeds()
    bodies = {
        "round, two wheels": body(),
        "rectangular, two wheels": body(shape=box(0.3, 0.2)),
        "round, holonomic": body(DriveKind.HOLONOMIC),
        "rectangular, holonomic": body(DriveKind.HOLONOMIC, shape=box(0.3, 0.2)),
    }
    for seed, (name, robot) in enumerate(list(bodies.items())[:hours], 1):
        sim = crowd(robot, seed)
        wander(sim, HOUR, seed)
        found = sim.audit()
        stuck = sum(jam.end - jam.begin for jam in found.jams)
        print(
            f"an hour, {name}: {1e3 * found.depth:.2f} mm deep at the worst, {found.pair}; "
            f"{len(found.jams)} jams, {stuck:.0f} s"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4)
