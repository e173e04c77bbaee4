"""What came of a run, in a few figures."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Booleans
from lcs.curves import curve_of
from lcs.problems.problem import Problem
from specc.learning.courses import Answered, last_tests
from specc.learning.drawing import fresh
from specc.learning.learners import SavedLearner
from specc.learning.run import Run

TESTS: Final = 1_000
MOST_TESTS: Final = 10_000


@final
@dataclass(frozen=True, slots=True)
class Thinned:
    """What is left of the rules after compaction: how many, and their accuracy."""

    rules: int
    accuracy: float


@final
@dataclass(frozen=True, slots=True)
class Summary:
    """What came of the run of a seed.

    cycles; tried: those of them that learnt. accuracy: the share of `fresh` new problems that are
    decided right, where one that no rule knows counts as wrong. uncovered: the share of these.
    beyond: the share of those outside of the known range, which are taken at its end.
    performance, error: of the last tests, `tests` of them (1,000 at most): the share that was
    right, and the mean system error; None where nothing was tested. right_of_last: how many of the
    last 10,000 tests were right; None where there were fewer. rules: at the end. most_rules, at:
    most at a time, and how many cycles had been tried then. seconds: of learning.
    """

    seed: int
    cycles: int
    tried: int
    accuracy: float
    uncovered: float
    beyond: float
    fresh: int
    performance: float | None
    error: float | None
    tests: int
    right_of_last: int | None
    rules: int
    most_rules: int
    most_rules_at: int
    births: int
    deaths: int
    seconds: float
    thinned: Thinned

    @property
    def per_second(self) -> float:
        """Problems that were learnt or tested in a second."""
        return self.cycles / max(self.seconds, 1e-9)


def summed_up(
    run: Run[SavedLearner, Answered], problem: Problem, count: int, thinned: Thinned
) -> Summary:
    """The figures of a run, tested on so many fresh problems."""
    answered = run.so_far()
    course = answered.course
    x, classes = fresh(problem, run.seed, count)
    x, is_beyond = run.learner.rules().at_ends(x)
    actions, _ = run.learner.decide(x)
    is_tried = ~course.is_test
    peak = int(np.argmax(course.rules))
    tests = last_tests(answered, TESTS)
    many = last_tests(answered, MOST_TESTS)
    errors = curve_of(course, answered.right).error[-TESTS:]
    return Summary(
        seed=run.seed,
        cycles=run.done,
        tried=int(is_tried.sum()),
        accuracy=float(np.mean(actions == classes)),
        uncovered=float(np.mean(actions < 0)),
        beyond=float(np.mean(is_beyond)),
        fresh=len(x),
        performance=_mean(tests),
        error=float(errors.mean()) if len(errors) else None,
        tests=len(tests),
        right_of_last=int(many.sum()) if len(many) == MOST_TESTS else None,
        rules=int(course.rules[-1]),
        most_rules=int(course.rules[peak]),
        most_rules_at=int(is_tried[: peak + 1].sum()),
        births=int(course.births[-1]),
        deaths=int(course.deaths[-1]),
        seconds=run.seconds,
        thinned=thinned,
    )


def _mean(tests: Booleans) -> float | None:
    return float(tests.mean()) if len(tests) else None
