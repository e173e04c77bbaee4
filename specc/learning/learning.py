"""An experiment from its beginning, or from where it was stopped, to its end."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from lcs.problems.problem import Problem
from lcs.rules.compaction import Compacted
from lcs.rules.experience import Experience
from specc.learning import folder as folders
from specc.learning.experiment import Experiment
from specc.learning.resuming import keep, taken_up
from specc.learning.running import Run, begun, go_on, load, standing
from specc.learning.summary import Summary, summed_up
from specc.learning.thinning import figures_of, seen_by, thinned


@final
@dataclass(frozen=True, eq=False, slots=True)
class Learnt:
    """What came of an experiment: its runs in the order of seeds; of each, what follows from it.

    seen: the last examples that a run learnt from. compacted: few rules that say the same on them.
    """

    experiment: Experiment
    problem: Problem
    runs: tuple[Run, ...]
    seen: tuple[Experience, ...]
    compacted: tuple[Compacted, ...]
    summaries: tuple[Summary, ...]


@final
@dataclass(frozen=True, slots=True)
class Stopped:
    """An experiment that was stopped: the run that it stopped in, and how far that was."""

    experiment: Experiment
    seed: int
    done: int


def learnt_from(
    experiment: Experiment,
    problem: Problem,
    config: Any,
    folder: Path | None,
    *,
    tell: Callable[[str, int, int], None],
    shall_stop: Callable[[], bool],
) -> tuple[Run, ...] | Stopped:
    """All runs of an experiment, or what is left of them.

    Args:
        experiment: what is run. problem, config: what its names mean.
        folder: where runs are kept, and taken up again; None for nowhere.
        tell: is told what is done, how much of it, and of how much.
        shall_stop: whether to stop now; what was learnt is kept first.

    Raises:
        SpecError: the experiment can't be run, or a checkpoint can't be read or written.
        OSError: a checkpoint can't be read.
    """
    load(experiment, problem, config)
    runs: list[Run] = []
    for seed in experiment.seeds:
        run = _taken_up_or_begun(experiment, problem, config, seed, folder)
        before = experiment.cycles * len(runs)

        def advanced(run: Run, before: int = before) -> None:
            named = f"seed {run.seed}: " * (len(experiment.seeds) > 1)
            tell(
                named + standing(run), before + run.done, experiment.cycles * len(experiment.seeds)
            )

        go_on(
            run,
            problem,
            experiment.cycles,
            tell=advanced,
            keep=lambda run: _keep(run, folder, is_last=run.done == experiment.cycles),
            shall_stop=shall_stop,
        )
        if run.done < experiment.cycles:
            return Stopped(experiment, seed, run.done)
        runs.append(run)
    return tuple(runs)


def concluded(
    experiment: Experiment,
    problem: Problem,
    runs: tuple[Run, ...],
    tell: Callable[[str, int, int], None],
) -> Learnt:
    """What came of runs that are done."""
    seen = tuple(seen_by(run, problem) for run in runs)
    compacted, summaries = [], []
    for i, run in enumerate(runs):
        tell("compacting rules", 2 * i, 2 * len(runs))
        few = thinned(run, problem, seen[i])
        tell("testing", 2 * i + 1, 2 * len(runs))
        figures = figures_of(few.table, run, problem, experiment.tests)
        compacted.append(few)
        summaries.append(summed_up(run, problem, experiment.tests, figures))
    return Learnt(experiment, problem, runs, seen, tuple(compacted), tuple(summaries))


def _taken_up_or_begun(
    experiment: Experiment, problem: Problem, config: Any, seed: int, folder: Path | None
) -> Run:
    if folder is not None and folders.checkpoint(folder, seed).exists():
        return taken_up(folders.checkpoint(folder, seed))
    return begun(experiment, problem, config, seed)


def _keep(run: Run, folder: Path | None, *, is_last: bool) -> None:
    if folder is not None:
        keep(run, folders.checkpoint(folder, run.seed), is_last=is_last)
