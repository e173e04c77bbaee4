"""The errand: reach the lamp past a charger, by one arbiter or another, in worlds held out.

Run it: `python -m tests.study.errand [SCENARIO.yaml ...] [--first 1000] [--worlds 100]`; without
a scenario those of the library, which differ in nothing but the arbiter. `outcomes` does the same
from Python, of any scenario with the same robot and goal (an arbiter that was trained, say).
A world is left as soon as it is decided: at the lamp, touched, flat, or late. That this is what the
scenario requires is tested (tests/specc/test_errand.py).
Seeds 0 to 999 are for building and training; those from 1000 on are held out.
Run once in seeds 1000 to 1099: rules reached the lamp in 70 (60 to 78 %), touched in 6, were flat
in 16 and late in 8; chance reached it in 9.
"""

import argparse
import dataclasses
import math
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple, final

import numpy as np
from scipy.stats import binomtest

from compiler.architecture.compile import tabulating
from compiler.architecture.library import Library
from compiler.findings import Findings
from compiler.world.scenario_passes import compile_parts_of_scenario
from runtime.scenario import Scenario
from runtime.start import started
from spec_schema.load import load
from spec_schema.scenario import ScenarioSpec
from tests.study.paradigms import Account, Watched

SCENARIOS: Final = Path(__file__).parents[2] / "specs" / "scenarios"
WAYS: Final = ("rules", "random")
LAMP: Final = (5.4, 3.4)
THERE: Final = 0.4
"""Metres from the lamp: reached."""
FLAT: Final = 0.99
"""Share of the battery that is used: flat."""
CHARGED: Final = 0.05
"""Share of the battery: so much gained is no chance."""
LOOK: Final = 2
"""Steps between two looks: at 0.25 m/s a robot moves by 2.5 mm in them."""


@final
class Outcome(NamedTuple):
    """Of one world: how it ended, and when (s).

    ending: `reached`, `touched`, `flat` or `late`. charged: whether its battery gained by then.
    """

    seed: int
    ending: str
    time: float
    charged: bool


@final
class Summary(NamedTuple):
    """Of many worlds: shares of them, and of the successes the mean time to the lamp (s).

    charged: the share in which the battery gained before the end.
    """

    worlds: int
    success: float
    time: float
    touched: float
    flat: float
    late: float
    charged: float


@cache
def _library() -> Library:
    """What all scenarios name: each file is compiled once, whoever names it."""
    return tabulating(lambda _what, _done, _of: None, None, allow_code=False)


@cache
def scenario_at(path: Path) -> Scenario:
    """The compiled scenario in a file."""
    loaded = load(path)
    assert isinstance(loaded.spec, ScenarioSpec)
    found = compile_parts_of_scenario(loaded.spec, loaded, _library(), Findings(loaded))
    assert found is not None, "`specc check` says what is wrong"
    return found.scenario


def outcome(scenario: Scenario, seed: int) -> Outcome:
    """What becomes of the robot in the world of that seed."""
    nodes = [node.name for node in scenario.robots[0].architecture.nodes]
    account = Account(nodes.index("battery"))
    begun = started(dataclasses.replace(scenario, seed=seed), observer=account)
    world, scheduler = begun.world, begun.scheduler
    most, charged = 0.0, False
    for _ in range(round(scenario.duration / scenario.step / LOOK)):
        most = max(most, account.used)
        charged |= account.used < most - CHARGED
        ending = _ending(world, account.used)
        if ending:
            return Outcome(seed, ending, scheduler.time, charged)
        scheduler.run(LOOK)
    return Outcome(seed, "late", scheduler.time, charged)


def _ending(world: Watched, used: float) -> str:
    """How it ends at this instant; empty where it goes on."""
    x, y = world.poses()[-1, :2]
    if math.hypot(x - LAMP[0], y - LAMP[1]) < THERE:
        return "reached"
    if world.clearance(0) <= 0.0:
        return "touched"
    return "flat" if used >= FLAT else ""


def _in_process(path: Path, seed: int) -> Outcome:
    return outcome(scenario_at(path), seed)


def outcomes(path: Path, seeds: Sequence[int], workers: int = 2) -> list[Outcome]:
    """What becomes of the robot of a scenario in each of these worlds, over processes."""
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(_in_process, [path] * len(seeds), seeds, chunksize=4))


def summary(found: Sequence[Outcome]) -> Summary:
    """Shares and the mean time of these outcomes."""
    endings = [each.ending for each in found]
    times = [each.time for each in found if each.ending == "reached"]

    def share(ending: str) -> float:
        return endings.count(ending) / len(endings)

    return Summary(
        worlds=len(found),
        success=share("reached"),
        time=float(np.mean(times)) if times else math.nan,
        touched=share("touched"),
        flat=share("flat"),
        late=share("late"),
        charged=float(np.mean([each.charged for each in found])),
    )


def line_of(name: str, of: Summary) -> str:
    """A line of the table; the share's 95 % interval is Wilson's."""
    good = round(of.success * of.worlds)
    sure = binomtest(good, of.worlds).proportion_ci(method="wilson")
    return (
        f"| {name} | {good} of {of.worlds} | {of.success:.0%} "
        f"({100 * sure.low:.0f} to {sure.high:.0%}) | {of.time:.0f} s "
        f"| {of.touched:.0%} | {of.flat:.0%} | {of.late:.0%} | {of.charged:.0%} |"
    )


def main() -> None:
    """Print a line for each scenario, and the worlds that each failed in."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scenarios", nargs="*", type=Path)
    parser.add_argument("--first", type=int, default=1000)
    parser.add_argument("--worlds", type=int, default=100)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    own = [SCENARIOS / f"errand_{way}.yaml" for way in WAYS]
    seeds = range(given.first, given.first + given.worlds)
    print("| scenario | reached | share (95 %) | mean time | touched | flat | late | charged |")
    print("|---" * 8 + "|", flush=True)
    for path in given.scenarios or own:
        found = outcomes(path.resolve(), seeds, given.workers)
        print(line_of(path.stem, summary(found)), flush=True)
        for ending in ("touched", "flat", "late"):
            print(f"  {ending}: {[each.seed for each in found if each.ending == ending]}")


if __name__ == "__main__":
    main()
