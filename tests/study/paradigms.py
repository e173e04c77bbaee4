"""One task, three paradigms, the same behaviors: find the light without touching anything.

Run it: `python -m tests.study.paradigms [--worlds 50] [--first 1000]`. The architectures were tuned
in the worlds of the seeds 0 to 19; those from 1000 on were not looked at while building.
A robot succeeds that is in the light within 120 s and touches nothing in all of them.
"""

import argparse
import dataclasses
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import NamedTuple

import numpy as np

from runtime.artifact import to_bytes
from runtime.scenario import Scenario
from runtime.scheduler.scheduler import Scheduler
from runtime.scheduler.sensors import SensorBank
from runtime.world.sensing import senses_of
from runtime.world.world import Inhabitant, SimulatedWorld
from specc.loading import compile_scenario_spec, compile_spec

ROOT = Path(__file__).parents[2]
PARADIGMS = ("subsumption", "hierarchy", "dynamics", "random")
BEHAVIORS = ("avoid", "phototaxis", "wander")
BRIGHT = 10.0
"""Lux: in the light."""
LOOK = 2
"""Steps between two looks at the clearance: at 0.4 m/s it moves by 4 mm in them."""


class Outcome(NamedTuple):
    """When (s) it came into the light and when it first touched something; None for never."""

    lit: float | None
    touched: float | None

    @property
    def succeeded(self) -> bool:
        return self.lit is not None and self.touched is None


@cache
def scenario_of(paradigm: str) -> Scenario:
    """The compiled scenario of a paradigm."""
    return compile_scenario_spec(ROOT / "specs" / "scenarios" / f"light_{paradigm}.yaml").scenario


def started(scenario: Scenario) -> tuple[SimulatedWorld, Scheduler]:
    """A world with a scheduler that drives the robots in it, at instant 0."""
    inhabitants = [
        Inhabitant(
            robot.name,
            robot.body,
            robot.start.pose,
            tuple(channel.name for channel in robot.architecture.channels),
        )
        for robot in scenario.robots
    ]
    world = SimulatedWorld(
        scenario.world, inhabitants, scenario.step, scenario.seed, senses=senses_of
    )
    robots = [(robot.name, robot.body) for robot in scenario.robots]
    sensors = SensorBank(robots, world, scenario.step, scenario.seed)
    return world, Scheduler(scenario, world, sensors)


def outcome(paradigm: str, seed: int) -> Outcome:
    """What becomes of one robot in one world; it ends with the first touch."""
    scenario = dataclasses.replace(scenario_of(paradigm), seed=seed)
    world, scheduler = started(scenario)
    lamp = [sensor.name for sensor in scenario.robots[0].body.sensors].index("lamp")
    lit = None
    for _ in range(round(scenario.duration / scenario.step / LOOK)):
        if lit is None and world.sample(0, lamp)[0] > BRIGHT:
            lit = scheduler.time
        if world.clearance(0) <= 0.0:
            return Outcome(lit, scheduler.time)
        scheduler.run(LOOK)
    return Outcome(lit, None)


def table(first: int, worlds: int, workers: int) -> None:
    """Print a line for each paradigm."""
    seeds = range(first, first + worlds)
    print(f"{'paradigm':12} success  median time  in the light  touched   ({worlds} worlds)")
    with ProcessPoolExecutor(workers) as pool:
        for paradigm in PARADIGMS:
            found = list(pool.map(outcome, [paradigm] * worlds, seeds))
            good = [each for each in found if each.succeeded]
            times = [each.lit for each in good if each.lit is not None]
            lit = sum(each.lit is not None for each in found)
            touched = sum(each.touched is not None for each in found)
            share = 100.0 * len(good) / worlds
            middle = float(np.median(times)) if times else np.nan
            failed = [s for s, each in zip(seeds, found, strict=True) if not each.succeeded]
            print(
                f"{paradigm:12} {share:5.0f} %  {middle:9.1f} s  {lit:12d}  {touched:7d}   "
                f"failed: {failed}",
                flush=True,
            )


def main() -> None:
    """Print the table, and what the paradigms have in common."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--worlds", type=int, default=50)
    parser.add_argument("--first", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    for name in BEHAVIORS:
        artifact = to_bytes(compile_spec(ROOT / "specs" / f"{name}.yaml").program)
        print(f"{name:12} {blake2b(artifact, digest_size=8).hexdigest()}")
    for paradigm in PARADIGMS:
        architecture = scenario_of(paradigm).robots[0].architecture
        told = [
            blake2b(to_bytes(program), digest_size=8).hexdigest()
            for program in architecture.programs
        ]
        print(f"{paradigm:12} runs {' '.join(told)}")
    table(given.first, given.worlds, given.workers)


if __name__ == "__main__":
    main()
