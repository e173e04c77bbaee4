"""Scores of similarity beside the verdict, on the same recordings: `python -m tests.study.scores`.

Of each recording the score of its worst variable; of the 100 recordings of a row the median.
Below, for each score, the best line that could be drawn between robots that do not depart and those
that depart by twice their tolerance, for all robots alike and for each its own: how many of these
recordings are on the wrong side of it. It is drawn with the truth at hand, which no lab has.
"""

import argparse
import os
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from typing import Final

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from tests.study.robots import ROBOTS, Array
from tests.study.verdicts import Row, chunks, planted_in, traces
from verifier.fidelity.verify import judged
from verifier.scores.scores import scores_of

SCORES: Final = ("ISO 18571", "NRMSE", "R2")
BETTER: Final = np.array([1.0, -1.0, 1.0])
"""The sign with which larger is better."""
VERDICTS: Final = ("pass", "fail", "inconclusive")


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=100)
    runs = parser.parse_args().runs
    found = {}
    heading = f"{'robot':34s} {'departs':>8s} {'PASS':>6s} {'FAIL':>6s} {'open':>6s}"
    print(heading, *(f"{name:>9s}" for name in SCORES), sep="  ")
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        for row in (Row(robot, departure) for robot in ROBOTS for departure in (0.0, 1.0, 2.0)):
            tasks = [pool.submit(scored, row, *planted_in(row), part) for part in chunks(runs)]
            counts = sum((task.result()[0] for task in tasks), Counter())
            scores = np.concatenate([task.result()[1] for task in tasks])
            found[row.robot.name, row.departure] = scores
            print(_told(row, counts, scores), flush=True)
    print("on the wrong side of the best line between 0 and 2 T")
    names = [robot.name for robot in ROBOTS]
    for words, chosen in (("all robots", names), *((name, [name]) for name in names)):
        sides = [np.concatenate([found[name, size] for name in chosen]) for size in (0.0, 2.0)]
        shares = 100.0 * wrong_side(*(BETTER * side for side in sides))
        print(f"{words:65s}", "  ".join(f"{share:8.1f}%" for share in shares))


def _told(row: Row, counts: Counter[str], scores: Array) -> str:
    verdicts = " ".join(f"{100.0 * counts[name] / len(scores):5.1f}%" for name in VERDICTS)
    medians = "  ".join(f"{value:9.3f}" for value in np.median(scores, axis=0))
    return f"{row.robot.name:34s} {row.departure:6.1f} T {verdicts}  {medians}"


def scored(row: Row, planted: float, scale: float, runs: range) -> tuple[Counter[str], Array]:
    """How often each verdict was given, and the scores of the worst variable (R, 3)."""
    program, verdicts, found = row.robot.program(scale), Counter[str](), []
    for trace in traces(row, program, planted, runs):
        report, study = judged(program, trace)
        assert study is not None, "a minute can be judged"
        each = scores_of(study, report).variables
        ratings = [v.iso.overall for v in each if v.iso is not None]
        found.append([min(ratings), max(v.nrmse for v in each), min(v.r_squared for v in each)])
        verdicts[str(report.verdict)] += 1
    return verdicts, np.array(found)


def wrong_side(good: Array, bad: Array) -> Array:
    """The smallest share of N good and M bad recordings, (N, k) and (M, k), beyond a line."""
    least = []
    for high, low in zip(good.T, bad.T, strict=True):
        lines = np.concatenate([high, low, [np.inf]])[:, np.newaxis]
        wrong = np.sum(high < lines, axis=1) + np.sum(low >= lines, axis=1)
        least.append(np.min(wrong) / (len(high) + len(low)))
    return np.array(least)


if __name__ == "__main__":
    main()
