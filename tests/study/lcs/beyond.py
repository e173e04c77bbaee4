"""What goes beyond the thesis: beside its goals, switch by switch, and by each of its numbers."""

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, final

import numpy as np

from lcs.alcsr.config import GROWN, Beyond, Config
from lcs.alcsr.learner import ALCSR
from lcs.problems.classes import SKEWED, Classes, checkerboard, multiplexer
from tests.study.lcs.tables import row

SEEDS: Final = range(5)
SHARE_TRIED: Final = 0.9
STEP, MOST = 5_000, 8_000
"""After so many cycles a run is given up that has more rules than that."""

FEW: Final = 100_000
MANY: Final = 1_000_000
"""Fresh problems at a place on the way, and at the end."""


@final
@dataclass(frozen=True, slots=True)
class Task:
    """A problem, the numbers of tries at which it is looked at, and what was hoped for there."""

    name: str
    problem: Classes
    tries: tuple[int, ...]
    goals: str


TASKS: Final = (
    Task("6-multiplexer, exp. 1", multiplexer(2), (10_000, 100_000), "98.5; 99.95 with <= 64"),
    Task("6-multiplexer, exp. 2", multiplexer(2, SKEWED), (15_000, 100_000), "97; 99.9 with <= 96"),
    Task("11-multiplexer", multiplexer(3), (35_000, 100_000), "99; 99.9 with <= 200"),
    Task("checkerboard 3 x 3", checkerboard(3), (50_000,), "99.9 with <= 40"),
    Task("checkerboard 5 x 5", checkerboard(5), (50_000,), "99.5 with <= 120"),
    Task("exp. 1, 10 % flipped", replace(multiplexer(2), flipped=0.1), (50_000, 100_000), "–; 99"),
    Task("exp. 1, 20 % flipped", replace(multiplexer(2), flipped=0.2), (50_000, 100_000), "–; 98"),
)

ON: Final = Beyond(remembers=50_000)
SWITCHES: Final[dict[str, Config]] = {
    "the thesis": Config(),
    "hunger=5000": Config(beyond=Beyond(hunger=5_000)),
    "breeds=False": Config(beyond=Beyond(breeds=False)),
    "weighs_evidence": Config(beyond=Beyond(weighs_evidence=True)),
    "sprouts=4": Config(beyond=replace(ON, sprouts=4)),
    "grows": Config(beyond=replace(ON, grows=True)),
    "withdraws": Config(beyond=replace(ON, withdraws=True)),
    "famine": Config(beyond=replace(ON, famine=True)),
    "doubts": Config(beyond=replace(ON, doubts=True)),
    "all (GROWN)": GROWN,
    **{
        f"all but {name}": replace(GROWN, beyond=replace(GROWN.beyond, **{name: off}))
        for name, off in (
            ("sprouts", 0),
            ("grows", False),
            ("withdraws", False),
            ("famine", False),
            ("doubts", False),
            ("breeds", True),
            ("weighs_evidence", False),
        )
    },
}

NUMBERS: Final[dict[str, Config]] = {
    "as they are": GROWN,
    **{
        f"{name}={value}": replace(GROWN, beyond=replace(GROWN.beyond, **{name: value}))
        for name, values in {
            "remembers": (5_000, 20_000),
            "sprouts": (1, 2, 8),
            "season": (250, 1_000),
        }.items()
        for value in values
    },
    "seeding=0.25": replace(GROWN, seeding=0.25),
    "seeding=1.0": replace(GROWN, seeding=1.0),
}


@final
@dataclass(frozen=True, slots=True)
class Seen:
    """At a number of tries: the share of fresh problems that it got right, and its rules.

    Where an action has no rule the problem counts as wrong. seconds: of one processor, so far.
    """

    tries: int
    right: float
    rules: int
    seconds: float


def seen(problem: Classes, tries: tuple[int, ...], config: Config, seed: int) -> list[Seen]:
    """Learn a problem and look at it on the way; given up where the rules become too many."""
    chance = np.random.default_rng([seed, 1])
    clean = replace(problem, flipped=0.0)
    learner = ALCSR(problem.classes, problem.inputs, config, seed=seed)
    done, seconds, found = 0, 0.0, []
    for count in tries:
        cycles = round(count / SHARE_TRIED) - done
        done += cycles
        x, rewards, _ = problem.drawn(cycles, chance)
        begun = time.process_time()
        for at in range(0, cycles, STEP):
            learner.run(x[at : at + STEP], rewards[at : at + STEP])
            if len(learner.rules()) > MOST:
                return [Seen(each, np.nan, len(learner.rules()), np.nan) for each in tries]
        seconds += time.process_time() - begun
        fresh = MANY if count == tries[-1] else FEW
        x, _, right = clean.drawn(fresh, np.random.default_rng([seed, 2]))
        share = float(np.mean(learner.decide(x)[0] == right))
        found.append(Seen(count, share, len(learner.rules()), seconds))
    return found


def tell(_: Path, __: int) -> None:
    """Print the table of the goals; one run at a time, since it is timed."""
    _warm()
    print(row(["problem", "goal: %, rules", *["tries", "right, %", "rules"] * 2, "problems/s"]))
    print(row(["---"] * 9))
    for task in TASKS:
        _tell_task(task, [seen(task.problem, task.tries, GROWN, seed) for seed in SEEDS])


def _warm() -> None:
    """Compile before anything is timed."""
    seen(checkerboard(3), (200,), GROWN, 0)


def _tell_task(task: Task, runs: list[list[Seen]]) -> None:
    cells = [task.name, task.goals]
    for place in range(2):
        if place >= len(task.tries):
            cells += ["", "", ""]
            continue
        at = [run[place] for run in runs]
        cells += [f"{task.tries[place]:,}", _shares(at), _counts(at)]
    speeds = [task.tries[-1] / SHARE_TRIED / run[-1].seconds for run in runs]
    print(row([*cells, f"{np.median(speeds):,.0f}"]), flush=True)


def _shares(at: list[Seen]) -> str:
    shares = sorted(100.0 * each.right for each in at)
    return f"{np.mean(shares):.2f} ({shares[0]:.2f} to {shares[-1]:.2f})"


def _counts(at: list[Seen]) -> str:
    counts = sorted(each.rules for each in at)
    return f"{counts[len(counts) // 2]} ({counts[0]} to {counts[-1]})"


def tell_switches(_: Path, __: int) -> None:
    """Print what each switch does alone, and what is missing without it."""
    _tell_configs(SWITCHES, (checkerboard(5),))


def tell_numbers(_: Path, __: int) -> None:
    """Print how much hangs on each number of `GROWN`."""
    _tell_configs(NUMBERS, (multiplexer(2, SKEWED), multiplexer(3)))


def _tell_configs(configs: dict[str, Config], problems: tuple[Classes, ...]) -> None:
    _warm()
    head = ["right, % at 15,000", "at 50,000", "rules", "CPU s"]
    print(row(["", *[f"{each.name}: {cell}" for each in problems for cell in head]]))
    print(row(["---"] * (1 + len(head) * len(problems))))
    for name, config in configs.items():
        cells = [name]
        for problem in problems:
            run = seen(problem, (15_000, 50_000), config, 0)
            cells += [f"{100.0 * each.right:.2f}" for each in run]
            cells += [f"{run[-1].rules:,}", f"{run[-1].seconds:.1f}"]
        print(row(cells), flush=True)
