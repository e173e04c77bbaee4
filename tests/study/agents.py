"""The two agents of the thesis's section 2.5, with a bumper alone: who explores, who gets stuck?

Run it: `python -m tests.study.agents [--worlds 8] [--minutes 60] [--workers 2]`.
What it prints are the tables of docs/agents.md; `--posters DIRECTORY --minutes 10` draws its
pictures.

*Covered*: the share of the cells, 20 cm wide, that the middle of the agent can reach (for the cart:
that of the largest circle within it) and did reach.
*Stuck*: the longest spell in which every window of 30 s has less than 25 cm of way, summed over
looks half a second apart: so it hardly moves at all.
*Hemmed in*: the longest spell in which every window of 30 s lies within 1 m: so it may well drive,
but gets nowhere. Whoever is stuck is hemmed in.
*Let go*: how far the agent gets in 2 s, if it then does nothing but drive forward: far, where it
was its rule that held it.
"""

import argparse
import dataclasses
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from runtime.arrays import Array, Booleans
from runtime.run import run
from runtime.scenario import Scenario
from runtime.start import started
from runtime.world.model import Pose, Shape
from runtime.world.world import SimulatedWorld
from specc.drawn import write_picture
from specc.figures.style_names import Style
from specc.figures.world import draw_world
from specc.loading import compile_scenario_spec
from specc.scenarios.pictured import pictured

ROOT = Path(__file__).parents[2]
CELL = 0.2
"""Metres: the width of a cell that can be covered."""
FINE = 8
"""So many points along a cell tell whether it can be reached."""
WINDOW = 30.0
"""Seconds: by how it moves in so long, it is judged."""
TRAVEL = 0.25
"""Metres of way in a window: with less it is stuck."""
POCKET = 1.0
"""Metres across the box of a window: with less it is hemmed in."""
LOOK = 0.5
"""Seconds between two looks at where it is."""
RELEASE = 2.0
"""Seconds of driving forward at the end."""


class Agent(NamedTuple):
    """What is run, and what came out of it before.

    scenario: its file. radius: of the largest circle within it (m). heed: its control, or None.
    """

    scenario: str
    radius: float
    heed: float | None
    before: str


AGENTS = {
    "walker": Agent("random_walker", 0.15, None, "89 to 100 % | in 0 of 8 |"),
    "cart": Agent(
        "bumping_cart",
        0.12,
        None,
        "14 to 66 % | in 8 of 8, for up to 3,522 s | | 15 to 49 cm in 7 of 8",
    ),
    "deaf cart": Agent("bumping_cart", 0.12, 0.0, "not tried"),
}
"""`before`: what a prototype of this study found, another engine with other worlds. The deaf cart
does not feel what it hits while it backs up and turns."""


class Report(NamedTuple):
    """What became of it.

    covered: a share. stuck, hemmed: seconds of the longest spell. let_go: metres. cpu: seconds.
    """

    covered: float
    stuck: float
    hemmed: float
    let_go: float
    cpu: float


def scenario_of(agent: Agent, seed: int) -> Scenario:
    """What one agent does in one world."""
    spec = ROOT / "specs" / "scenarios" / f"{agent.scenario}.yaml"
    found = dataclasses.replace(compile_scenario_spec(spec).scenario, seed=seed)
    return found if agent.heed is None else heeding(found, agent.heed)


def heeding(scenario: Scenario, heed: float) -> Scenario:
    """The same, with another value of the control `heed` of its one node."""
    robot = scenario.robots[0]
    node = robot.architecture.nodes[0]
    inputs = tuple(
        dataclasses.replace(each, value=heed) if each.entry == "heed" else each
        for each in node.inputs
    )
    nodes = (dataclasses.replace(node, inputs=inputs),)
    architecture = dataclasses.replace(robot.architecture, nodes=nodes)
    robots = (dataclasses.replace(robot, architecture=architecture),)
    return dataclasses.replace(scenario, robots=robots)


def explored(name: str, seed: int, seconds: float) -> Report:
    """What became of one agent in one world."""
    before = os.times().user
    agent = AGENTS[name]
    scenario = scenario_of(agent, seed)
    begun = started(scenario)
    world, scheduler = begun.world, begun.scheduler
    arena = np.array(scenario.world.arena)
    free = free_points(arena, [(t.shape, t.pose) for t in world.layout.things], agent.radius)
    each = round(LOOK / scenario.step)
    places = np.empty((round(seconds / LOOK) + 1, 2))
    places[0] = world.poses()[-1, :2]
    for k in range(1, len(places)):
        scheduler.run(each)
        places[k] = world.poses()[-1, :2]
    return Report(
        covered(places - arena.min(axis=0), free),
        longest(way_of(places) < TRAVEL),
        longest(box_of(places) < POCKET),
        released(world, scenario),
        os.times().user - before,
    )


