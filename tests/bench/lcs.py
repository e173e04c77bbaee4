"""Learning the real 6-multiplexer beside xcsf, on one core: `python -m tests.bench.lcs`.

Everybody learns the same problems, 1,000 at a time in turns, and is asked 20,000 fresh ones after
each thousand, which is not timed; an input that some action has no rule for counts as wrong. Either
one action of each input is tried and rewarded, or, as where labels are known, all of them. Times
are the processor's, so that other work on the machine counts less. xcsf is taken on its fastest
way: `fit(x, action, reward)` for each problem from Python (`decision` and `update` take longer),
and `fit(X, Y)` for many at once where all rewards are known. Figures are medians of the seeds, and
nan where not all seeds came to 98 %.
"""
# ruff: noqa: T201 - a bench prints

import argparse
import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final, Protocol, TypeAlias, final

import numpy as np

from lcs.alcsr.config import GROWN
from lcs.alcsr.config import Config as OfALCSR
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Array, Integers
from lcs.problems.classes import SKEWED, Classes, multiplexer
from lcs.xcsr.config import Bounds, Config, Selection
from lcs.xcsr.learner import XCSR
from tests.bench.lcs_peer import Labelled, OneByOne

EACH, FRESH, GOAL = 1_000, 20_000, 0.98
EARLY: Final = 15_000
XCSF_LIKE: Final = Config(bounds=Bounds.UNORDERED, selection=Selection.TOURNAMENT, explore=1.0)
WILSON: Final = Config(explore=1.0)
TASKS: Final = {"experiment 1": multiplexer(2), "experiment 2": multiplexer(2, SKEWED)}


class Contender(Protocol):
    """Somebody who learns."""

    def learn(self, x: Array, rewards: Array, actions: Integers) -> None: ...

    def decide(self, x: Array) -> Integers: ...

    def rules(self) -> int: ...


@final
class Ours:
    """A learner of ours: `run`, or `teach` where labels are known, or `act` and `learn`."""

    def __init__(self, learner: ALCSR | XCSR, how: str = "run") -> None:
        self.learner, self.how = learner, how

    def learn(self, x: Array, rewards: Array, actions: Integers) -> None:  # noqa: ARG002
        if self.how == "run":
            self.learner.run(x, rewards)
        elif self.how == "teach":
            self.learner.teach(x, rewards)
        else:
            for one, given in zip(x, rewards.tolist(), strict=True):
                self.learner.learn(given[self.learner.act(one)])

    def decide(self, x: Array) -> Integers:
        return self.learner.decide(x)[0]

    def rules(self) -> int:
        return len(self.learner.rules())


def alcsr(config: OfALCSR, how: str = "run", inputs: int = 6) -> "Maker":
    return lambda seed: Ours(ALCSR(2, inputs, replace(config, explore=1.0), seed=seed), how)


def xcsr(config: Config, how: str = "run") -> "Maker":
    return lambda seed: Ours(XCSR(2, 6, config, seed=seed), how)


Maker: TypeAlias = Callable[[int], Contender]
PARTS: Final[dict[str, dict[str, Maker]]] = {
    "one action of each input is rewarded": {
        "xcsf 1.5, fit(x, a, r)": lambda seed: OneByOne(6, 2, seed),
        "XCSR, run, settings of xcsf": xcsr(XCSF_LIKE),
        "XCSR, act and learn, same": xcsr(XCSF_LIKE, "act"),
        "XCSR, run, Wilson 2000": xcsr(WILSON),
        "ALCSR, run, GROWN": alcsr(GROWN),
        "ALCSR, act and learn, GROWN": alcsr(GROWN, "act"),
        "ALCSR, run, as the thesis": alcsr(OfALCSR()),
    },
    "all rewards of each input are known": {
        "xcsf 1.5, fit(X, Y)": lambda seed: Labelled(6, 2, seed),
        "XCSR, teach, settings of xcsf": xcsr(XCSF_LIKE, "teach"),
        "ALCSR, teach, GROWN": alcsr(GROWN, "teach"),
    },
}


@final
@dataclass(slots=True)
class Score:
    """Of one contender and one seed: seconds so far, what it got right after each thousand."""

    who: Contender
    seconds: float = 0.0
    right: list[float] = field(default_factory=list)
    at_goal: tuple[float, float] = (np.nan, np.nan)

    def turn(self, x: Array, rewards: Array, actions: Integers, fresh: Array, asked: Array) -> None:
        """Learn, timed; be asked, not timed."""
        start = time.process_time()
        self.who.learn(x, rewards, actions)
        self.seconds += time.process_time() - start
        self.right.append(float(np.mean(self.who.decide(fresh) == asked)))
        if np.isnan(self.at_goal[0]) and self.right[-1] >= GOAL:
            self.at_goal = self.seconds, float(EACH * len(self.right))

    def numbers(self) -> tuple[float, ...]:
        """Problems per second, seconds and problems to the goal, right early and last, rules."""
        problems = EACH * len(self.right)
        early = self.right[min(EARLY, problems) // EACH - 1]
        rate = problems / self.seconds
        return rate, *self.at_goal, 100.0 * early, 100.0 * self.right[-1], self.who.rules()


def contest(task: Classes, makers: dict[str, Maker], problems: int, seed: int) -> Array:
    """The numbers of each, (contenders, 6)."""
    chance = np.random.default_rng([seed, 1])
    fresh, _, asked = task.drawn(FRESH, np.random.default_rng([seed, 2]))
    scores = [Score(maker(seed)) for maker in makers.values()]
    for _ in range(0, problems, EACH):
        x, rewards, _ = task.drawn(EACH, chance)
        actions = chance.integers(0, task.classes, EACH)
        for score in scores:
            score.turn(x, rewards, actions, fresh, asked)
    return np.array([score.numbers() for score in scores])


def main() -> None:
    """Print a table for each part and experiment."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--problems", type=int, default=35_000)
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    print(f"the first {given.problems:,} problems, {given.seeds} seeds, one core\n")
    for part, makers in PARTS.items():
        for maker in makers.values():
            compile_(maker)
        for name, task in TASKS.items():
            seeds = range(1, given.seeds + 1)
            told = [contest(task, makers, given.problems, seed) for seed in seeds]
            show(f"{name}, {part}", list(makers), np.median(told, axis=0))


def compile_(maker: Maker) -> None:
    """Have machine code made before anything is timed."""
    x, rewards, _ = TASKS["experiment 1"].drawn(200, np.random.default_rng(0))
    learner = maker(0)
    learner.learn(x, rewards, np.zeros(len(x), np.int64))
    learner.decide(x)


def show(title: str, names: list[str], told: Array) -> None:
    """A table; ratios above 1 are to our favour."""
    print(title)
    print(f"{'':30} problems  times xcsf's    98 %   times    problems   % at   % at  rules")
    print(f"{'':30}    per s          rate  after s  sooner  until 98 %    15k    end")
    rate, soon = told[0, 0], told[0, 1]
    for name, (speed, seconds, tries, early, last, rules) in zip(names, told, strict=True):
        print(
            f"{name:30} {speed:8,.0f} {speed / rate:13.2f} {seconds:8.2f} {soon / seconds:7.2f}"
            f" {tries:11,.0f} {early:6.2f} {last:6.2f} {rules:6.0f}"
        )
    print(flush=True)


if __name__ == "__main__":
    main()
