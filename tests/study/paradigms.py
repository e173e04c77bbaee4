"""Three tasks, each done by three paradigms with the same behaviors, and by chance.

Run it: `python -m tests.study.paradigms [light patrol tidy] [--first 1000] [--worlds 50]`.
A world is decided as soon as it is known whether all that the scenario requires holds. That its
sentences say the same is tested (tests/specc/test_paradigms.py): for light found and touched and
for crates all at walls in worlds, for the patrol on rounds that are made up. A world is left as
soon as it is decided, but for the light: it runs to its end, so that a touch after that is told as
well.
Seeds from 2000 on were for building; docs/paradigms.md says which were kept for the tables.
"""

import argparse
import dataclasses
import math
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import NamedTuple, Protocol, final

import numpy as np
from scipy.stats import binomtest

from compiler.architecture.compile import tabulating
from compiler.architecture.library import Library
from compiler.findings import Findings
from compiler.world.scenario_passes import compile_parts_of_scenario
from runtime.arrays import Array, Booleans
from runtime.artifact import to_bytes
from runtime.scenario import Scenario
from runtime.scheduler.environment import Delivery
from runtime.scheduler.observer import Event, Resolved, Tick
from runtime.start import started
from spec_schema.load import load
from spec_schema.scenario import ScenarioSpec

ROOT = Path(__file__).parents[2]
PARADIGMS = ("subsumption", "hierarchy", "dynamics", "random")
BRIGHT = 10.0
"""Lux: in the light."""
WALL = 0.35
"""Metres from a wall: tidy."""
POSTS = ((0.8, 0.8), (5.2, 3.2))
THERE, SELDOM = 0.9, 100.0
"""Metres from a post: there. Seconds: it must have been there within them."""
FLAT = 0.99
"""Share of the battery that is used: flat."""
LOOK = 2
"""Steps between two looks: at 0.4 m/s a robot moves by 4 mm in them."""


class Outcome(NamedTuple):
    """Of one world: success, a time (s, nan for none), and how often it began to touch."""

    succeeded: bool
    time: float
    contacts: int

    @property
    def never_touched(self) -> bool:
        """Whether it succeeded and touched nothing, neither before nor after."""
        return self.succeeded and self.contacts == 0


class Watched(Protocol):
    """What is looked at in a world; a `SimulatedWorld` is such."""

    def poses(self) -> Array:
        """Where things and robots are (n, 3), the robot last."""
        ...

    def clearance(self, robot: int) -> float:
        """Metres to the nearest other thing; 0 or less where it touches."""
        ...

    def sample(self, robot: int, sensor: int) -> Array:
        """The readings of one sensor, without noise."""
        ...


class Task(Protocol):
    """What is to be done in one world."""

    is_the: str
    goes_on: bool
    """Whether the world goes on after that, and is asked whether anything was touched."""

    def decided(self, world: Watched, time: float, used: float) -> bool | None:
        """Whether it has succeeded or failed by now; None where that is open."""
        ...

    def time(self, end: float) -> float:
        """The time that is told of a success."""
        ...


@final
class FindLight:
    """Touch nothing until it is in the light."""

    is_the, goes_on = "until it is in the light", True

    def __init__(self, scenario: Scenario) -> None:
        sensors = scenario.robots[0].body.sensors
        self._lamp = [sensor.name for sensor in sensors].index("lamp")

    def decided(self, world: Watched, time: float, used: float) -> bool | None:  # noqa: ARG002
        """Lit, or touched."""
        if world.sample(0, self._lamp)[0] > BRIGHT:
            return True
        return False if world.clearance(0) <= 0.0 else None

    def time(self, end: float) -> float:
        """When it was there."""
        return end


