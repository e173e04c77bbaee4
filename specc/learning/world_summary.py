"""What came of a run in a world, in a few figures."""

from dataclasses import dataclass
from typing import final

from lcs.arrays import Array
from lcs.rules.compaction import Compacted
from lcs.steps.learner import StepsLearner
from specc.learning.courses import Walked
from specc.learning.run import Run
from specc.learning.summary import Thinned


@final
@dataclass(frozen=True, slots=True)
class WorldSummary:
    """What came of the run of a seed.

    steps, returns: what the best actions need and bring from `starts` places, on average; an
    episode is given up after 500 steps. reached: the share of the starts from which they lead to
    the goal. optimal_steps, optimal_returns: of the best that can be done from the same starts.
    tried: steps that tried an action at random, in all episodes. boxes: at the end. first_grown:
    the episode after which boxes were first grown; None for never. seconds: of learning. thinned:
    the few rules, and the share of places and actions of which they say what the learner says.
    """

    seed: int
    episodes: int
    tried: int
    steps: float
    returns: float
    reached: float
    optimal_steps: float
    optimal_returns: float
    starts: int
    boxes: int
    first_grown: int | None
    seconds: float
    thinned: Thinned

    @property
    def per_second(self) -> float:
        """Episodes that were learnt from in a second."""
        return self.episodes / max(self.seconds, 1e-9)


def summed_up(
    run: Run[StepsLearner, Walked], starts: int, optimal: tuple[Array, Array], few: Compacted
) -> WorldSummary:
    """The figures of a run, tested on so many starts; optimal: steps and returns from these."""
    walked = run.so_far()
    steps, returns = optimal
    grown = walked.boxes > 1
    return WorldSummary(
        seed=run.seed,
        episodes=run.done,
        tried=int(run.learner.land.seen[0]),
        steps=float(walked.best_steps[-1]),
        returns=float(walked.best_returns[-1]),
        reached=float(walked.best_reached[-1]),
        optimal_steps=float(steps.mean()),
        optimal_returns=float(returns.mean()),
        starts=starts,
        boxes=int(walked.boxes[-1]),
        first_grown=int(grown.argmax()) + 1 if grown.any() else None,
        seconds=run.seconds,
        thinned=Thinned(len(few.table), few.after.expected),
    )