def released(world: SimulatedWorld, scenario: Scenario) -> float:
    """Metres that it gets in RELEASE, driven forward at its fastest."""
    drive = scenario.robots[0].body.drive
    channels = scenario.robots[0].architecture.channels
    ahead = ("base.speed", "base.forward")
    forward = np.array([drive.speed if each.name in ahead else 0.0 for each in channels])
    before = world.poses()[-1, :2]
    world.command(0, forward, np.ones(len(channels), dtype=bool))
    for _ in range(round(RELEASE / scenario.step)):
        world.advance()
    return float(np.hypot(*(world.poses()[-1, :2] - before)))


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


def way_of(places: Array) -> Array:
    """Metres of way in each window, by its first look."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    window = round(WINDOW / LOOK)
    found: Array = way[window:] - way[:-window]
    return found


def box_of(places: Array) -> Array:
    """Metres across the box (its diagonal) that holds each window, by its first look."""
    looks = np.lib.stride_tricks.sliding_window_view(places, round(WINDOW / LOOK) + 1, axis=0)
    found: Array = np.hypot(*np.ptp(looks, axis=2).T)
    return found


def longest(holds: Booleans) -> float:
    """Seconds of the longest spell in which it holds of every window."""
    most = row = 0
    for one in holds.tolist():
        row = row + 1 if one else 0
        most = max(most, row)
    return (most - 1) * LOOK + WINDOW if most else 0.0


def table(worlds: int, minutes: float, workers: int) -> Iterator[str]:
    """Markdown, as docs/agents.md has it: two tables, a row for each world, and the CPU time."""
    cpu: dict[str, float] = {}
    with ProcessPoolExecutor(workers) as pool:
        yield from rows(("walker", "cart"), worlds, minutes, pool, cpu)
        yield f"| prototype | {AGENTS['walker'].before} | {AGENTS['cart'].before} |"
        yield ""
        yield from rows(("deaf cart",), worlds, minutes, pool, cpu)
    yield ""
    yield "CPU time: " + ", ".join(f"{took:.0f} s for the {name}" for name, took in cpu.items())


def rows(
    names: Sequence[str], worlds: int, minutes: float, pool: Executor, cpu: dict[str, float]
) -> Iterator[str]:
    """A table of agents side by side: its head, each world, and what they come to.

    cpu: gets the seconds that each agent took. How far the last agent gets if let go is told.
    """
    heads = [f"{name} covers | stuck for | hemmed in for" for name in names]
    yield f"| world | {' | '.join(heads)} | let go, it moves |"
    yield "|---" * (3 * len(names) + 2) + "|"
    jobs = [(name, seed) for seed in range(worlds) for name in names]
    found = pool.map(explored, *zip(*jobs, strict=True), [60.0 * minutes] * len(jobs))
    told: dict[str, list[Report]] = {name: [] for name in names}
    for seed in range(worlds):
        for name in names:
            told[name].append(next(found))
        row = [cells(told[name][-1]) for name in names]
        let_go = told[names[-1]][-1].let_go
        yield f"| {seed} | {' | '.join(row)} | {100.0 * let_go:.0f} cm |"
    yield f"| all | {' | '.join(span(each) for each in told.values())} | |"
    cpu |= {name: sum(one.cpu for one in each) for name, each in told.items()}


def cells(one: Report) -> str:
    """Of one agent in one world."""
    return f"{100.0 * one.covered:.0f} % | {one.stuck:,.0f} s | {one.hemmed:,.0f} s"


def span(told: Sequence[Report]) -> str:
    """The least and the largest share that was covered; in how many worlds it was stuck, hemmed."""
    shares = [100.0 * one.covered for one in told]
    stuck = counted([one.stuck for one in told])
    hemmed = counted([one.hemmed for one in told])
    return f"{min(shares):.0f} to {max(shares):.0f} % | {stuck} | {hemmed}"


def counted(spells: Sequence[float]) -> str:
    """In how many worlds, and the longest of their spells."""
    count = sum(one > 0.0 for one in spells)
    return f"in {count} of {len(spells)}" + (f", for up to {max(spells):,.0f} s" if count else "")


def posters(directory: Path, minutes: float, seeds: dict[str, int]) -> None:
    """A poster of each agent that is named, in the world of that seed."""
    directory.mkdir(parents=True, exist_ok=True)
    for name, seed in seeds.items():
        scenario = dataclasses.replace(
            scenario_of(AGENTS[name], seed), duration=60.0 * minutes, about=f"World {seed}."
        )
        poster = draw_world(*pictured(run(scenario), ()))
        for suffix in ("png", "svg"):
            file = directory / f"{AGENTS[name].scenario}.{suffix}"
            write_picture(poster, file, Style.SCREEN)


def main() -> None:
    """Print the table, or draw posters."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--worlds", type=int, default=8)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--posters", type=Path)
    given = parser.parse_args()
    if given.posters is not None:
        posters(given.posters, given.minutes, {"walker": 0, "cart": 0})
        return
    for line in table(given.worlds, given.minutes, given.workers):
        print(line, flush=True)


if __name__ == "__main__":
    main()
