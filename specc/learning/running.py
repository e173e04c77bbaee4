"""Runs of an experiment: a learner, its course so far, and how it goes on.

Problems come in blocks, each drawn from a seed of its own: what a run meets at a cycle depends on
the seed and on the number of the cycle alone, wherever it was stopped, and nothing of a problem's
chance has to be kept.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any, Final, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.course import Course
from lcs.problems.problem import Problem
from specc.learning.courses import joined, last_tests
from specc.learning.experiment import Experiment
from specc.learning.learners import SavedLearner, learner_for

BLOCK: Final = 1_000
"""Problems that are drawn at once; another number gives other problems."""

DRAWN_TO_LEARN, DRAWN_TO_TEST = 1, 2
"""What sets the seeds of both apart, and those from the learner's own."""

ATTENTION: Final = 0.1
"""Seconds between two looks at whether it shall stop."""

AT_ONCE: Final = 10, 100, 100_000
"""Cycles between two such looks: the fewest, those at first, and the most."""

KEPT_EVERY: Final = 5.0
"""Seconds between two checkpoints."""

RECENT: Final = 10
"""Pieces of a course in which the last tests are looked for, to tell how it stands."""

WINDOW: Final = 50
"""Tests of which performance is the mean, as in the thesis's figures (4.4)."""


@final
@dataclass(slots=True)
class Run:
    """One run of a seed: what it has learnt, what went on, and seconds spent on learning.

    courses, rights: pieces of the course, and the right actions (T,) of each.
    """

    seed: int
    learner: SavedLearner
    courses: list[Course] = field(default_factory=list)
    rights: list[Integers] = field(default_factory=list)
    done: int = 0
    seconds: float = 0.0

    def so_far(self) -> tuple[Course, Integers]:
        """The course, and the right actions, as one piece."""
        if len(self.courses) != 1:
            self.courses = [joined(self.courses)]
            self.rights = [np.concatenate([np.zeros(0, np.int64), *self.rights])]
        return self.courses[0], self.rights[0]


def begun(experiment: Experiment, problem: Problem, config: Any, seed: int) -> Run:
    """A run that has not begun to learn."""
    return Run(seed, learner_for(problem, experiment.learner, config, seed))


def load(experiment: Experiment, problem: Problem, config: Any) -> None:
    """Let a learner that is thrown away learn once: to load kernels is no time of learning."""
    x, rewards, _ = block(problem, 0, 0)
    begun(experiment, problem, config, 0).learner.run(x[:1], rewards[:1])


def go_on(
    run: Run,
    problem: Problem,
    cycles: int,
    *,
    tell: Callable[[Run], None],
    keep: Callable[[Run], None],
    shall_stop: Callable[[], bool],
) -> None:
    """Learn until `cycles` are done, or it shall stop.

    tell: is called some times a second. keep: now and then, and at the end.
    """
    kept = perf_counter()
    at_once = AT_ONCE[1]
    while run.done < cycles and not shall_stop():
        took = _advance(run, problem, min(at_once, cycles - run.done))
        at_once = next_at_once(at_once, took)
        tell(run)
        if perf_counter() - kept > KEPT_EVERY:
            keep(run)
            kept = perf_counter()
    keep(run)


def next_at_once(cycles: int, took: float) -> int:
    """How many cycles to learn at once, after so many took so many seconds.

    >>> next_at_once(100, 0.2), next_at_once(100, 0.001), next_at_once(80_000, 0.001)
    (50, 200, 100000)
    """
    fewest, _, most = AT_ONCE
    return min(most, max(fewest, int(cycles * min(2.0, ATTENTION / max(took, 1e-4)))))


def block(problem: Problem, seed: int, number: int) -> tuple[Array, Array, Integers]:
    """The problems of a block: inputs, rewards of all classes, and right ones."""
    return problem.drawn(BLOCK, np.random.default_rng([seed, DRAWN_TO_LEARN, number]))


def fresh(problem: Problem, seed: int, count: int) -> tuple[Array, Integers]:
    """Problems to test on, and their classes: the same for all learners of one seed."""
    return problem.fresh(count, np.random.default_rng([seed, DRAWN_TO_TEST]))


def standing(run: Run) -> str:
    """How it stands, in a few words: `98.2 % of the last 50 tests right, 512 rules`."""
    recent = joined(run.courses[-RECENT:]), np.concatenate(run.rights[-RECENT:])
    tests = last_tests(*recent, WINDOW)
    rules = f"{run.courses[-1].rules[-1]:,} rules"
    if not len(tests):
        return rules
    return f"{100.0 * tests.mean():.0f} % of the last {len(tests)} tests right, {rules}"


def _advance(run: Run, problem: Problem, most: int) -> float:
    """So many cycles of the block that the run is in, at most; how long they took, in seconds."""
    number, inside = divmod(run.done, BLOCK)
    x, rewards, right = block(problem, run.seed, number)
    upto = min(BLOCK, inside + most)
    began = perf_counter()
    course = run.learner.run(x[inside:upto], rewards[inside:upto])
    took = perf_counter() - began
    run.courses.append(course)
    run.rights.append(right[inside:upto])
    run.done += upto - inside
    run.seconds += took
    return took
