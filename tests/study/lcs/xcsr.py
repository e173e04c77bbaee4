"""XCSR beside what its papers state: `python -m tests.study.lcs.xcsr [--seeds N]`.

As the papers have it, explore and exploit problems are as frequent. A figure is the mean of the
seeds: of fresh problems, with inputs that some action has no rule for as wrong, and of the last
1,000 exploit problems, in which those were tried instead. Wilson's performance is of the last 50.
"""

import argparse
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from lcs.arrays import Array
from lcs.course import Kind
from lcs.problems.classes import SKEWED, Classes, checkerboard, multiplexer
from lcs.xcsr.config import Bounds, Config, Selection
from lcs.xcsr.kernels.layout import LINES
from lcs.xcsr.learner import XCSR
from tests.study.lcs.tables import percent, row

PLACES: Final = (5_000, 10_000, 15_000, 35_000, 50_000)
"""Explore problems at which it is asked."""

FRESH, LAST = 20_000, 1_000
NARROW: Final = 0.25
"""s_0 on checkerboards: whoever covers two fields and a half learns nothing there."""

STEP: Final = 500
"""Cycles between two looks at how many were tried."""


@final
@dataclass(frozen=True, slots=True)
class Contest:
    """A problem, a config, and what a paper states of it."""

    task: Classes
    title: str
    config: Config
    stated: str = ""


HALF: Final = Config(explore=0.5)
WRITTEN: Final = {
    "centre-spread": HALF,
    "same, no GA subsumption": replace(HALF, ga_subsumption=False),
    "ordered": replace(HALF, bounds=Bounds.ORDERED),
    "unordered": replace(HALF, bounds=Bounds.UNORDERED),
    "unordered, tournament": replace(HALF, bounds=Bounds.UNORDERED, selection=Selection.TOURNAMENT),
}


def contests() -> list[Contest]:
    """All of them, in the order of the table."""
    one, two = multiplexer(2), multiplexer(2, SKEWED)
    wilson = {"centre-spread": ("98 % at 15,000", "93 % at 10,000")}
    found = []
    for place, (name, task) in enumerate((("6-mux exp. 1", one), ("6-mux exp. 2", two))):
        for written, config in WRITTEN.items():
            stated = wilson[written][place] if written in wilson else ""
            found.append(Contest(task, f"{name}, {written}", config, stated))
    for divisions, most in ((3, 800), (5, 2000)):
        task, title = checkerboard(divisions), f"board {divisions} x {divisions}, N {most}"
        wide = replace(HALF, N=most)
        found.append(Contest(task, f"{title}, s_0 of the multiplexer, centre-spread", wide))
        for written, config in WRITTEN.items():
            narrow = replace(config, N=most, s_0=NARROW)
            found.append(Contest(task, f"{title}, s_0 {NARROW}, {written}", narrow))
    return found


def run(contest: Contest, seed: int) -> Array:
    """At each place: the share right of fresh problems, of the last exploit problems, and rules."""
    task, chance = contest.task, np.random.default_rng([seed, 1])
    fresh, _, answers = task.drawn(FRESH, np.random.default_rng([seed, 2]))
    learner = XCSR(task.classes, task.inputs, contest.config, seed=seed)
    tried, exploited, told = 0, np.zeros(0, np.bool_), []
    for place in PLACES:
        while tried < place:
            x, rewards, right = task.drawn(STEP, chance)
            course = learner.run(x, rewards)
            tried += int(np.sum(course.kind != Kind.TEST))
            exploited = np.append(exploited, (course.action == right)[course.is_test])[-LAST:]
        found = np.mean(learner.decide(fresh)[0] == answers)
        told.append((found, np.mean(exploited), learner.population.classifiers.counts[LINES]))
    return np.array(told)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=3)
    seeds = parser.parse_args().seeds
    print(f"% right of {FRESH:,} fresh problems (of the last {LAST:,} exploit problems) after so")
    print(f"many explore problems; {seeds} seeds; rules at the end; spread of the last figure\n")
    print(row(["problem", *(f"{place:,}" for place in PLACES), "rules", "spread", "paper"]))
    print(row(["---"] * (4 + len(PLACES))))
    for contest in contests():
        each = np.array([run(contest, 1 + seed) for seed in range(seeds)])
        fresh, exploit, rules = np.moveaxis(each.mean(axis=0), -1, 0)
        cells = [f"{percent(a)} ({percent(b)})" for a, b in zip(fresh, exploit, strict=True)]
        last = each[:, -1, 0]
        spread = f"{percent(last.min())}-{percent(last.max())}"
        print(row([contest.title, *cells, f"{rules[-1]:.0f}", spread, contest.stated]), flush=True)


if __name__ == "__main__":
    main()
