"""Worlds of several steps, episode by episode, beside the best that can be reached there."""

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Final, TypeAlias, final

import numpy as np

from lcs.problems.optimum import optimum
from lcs.problems.steps import Plane
from lcs.rules.experience import Experience
from lcs.steps.config import Config
from lcs.steps.learner import Episodes, StepsLearner
from lcs.steps.policy import judged, policy
from runtime.progress import Progress
from specc.learning.courses import Walked
from specc.learning.drawing import followed, outside, places, starts
from specc.learning.run import Outcome, Run
from specc.learning.world_summary import WorldSummary, summed_up

CELLS: Final = 100
"""Of the optimum's grid, along each side; twice as many change the third digit of the return."""

PLACES: Final = 1_500
"""Places on which few rules say what the learner does."""

LOST: Final = 0.6
"""What an action may lose to be as good as the best: this share of what a step costs."""

Followed: TypeAlias = tuple[float, float, float]
"""Steps, return, and the share of starts from which the goal was reached, on average."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class WorldTeacher:
    """Lets a learner live in a world; tests: starts from which the best actions are followed."""

    world: Plane
    config: Config
    tests: int

    def begun(self, seed: int) -> Run[StepsLearner, Walked]:
        """A run that has not begun to learn."""
        learner = StepsLearner(self.world.actions, self.world.inputs, self.config, seed=seed)
        return Run(seed, learner, Walked.none())

    def advance(self, run: Run[StepsLearner, Walked], most: int) -> float:
        """So many episodes; how long they took, tests among them.

        What the best actions are changes only where the learner grows, so they are followed then.
        """
        began, learning, rows = perf_counter(), 0.0, []
        best = _last(run.pieces[-1]) if run.pieces else self._followed(run)
        for _ in range(most):
            grows_at, before = run.learner.due, perf_counter()
            went = run.learner.run(self.world, 1, outside(run.seed, run.done))
            learning += perf_counter() - before
            if run.learner.due != grows_at:
                best = self._followed(run)
            rows.append((went, best))
            run.done += 1
        run.pieces.append(_walked(rows))
        run.seconds += learning
        return perf_counter() - began

    def standing(self, run: Run[StepsLearner, Walked]) -> str:
        """How it stands, in a few words: `18.6 steps to the goal, 2,350 boxes`."""
        last = run.pieces[-1]
        boxes = int(last.boxes[-1])
        if boxes == 1:
            return f"{int(run.learner.land.seen[0]):,} tries, nothing known yet"
        return f"{last.best_steps[-1]:.1f} steps to the goal, {boxes:,} boxes"

    def concluded(
        self, runs: Sequence[Run[StepsLearner, Walked]], tell: Progress
    ) -> tuple[Outcome[WorldSummary], ...]:
        """What came of each of the runs, which are done."""
        tell("finding the optimum", 0, 1 + len(runs))
        best, found = optimum(self.world, CELLS), []
        for i, run in enumerate(runs):
            tell("compacting rules", 1 + i, 1 + len(runs))
            there = places(self.world, run.seed, PLACES)
            few = policy(run.learner, there, tolerance_of(self.world))
            seen = Experience(there, judged(run.learner, there, tolerance_of(self.world)))
            begun = starts(self.world, run.seed, self.tests)
            reached = best.follow(begun, followed(run.seed))
            found.append(Outcome(seen, few, summed_up(run, self.tests, reached, few)))
        return tuple(found)

    def _followed(self, run: Run[StepsLearner, Walked]) -> Followed:
        """What the best actions lead to from all starts, on average."""
        begun = starts(self.world, run.seed, self.tests)
        went = run.learner.follow(self.world, begun, followed(run.seed))
        return (
            float(went.steps.mean()),
            float(went.returns.mean()),
            float(went.reached.mean()),
        )


def tolerance_of(world: Plane) -> float:
    """The return that an action may lose and still be as good as the best."""
    return LOST * abs(world.square.each)


def _last(piece: Walked) -> Followed:
    return (
        float(piece.best_steps[-1]),
        float(piece.best_returns[-1]),
        float(piece.best_reached[-1]),
    )


def _walked(rows: Sequence[tuple[Episodes, Followed]]) -> Walked:
    """Episodes one by one, as columns."""
    steps, returns, reached, boxes = (
        np.concatenate([getattr(went, name) for went, _ in rows])
        for name in ("steps", "returns", "reached", "bodies")
    )
    return Walked(steps, returns, reached, boxes, *np.array([best for _, best in rows]).T)