@final
class Patrol:
    """Be at each post again and again, touch nothing, and never let the battery go flat."""

    is_the, goes_on = "from a post to the other", False

    def __init__(self, scenario: Scenario) -> None:
        self._duration = scenario.duration
        self._last = [0.0, 0.0]
        self._arrivals: list[tuple[float, int]] = []

    def decided(self, world: Watched, time: float, used: float) -> bool | None:
        """Touched, flat or too late; or it has come to the end."""
        x, y = world.poses()[-1, :2]
        for post, (east, north) in enumerate(POSTS):
            if math.hypot(x - east, y - north) < THERE:
                self._last[post] = time
                if not self._arrivals or self._arrivals[-1][1] != post:
                    self._arrivals.append((time, post))
        if world.clearance(0) <= 0.0 or used >= FLAT or time - min(self._last) > SELDOM:
            return False
        return True if time >= self._duration - 1e-9 else None

    def time(self, end: float) -> float:  # noqa: ARG002  as of others
        """The mean over its ways; NaN where it made none."""
        if len(self._arrivals) < 2:
            return math.nan
        return float(np.mean(np.diff([time for time, _ in self._arrivals])))


@final
class Tidy:
    """Push every crate to a wall."""

    is_the, goes_on = "until all crates are at walls", False

    def __init__(self, scenario: Scenario) -> None:
        self._room = np.array(scenario.world.arena).max(axis=0)

    def decided(self, world: Watched, time: float, used: float) -> bool | None:  # noqa: ARG002
        """All are there."""
        places = world.poses()[:-1, :2]
        nearest = np.minimum(places, self._room - places).min(axis=1)
        return True if np.all(nearest < WALL) else None

    def time(self, end: float) -> float:
        """When they were."""
        return end


TASKS: dict[str, type[FindLight | Patrol | Tidy]] = {
    "light": FindLight,
    "patrol": Patrol,
    "tidy": Tidy,
}


@final
class Account:
    """Keeps what the battery says of itself."""

    def __init__(self, node: int) -> None:
        self._node, self.used = node, 0.0

    def ticked(self, instant: int, tick: Tick) -> None:  # noqa: ARG002
        """Its first state is what is used."""
        if tick.node == self._node:
            self.used = float(tick.register[0])

    def sensed(self, instant: int, delivery: Delivery) -> None:
        """Do nothing."""

    def acting(self, instant: int, robot: int, acts: Booleans, weights: Array) -> None:
        """Do nothing."""

    def commanded(self, instant: int, robot: int, channels: Array, driven: Booleans) -> None:
        """Do nothing."""

    def resolved(self, instant: int, robot: int, channel: int, how: Resolved) -> None:
        """Do nothing."""

    def happened(self, instant: int, event: Event) -> None:
        """Do nothing."""


@cache
def library() -> Library:
    """What all scenarios name: each file is compiled once, whoever names it."""
    return tabulating(lambda _what, _done, _of: None, None, allow_code=False)


@cache
def scenario_of(task: str, paradigm: str) -> Scenario:
    """The compiled scenario of a task and a paradigm."""
    loaded = load(ROOT / "specs" / "scenarios" / f"{task}_{paradigm}.yaml")
    assert isinstance(loaded.spec, ScenarioSpec)
    found = compile_parts_of_scenario(loaded.spec, loaded, library(), Findings(loaded))
    assert found is not None, "`specc check` says what is wrong"
    return found.scenario


def hashes_of(task: str, paradigm: str) -> dict[str, str]:
    """The base behaviors, each with a hash of its artifact."""
    programs = scenario_of(task, paradigm).robots[0].architecture.programs
    return {
        program.name: blake2b(to_bytes(program), digest_size=8).hexdigest()
        for program in programs
        if not program.name.endswith("_mission")
    }


