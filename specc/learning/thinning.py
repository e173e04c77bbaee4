"""The rules of a run, and the few that say the same on what the run has seen."""

from typing import Final, TypeAlias

import numpy as np

from lcs.problems.problem import Problem
from lcs.problems.steps import Plane
from lcs.problems.table import Table
from lcs.rules.compaction import Compacted, compact
from lcs.rules.deciding import decide
from lcs.rules.experience import Experience, remembered
from lcs.rules.names import Names
from lcs.rules.table import RuleTable
from specc.learning.courses import Answered
from specc.learning.drawing import BLOCK, block, fresh
from specc.learning.learners import SavedLearner
from specc.learning.run import Run
from specc.learning.summary import Thinned

ProblemRun: TypeAlias = Run[SavedLearner, Answered]

REMEMBERED: Final = 10_000
"""Cycles, the last ones: what compaction goes by."""


def thinned(run: ProblemRun, problem: Problem, seen: Experience) -> Compacted:
    """Few rules that say what all rules of a run say, on what it has `seen`."""
    return compact(run.learner.rules(), seen, noise=_noise(problem))


def seen_by(run: ProblemRun, problem: Problem) -> Experience:
    """The last examples that a run learnt from.

    Of each only the reward of the action that was tried is known, as to the learner itself.
    """
    course = run.so_far().course
    first = max(0, run.done - REMEMBERED) // BLOCK
    drawn = [block(problem, run.seed, number) for number in range(first, -(-run.done // BLOCK))]
    begin = first * BLOCK
    x = np.concatenate([inputs for inputs, _, _ in drawn])[: run.done - begin]
    rewards = np.concatenate([given for _, given, _ in drawn])[: run.done - begin]
    action = course.action[begin:]
    tried = np.flatnonzero(~course.is_test[begin:])
    return remembered(x[tried], action[tried], rewards[tried, action[tried]], problem.classes)


def figures_of(small: RuleTable, run: ProblemRun, problem: Problem, count: int) -> Thinned:
    """How few they are, and how right on fresh problems; uncovered ones count as wrong."""
    x, classes = fresh(problem, run.seed, count)
    x, _ = small.at_ends(x)
    return Thinned(len(small), float(np.mean(decide(small, x).best == classes)))


def names_of(problem: Problem | Plane) -> Names:
    """What inputs and actions are called in rules."""
    if isinstance(problem, Plane):
        return Names(problem.described, problem.labels, "place", "true")
    case = "showing" if isinstance(problem, Table) else "case"
    return Names(problem.described, problem.labels, case)


def _noise(problem: Problem) -> float:
    """What compaction passes over: the share of rewards that are flipped."""
    return min(problem.flipped, 0.49)
