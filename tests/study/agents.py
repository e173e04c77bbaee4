"""The two agents of the thesis's section 2.5, with a bumper alone: who explores, who gets stuck?

Run it: `python -m tests.study.agents [--worlds 8] [--minutes 60]`. Beside a prototype of the same
study (8 worlds, one hour): the walker covered 89 to 100 % of the reachable cells and was never
stuck; the cart covered 14 to 66 %, and its longest stuck spell was 2,272 to 3,522 s.
"""

import argparse
import dataclasses
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from runtime.arrays import Array, Booleans
from runtime.world.model import Pose, Shape
from specc.loading import compile_scenario_spec
from tests.study.paradigms import started

ROOT = Path(__file__).parents[2]
CELL = 0.2
"""Metres: the width of a cell that can be covered."""
FINE = 8
"""So many points along a cell tell whether it can be reached."""
WINDOW = 30.0
"""Seconds; with less travel than TRAVEL in them an agent is stuck."""
TRAVEL = 0.25
LOOK = 0.5
"""Seconds between two looks at where it is."""
RADII = {"random_walker": 0.15, "bumping_cart": 0.12}
"""Metres: of the round body; of the largest circle within the rectangular one."""


class Report(NamedTuple):
    """covered: share of the reachable cells. stuck: seconds of the longest stuck spell."""

    covered: float
    stuck: float


def explored(agent: str, seed: int, seconds: float) -> Report:
    """What one agent does in one world."""
    spec = ROOT / "specs" / "scenarios" / f"{agent}.yaml"
    scenario = dataclasses.replace(compile_scenario_spec(spec).scenario, seed=seed)
    world, scheduler = started(scenario)
    arena = np.array(scenario.world.arena)
    free = free_points(arena, [(t.shape, t.pose) for t in world.layout.things], RADII[agent])
    each = round(LOOK / scenario.step)
    places = np.empty((round(seconds / LOOK) + 1, 2))
    places[0] = world.poses()[-1, :2]
    for k in range(1, len(places)):
        scheduler.run(each)
        places[k] = world.poses()[-1, :2]
    return Report(covered(places - arena.min(axis=0), free), longest_stuck(places))


def free_points(arena: Array, things: list[tuple[Shape, Pose]], radius: float) -> Booleans:
    """(n, m) where the middle of a disc can be, on a grid of points CELL / FINE apart.

    The arena is a rectangle. The points stand in the middles of their squares.
    """
    low, high = arena.min(axis=0), arena.max(axis=0)
    fine = CELL / FINE
    xs, ys = (np.arange(a + fine / 2, b, fine) for a, b in zip(low, high, strict=True))
    x, y = np.meshgrid(xs, ys, indexing="ij")
    edge = np.minimum.reduce([x - low[0], high[0] - x, y - low[1], high[1] - y])
    free: Booleans = edge >= radius
    for shape, pose in things:
        cosine, sine = np.cos(pose.heading), np.sin(pose.heading)
        for polygon in shape.polygons:
            corners = np.array(polygon.vertices) @ np.array([[cosine, sine], [-sine, cosine]])
            free &= distance(x, y, corners + np.array([pose.x, pose.y])) >= radius
    return free


def distance(x: Array, y: Array, corners: Array) -> Array:
    """From points to a convex polygon (counter-clockwise); 0 inside."""
    inside = np.ones(x.shape, dtype=bool)
    least = np.full(x.shape, np.inf)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along_x, along_y = bx - ax, by - ay
        inside &= along_x * (y - ay) - along_y * (x - ax) >= 0.0
        share = ((x - ax) * along_x + (y - ay) * along_y) / (along_x**2 + along_y**2)
        share = np.clip(share, 0.0, 1.0)
        least = np.minimum(least, np.hypot(x - ax - share * along_x, y - ay - share * along_y))
    return np.where(inside, 0.0, least)


def covered(places: Array, free: Booleans) -> float:
    """The share of the cells that hold a point reachable from the start, and were visited."""
    parts, _ = ndimage.label(free)
    at = np.minimum((places[0] * FINE / CELL).astype(int), np.array(free.shape) - 1)
    near = parts[max(at[0] - 2, 0) : at[0] + 3, max(at[1] - 2, 0) : at[1] + 3]
    reached = np.isin(parts, near[near > 0])
    cells = {(int(i) // FINE, int(j) // FINE) for i, j in np.argwhere(reached)}
    visited = {(int(i), int(j)) for i, j in (places / CELL).astype(int)}
    return len(cells & visited) / len(cells)


def longest_stuck(places: Array) -> float:
    """Seconds of the longest spell in which every window of WINDOW has less than TRAVEL of way."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    window = round(WINDOW / LOOK)
    is_stuck = way[window:] - way[:-window] < TRAVEL
    longest = run = 0
    for stuck in is_stuck.tolist():
        run = run + 1 if stuck else 0
        longest = max(longest, run)
    return (longest - 1) * LOOK + WINDOW if longest else 0.0


def main() -> None:
    """Print a line for each agent and world."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--worlds", type=int, default=8)
    parser.add_argument("--minutes", type=float, default=60.0)
    given = parser.parse_args()
    for agent in RADII:
        for seed in range(given.worlds):
            report = explored(agent, seed, 60.0 * given.minutes)
            print(
                f"{agent:14} world {seed}: covers {100.0 * report.covered:3.0f} %, "
                f"stuck for {report.stuck:5.0f} s",
                flush=True,
            )


if __name__ == "__main__":
    main()
