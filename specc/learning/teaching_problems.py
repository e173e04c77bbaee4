"""Problems of one step, cycle by cycle."""

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final, final

from lcs.problems.problem import Problem
from runtime.progress import Progress
from specc.learning.courses import Answered, joined, last_tests
from specc.learning.drawing import BLOCK, block
from specc.learning.learners import SavedLearner, learner_for
from specc.learning.run import Outcome, Run
from specc.learning.summary import Summary, summed_up
from specc.learning.thinning import figures_of, seen_by, thinned

RECENT: Final = 10
"""Pieces of a course in which the last tests are looked for, to tell how it stands."""

WINDOW: Final = 50
"""Tests of which performance is the mean, as in the thesis's figures (4.4)."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class ProblemTeacher:
    """Teaches a learner of `LEARNERS` a problem; tests: fresh problems at the end."""

    problem: Problem
    learner: str
    config: Any
    tests: int

    def begun(self, seed: int) -> Run[SavedLearner, Answered]:
        """A run that has not begun to learn."""
        return Run(
            seed, learner_for(self.problem, self.learner, self.config, seed), Answered.none()
        )

    def advance(self, run: Run[SavedLearner, Answered], most: int) -> float:
        """So many cycles of the block that the run is in, at most; how long they took."""
        number, inside = divmod(run.done, BLOCK)
        x, rewards, right = block(self.problem, run.seed, number)
        upto = min(BLOCK, inside + most)
        began = perf_counter()
        course = run.learner.run(x[inside:upto], rewards[inside:upto])
        took = perf_counter() - began
        run.pieces.append(Answered.of(course, right[inside:upto]))
        run.done += upto - inside
        run.seconds += took
        return took

    def standing(self, run: Run[SavedLearner, Answered]) -> str:
        """How it stands, in a few words: `98.2 % of the last 50 tests right, 512 rules`."""
        tests = last_tests(joined(run.pieces[-RECENT:], run.none), WINDOW)
        rules = f"{run.pieces[-1].rules[-1]:,} rules"
        if not len(tests):
            return rules
        return f"{100.0 * tests.mean():.0f} % of the last {len(tests)} tests right, {rules}"

    def concluded(
        self, runs: Sequence[Run[SavedLearner, Answered]], tell: Progress
    ) -> tuple[Outcome[Summary], ...]:
        """What came of each of the runs, which are done."""
        problem, found = self.problem, []
        for i, run in enumerate(runs):
            tell("compacting rules", 2 * i, 2 * len(runs))
            seen = seen_by(run, problem)
            few = thinned(run, problem, seen)
            tell("testing", 2 * i + 1, 2 * len(runs))
            figures = figures_of(few.table, run, problem, self.tests)
            found.append(Outcome(seen, few, summed_up(run, problem, self.tests, figures)))
        return tuple(found)
