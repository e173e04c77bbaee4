"""How fast scenarios run: eight behaviors and their sensors among 60 movable and 20 fixed boxes.

Run it: `python -m tests.study.speed [seconds]`, or `make study-world`. Processor time of one core,
in parts of two simulated seconds; other work on the machine makes some of them slower, so the
quickest stands beside the median. The scenarios are in tests/study/crowd.
"""

import math
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from runtime.run import run
from runtime.scenario import Scenario
from runtime.start import Started, started
from specc.loading import compile_scenario_spec

CROWD = Path(__file__).parent / "crowd"
PART = 2.0
"""Simulated seconds that are timed at once."""
STEPS = 400


def parts(call: Callable[[], object], count: int) -> tuple[float, float]:
    """Processor seconds of a call: the least of several, and their median."""
    found = []
    for _ in range(count):
        begun = time.process_time()
        call()
        found.append(time.process_time() - begun)
    return min(found), statistics.median(found)


def measured(name: str, made: Started, step: float, seconds: float, wanted: str) -> None:
    """Print how fast it is, and how fast the physics alone would be."""
    made.scheduler.run(round(1.0 / step))
    instants = round(PART / step)
    quick, usual = parts(lambda: made.scheduler.run(instants), max(round(seconds / PART), 1))
    space = made.world._space.space

    def bare() -> None:
        for _ in range(STEPS):
            space.step(step)

    alone, _ = parts(bare, 5)
    print(
        f"{name:42s} {PART / quick:5.0f} x   {PART / usual:5.0f} x   {wanted:>8s}   "
        f"{1e6 * quick / instants:5.0f} us a step, {1e6 * alone / STEPS:4.0f} of them pymunk's",
        flush=True,
    )


def scenario(name: str, duration: float) -> Scenario:
    """One of the crowd's."""
    return replace(compile_scenario_spec(CROWD / f"{name}.yaml").scenario, duration=duration)


def main(seconds: float) -> None:
    """Print the table."""
    roaming, pushing = scenario("roaming", seconds), scenario("pushing", seconds)
    print("8 behaviors, 8 sensors, 80 boxes           quickest   median     wanted")
    awake = started(roaming)
    awake.world._space.space.sleep_time_threshold = math.inf
    measured("every body awake", awake, roaming.step, seconds, ">= 20 x")
    measured(
        "one box pushed, the others asleep", started(pushing), pushing.step, seconds, ">= 100 x"
    )
    measured("all asleep but the robot", started(roaming), roaming.step, seconds, "")
    for told in (roaming, pushing):
        quick, _ = parts(lambda told=told: run(told), 1)  # type: ignore[misc]  # a default binds
        print(f"{told.name + ', all of it gathered for a recording':42s} {seconds / quick:5.0f} x")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 40.0)
