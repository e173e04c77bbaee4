"""Error rates of the verdict: planted departures, noise, unrest; 1,000 runs a row.

    python -m tests.study.verdicts [--runs N] [--only TEXT]

A departure of exactly the tolerance deserves neither PASS nor FAIL. Wrong verdicts stand with the
upper end of their 95 % interval (Clopper and Pearson 1934). All but the oscillator depart alike
everywhere. The oscillator's departure is its root mean square, which a PASS claims to be within
the tolerance; while its largest somewhere is within, no FAIL is right.

Below the gain stands what checks by finite differences find of it, and of as many faithful robots.
"""

import argparse
import os
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from typing import Final, final

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy import stats

from runtime.program import Program
from tests.study.finite_differences import CHECKS, alarms, statistics, usual
from tests.study.robots import BASE, ROBOTS, SOFT_WALL, SWING, WALL, Array, Robot, drive, measured
from tests.study.truth import deviation_of, largest, size
from verifier.fidelity.verify import verify
from verifier.traces.trace import Trace

CHUNK: Final = 50
FAITHFUL: Final = 1_000_000, 2_000_000
"""Runs of faithful robots: those that a check is set by, and those that it is tried on."""


@final
@dataclass(frozen=True, slots=True)
class Row:
    """One row: a robot that departs by `departure` tolerances, under these conditions.

    noise, unrest: multiples of the robot's own. memory: correlation of successive noise values.
    """

    robot: Robot
    departure: float
    seconds: float = 60.0
    rate: float = 20.0
    noise: float = 1.0
    memory: float = 0.0
    unrest: float = 1.0
    note: str = ""
    is_largest: bool = False


def rows() -> Iterator[Row]:
    """At most 24."""
    for robot in ROBOTS:
        for departure in (0.0, 0.5, 1.0, 2.0):
            yield Row(robot, departure)
    yield Row(WALL, 1.0, noise=2.0, note="noise x 2")
    yield Row(WALL, 1.0, seconds=20.0, note="20 s")
    yield Row(WALL, 1.0, rate=5.0, note="5 Hz")
    yield Row(WALL, 1.0, memory=0.8, note="noise correlated 0.8")
    yield Row(WALL, 1.0, unrest=4.0, note="unrest x 4")
    yield Row(BASE, 0.0, unrest=4.0, note="unrest x 4")
    yield Row(SWING, 1.0, seconds=180.0, note="180 s, at its largest", is_largest=True)
    lively = replace(SOFT_WALL, low=(0.4,), high=(1.2,), hold=2.0)
    yield Row(lively, 3.0, seconds=300.0, note="gain 5 % off, 300 s")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--only", default="")
    chosen = parser.parse_args()
    print(f"{'robot':34s} {'condition':22s} {'departs':>8s} {'PASS':>6s} {'FAIL':>6s} {'open':>6s}")
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        for row in rows():
            if chosen.only in f"{row.robot.name} {row.note}":
                print(_told(row, chosen.runs, pool), flush=True)
                if row.robot.name == SOFT_WALL.name:
                    print("\n".join(_told_by_rates(row, chosen.runs, pool)), flush=True)


def chunks(runs: int, first: int = 0) -> list[range]:
    """Runs in parts of one seed each."""
    return [range(first + k, first + min(k + CHUNK, runs)) for k in range(0, runs, CHUNK)]


def _told(row: Row, runs: int, pool: ProcessPoolExecutor) -> str:
    began = time.time()
    planted, scale = planted_in(row)
    tasks = [pool.submit(verdicts, row, planted, scale, part) for part in chunks(runs)]
    counts = sum((task.result() for task in tasks), Counter())
    shares = [counts[name] / runs for name in ("pass", "fail", "inconclusive")]
    figures = " ".join(f"{100 * share:5.1f}%" for share in shares)
    wrong = {0.0: ["fail"], 0.5: ["fail"], 1.0: ["pass", "fail"], 2.0: ["pass"], 3.0: ["pass"]}[
        row.departure
    ]
    if row.departure == 1.0 and row.robot is SWING:
        wrong = ["fail"] if row.is_largest else ["pass"]
    bounds = " ".join(f"{name} <= {100 * upper(counts[name], runs):.1f}%" for name in wrong)
    seconds = time.time() - began
    return (
        f"{row.robot.name:34s} {row.note:22s} {row.departure:6.1f} T {figures}"
        f"  {bounds}  ({seconds:.0f} s)"
    )


def _told_by_rates(row: Row, runs: int, pool: ProcessPoolExecutor) -> Iterator[str]:
    """A line for each check by finite differences."""
    planted, scale = planted_in(row)
    setting, trial, found = (
        np.concatenate(list(pool.map(of_rates, *zip(*tasks, strict=True))))
        for tasks in (
            [(row, 0.0, scale, part) for part in chunks(runs, FAITHFUL[0])],
            [(row, 0.0, scale, part) for part in chunks(runs, FAITHFUL[1])],
            [(row, planted, scale, part) for part in chunks(runs)],
        )
    )
    faithful = usual(setting)
    wrong, right = (100.0 * np.mean(alarms(each, faithful), axis=0) for each in (trial, found))
    for name, false_alarms, power in zip(CHECKS, wrong, right, strict=True):
        yield f"    {name:44s} finds {power:5.1f}%  of faithful robots {false_alarms:5.1f}%"


def planted_in(row: Row) -> tuple[float, float]:
    """The deviation, and what the tolerances are multiplied with."""
    if row.robot.name == SOFT_WALL.name:
        return 0.05, size(row.robot, 0.05) / row.departure
    measure = largest if row.is_largest else size
    return deviation_of(row.robot, row.departure, measure), 1.0


def verdicts(row: Row, planted: float, scale: float, runs: range) -> Counter[str]:
    """How often each verdict was given."""
    program = row.robot.program(scale)
    found = (verify(program, trace) for trace in traces(row, program, planted, runs))
    return Counter(str(report.verdict) for report in found)


def of_rates(row: Row, planted: float, scale: float, runs: range) -> Array:
    """The statistics of the checks by finite differences, for every run."""
    program = row.robot.program(scale)
    return np.array([statistics(row.robot, t) for t in traces(row, program, planted, runs)])


def traces(row: Row, program: Program, planted: float, runs: range) -> Iterator[Trace]:
    """The recordings of these runs."""
    seed = 1 + runs.start
    drives = drive(row.robot, len(runs), row.seconds, planted, row.unrest, seed)
    for run in range(len(runs)):
        yield measured(program, row.robot, drives, run, row.rate, row.noise, row.memory, seed)


def upper(wrong: int, runs: int) -> float:
    """The upper end of the one-sided 95 % interval of a share."""
    return 1.0 if wrong == runs else float(stats.beta.ppf(0.95, wrong + 1, runs - wrong))


if __name__ == "__main__":
    main()
