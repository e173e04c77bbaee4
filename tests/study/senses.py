"""How fast rays and light are, beside the figures of shared measurements (docs/adr/0022).

Run: python -m tests.study.senses
"""

import time
from collections.abc import Callable

import numpy as np

from runtime.world.geometry import Plan
from runtime.world.light import LightMap, Sources, light_at
from runtime.world.model import Light, Pose, Shape
from runtime.world.rays import NOBODY, first_hits, least_range, parts_of, spread
from tests.runtime.world.scenes import ALL_ROUND, ARENA, SIDE, outline, polygon, pose

PRISMS, LIGHTS, CELLS, RAYS = 80, 8, (200, 200), 100_000


def least_seconds(call: Callable[[], object], times: int = 10) -> float:
    """Processor time, the least of several: what other processes do counts little."""
    found = []
    for _ in range(times):
        before = time.process_time()
        call()
        found.append(time.process_time() - before)
    return min(found)


def crowded(rng: np.random.Generator) -> tuple[Plan, Sources]:
    """80 convex prisms, some lower than the 8 lights."""
    things = [
        outline(
            f"thing_{index}",
            Shape((), (polygon(rng, float(rng.uniform(0.08, 0.2))),)),
            pose(rng),
            (0.0, float(rng.uniform(0.05, 0.3))),
            float(rng.choice([0.0, 0.0, 0.3])),
        )
        for index in range(PRISMS)
    ]
    plan = Plan(tuple(things), (), ARENA)
    heights = rng.choice([0.17, 0.4, 1.0], LIGHTS)
    lights = [
        Light("", "", Pose(*rng.uniform(0.0, SIDE, 2), 0.0), float(height), 10.0, ALL_ROUND, "")
        for height in heights
    ]
    return plan, Sources(lights, plan.geometry)


def main() -> None:
    """Measure, and print the table."""
    rng = np.random.default_rng(3)
    plan, sources = crowded(rng)
    parts = parts_of(plan.geometry)
    box = (0.0, 0.0, SIDE, SIDE)
    kept = LightMap(parts, sources, box, CELLS, 0.0)
    steps = iter(range(1, 1000))

    def move() -> None:
        poses = plan.geometry.poses[:-1].copy()
        poses[5, 0] += 0.01
        plan.place(poses, next(steps))
        kept.update()

    turns = rng.uniform(0.0, 7.0, RAYS)
    rays = np.column_stack([rng.uniform(0.2, 3.8, (RAYS, 2)), np.cos(turns), np.sin(turns)])
    place, fan = (2.0, 2.0, 0.05), spread(1.0, 9)
    first_hits(parts, rays[:1], reach=10.0, height=0.04, skip=NOBODY)
    least_range(parts, (2.0, 2.0, 0.0), fan, reach=2.0, height=0.04, skip=NOBODY)
    light_at(parts, sources.rows, place)

    whole = least_seconds(lambda: LightMap(parts, sources, box, CELLS, 0.0))
    one = least_seconds(move)
    cast = least_seconds(lambda: first_hits(parts, rays, reach=10.0, height=0.04, skip=NOBODY), 5)
    few = least_seconds(
        lambda: [
            least_range(parts, (2.0, 2.0, 0.0), fan, reach=2.0, height=0.04, skip=NOBODY)
            for _ in range(1000)
        ]
    )
    meter = least_seconds(lambda: [light_at(parts, sources.rows, place) for _ in range(1000)])
    print(f"{PRISMS} prisms, {LIGHTS} lights, {CELLS[0]} x {CELLS[1]} cells; processor time")
    print(f"full map              {1e3 * whole:6.1f} ms   (wanted: 22 at most)")
    print(f"one thing moved       {1e3 * one:6.1f} ms   (wanted: 10 at most)")
    print(f"rays                  {1e-6 * RAYS / cast:6.1f} M/s  (wanted: 2 at least)")
    print(f"a sensor of 9 rays    {1e3 * few:6.1f} us")
    print(f"a meter, {LIGHTS} lights     {1e3 * meter:6.1f} us")


if __name__ == "__main__":
    main()