def outcome(task: str, paradigm: str, seed: int, duration: float | None = None) -> Outcome:
    """What becomes of a robot in one world; it ends where that is decided, or at its end.

    duration: seconds, in the place of the scenario's own.
    """
    whole = scenario_of(task, paradigm)
    scenario = dataclasses.replace(whole, seed=seed, duration=duration or whole.duration)
    nodes = [node.name for node in scenario.robots[0].architecture.nodes]
    account = Account(nodes.index("battery") if "battery" in nodes else -1)
    begun = started(scenario, observer=account)
    world, scheduler = begun.world, begun.scheduler
    judge = TASKS[task](scenario)
    contacts, touches, when = 0, False, math.nan
    verdict: bool | None = None
    for _ in range(round(scenario.duration / scenario.step / LOOK) + 1):
        touched, touches = touches, world.clearance(0) <= 0.0
        contacts += touches and not touched
        if verdict is None:
            verdict = judge.decided(world, scheduler.time, account.used)
            when = judge.time(scheduler.time) if verdict else math.nan
        if verdict is not None and not judge.goes_on:
            break
        scheduler.run(LOOK)
    return Outcome(bool(verdict), when, contacts)


def share_of(good: int, worlds: int) -> str:
    """Two cells of the table: how many, and their share with its 95 % interval (Wilson)."""
    sure = binomtest(good, worlds).proportion_ci(method="wilson")
    return (
        f"{good} of {worlds} | {100 * good / worlds:.0f} % "
        f"({100 * sure.low:.0f} to {100 * sure.high:.0f} %)"
    )


def line_of(paradigm: str, found: Sequence[Outcome], *, goes_on: bool) -> str:
    """A line of the table: success, where asked for success without any touch, times, contacts."""
    good = [each for each in found if each.succeeded]
    untouched = sum(each.never_touched for each in found)
    shares = share_of(len(good), len(found))
    if goes_on:
        shares += f" | {share_of(untouched, len(found))}"
    times = np.array([each.time for each in good])
    times = times[np.isfinite(times)]
    middle = f"{np.median(times):.0f} s" if times.size else "-"
    range_ = f"{times.min():.0f} to {times.max():.0f} s" if times.size else "-"
    touched = np.array([each.contacts for each in found])
    return (
        f"| {paradigm} | {shares} | {middle} | {range_} "
        f"| {np.mean(touched):.1f} | {np.count_nonzero(touched)} |"
    )


def table(task: str, first: int, worlds: int, workers: int) -> None:
    """Print a line for each paradigm, and which behaviors it has."""
    hashes = {paradigm: hashes_of(task, paradigm) for paradigm in PARADIGMS}
    print(f"\n{task}: the worlds of seeds {first} to {first + worlds - 1}")
    for name, digest in sorted(hashes[PARADIGMS[0]].items()):
        others = [each.get(name) == digest for each in hashes.values()]
        print(f"  {name:14} {digest}  {'the same' if all(others) else 'NOT THE SAME'} in all four")
    goes_on = TASKS[task].goes_on
    strictly = " | and untouched to the end | share (95 %)" if goes_on else ""
    print(f"| paradigm | success | share (95 %){strictly}", end="")
    print(f" | median time {TASKS[task].is_the} | from, to", end="")
    print(" | contacts a world | worlds with contact |")
    print("|---" * (9 if goes_on else 7) + "|", flush=True)
    seeds = range(first, first + worlds)
    with ProcessPoolExecutor(workers) as pool:
        for paradigm in PARADIGMS:
            found = list(pool.map(outcome, [task] * worlds, [paradigm] * worlds, seeds))
            failed = [s for s, each in zip(seeds, found, strict=True) if not each.succeeded]
            print(line_of(paradigm, found, goes_on=goes_on), flush=True)
            print(f"  failed: {failed}", flush=True)
            late = [
                s for s, each in zip(seeds, found, strict=True) if each.succeeded and each.contacts
            ]
            if goes_on:
                print(f"  touched after it: {late}", flush=True)


def main() -> None:
    """Print a table for each task."""
    parser = argparse.ArgumentParser()
    parser.add_argument("tasks", nargs="*", default=list(TASKS))
    parser.add_argument("--worlds", type=int, default=50)
    parser.add_argument("--first", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    for task in given.tasks:
        table(task, given.first, given.worlds, given.workers)


if __name__ == "__main__":
    main()
