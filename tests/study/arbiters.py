"""Error rates of the verdict on arbiters: `python -m tests.study.arbiters [RUNS]`.

A robot decides by one threshold while something comes and goes ahead (an Ornstein-Uhlenbeck
course of a second's memory, ten decisions a second). Its threshold is where the spec has it, or off
by so much that on the long run half, all, or twice as many decisions differ as are allowed (2 %).
The log holds what it read with a sensor's noise of a millimetre.
"""

import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter
from runtime.arrays import Array, Integers
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.reader import CHOICE
from verifier.report.report import Verdict
from verifier.traces.trace import Series, Trace

SPEC: Final = """
specc: 1
kind: arbiter
name: two
reads: {ahead: {unit: m, domain: [0, 3]}}
constants: {near: {value: 0.6, unit: m}}
choices: [flee, go]
by:
  rules:
    - {choose: flee, when: ahead < near}
    - {choose: go}
agreement: {share: 0.98}
"""
NEAR, MIDDLE, SPREAD, NOISE = 0.6, 0.8, 0.2, 0.001
PERIOD, MEMORY = 0.1, 1.0
ALLOWED: Final = 0.02
LENGTHS: Final = (600, 3000, 6000)
OFF: Final = (0.0, 0.5, 1.0, 2.0)


def main(runs: int = 1000) -> None:
    """Print a row for each length of a log and each threshold."""
    spec = _spec()
    rng = np.random.default_rng(20)
    print("| decisions | share that differs, of what is allowed | PASS | INCONCLUSIVE | FAIL |")
    print("|---|---|---|---|---|")
    for count in LENGTHS:
        for off in OFF:
            robot = NEAR + _shift(off * ALLOWED)
            found = Counter(_verdict(spec, robot, count, rng) for _ in range(runs))
            cells = (Verdict.PASS, Verdict.INCONCLUSIVE, Verdict.FAIL)
            shares = " | ".join(f"{100.0 * found[verdict] / runs:.1f} %" for verdict in cells)
            print(f"| {count} | {off:g} | {shares} |", flush=True)


def _spec() -> Arbiter:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "two.yaml"
        path.write_text(SPEC)
        return compile_arbiter(path).arbiter


def _shift(share: float) -> float:
    """How far the threshold has to be off for that share of decisions to differ."""
    seen = MIDDLE + SPREAD * np.random.default_rng(0).normal(size=1_000_000)
    above = np.sort(seen[seen >= NEAR])
    place = round(share * seen.size)
    return float(above[place] - NEAR) if place else 0.0


def _verdict(spec: Arbiter, threshold: float, count: int, rng: np.random.Generator) -> Verdict:
    ahead = _course(count, rng)
    chosen: Integers = np.where(ahead < threshold, 0, 1)
    times = np.arange(count) * PERIOD
    logged = ahead + rng.normal(scale=NOISE, size=count)
    series = {
        "ahead": Series("ahead", times, logged, "ahead", "log"),
        CHOICE: Series(CHOICE, times, chosen.astype(float), CHOICE, "log"),
    }
    trace = Trace("planted", series, {}, 0.0, (), ())
    return judge_arbiter(replace(spec), trace, depth="verdict").report.verdict


def _course(count: int, rng: np.random.Generator) -> Array:
    keep = float(np.exp(-PERIOD / MEMORY))
    pushes = rng.normal(scale=SPREAD * np.sqrt(1.0 - keep**2), size=count).tolist()
    course = [SPREAD * float(rng.normal())]
    for push in pushes[1:]:
        course.append(keep * course[-1] + push)
    return MIDDLE + np.array(course)


if __name__ == "__main__":
    main(*(int(each) for each in sys.argv[1:]))
