"""An experiment from its beginning, or from where it was stopped, to its end."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias, final

from lcs.problems.steps import Plane
from runtime.progress import Progress
from specc.faults import fault
from specc.learning import folder as folders
from specc.learning.experiment import Experiment, Subject
from specc.learning.resuming import DAMAGED, keep, taken_up
from specc.learning.run import Outcome, Run, Teacher
from specc.learning.running import go_on
from specc.learning.teaching_problems import ProblemTeacher
from specc.learning.teaching_worlds import WorldTeacher

AnyRun: TypeAlias = Run[Any, Any]
"""Of a problem, or of a world: its teacher knows."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Learnt:
    """What came of an experiment: its runs in the order of seeds, and of each what follows."""

    experiment: Experiment
    problem: Subject
    runs: tuple[AnyRun, ...]
    outcomes: tuple[Outcome[Any], ...]


@final
@dataclass(frozen=True, slots=True)
class Stopped:
    """An experiment that was stopped: the run that it stopped in, and how far that was."""

    experiment: Experiment
    seed: int
    done: int


def learnt_from(
    experiment: Experiment,
    problem: Subject,
    config: Any,
    folder: Path | None,
    *,
    tell: Progress,
    shall_stop: Callable[[], bool],
) -> tuple[AnyRun, ...] | Stopped:
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
    teacher = _teacher(experiment, problem, config)
    teacher.advance(teacher.begun(0), 1)  # to load kernels is no time of learning
    runs: list[AnyRun] = []
    for seed in experiment.seeds:
        run = _taken_up_or_begun(teacher, seed, folder)
        before = experiment.cycles * len(runs)

        def advanced(run: AnyRun, before: int = before) -> None:
            named = f"seed {run.seed}: " * (len(experiment.seeds) > 1)
            tell(
                named + teacher.standing(run),
                before + run.done,
                experiment.cycles * len(experiment.seeds),
            )

        go_on(
            run,
            teacher.advance,
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
    experiment: Experiment, problem: Subject, config: Any, runs: tuple[AnyRun, ...], tell: Progress
) -> Learnt:
    """What came of runs that are done."""
    outcomes = _teacher(experiment, problem, config).concluded(runs, tell)
    return Learnt(experiment, problem, runs, outcomes)


def _teacher(experiment: Experiment, problem: Subject, config: Any) -> Teacher[Any, Any, Any]:
    if isinstance(problem, Plane):
        return WorldTeacher(problem, config, experiment.tests)
    return ProblemTeacher(problem, experiment.learner, config, experiment.tests)


def _taken_up_or_begun(teacher: Teacher[Any, Any, Any], seed: int, folder: Path | None) -> AnyRun:
    begun: AnyRun = teacher.begun(seed)
    if folder is None or not folders.checkpoint(folder, seed).exists():
        return begun
    path = folders.checkpoint(folder, seed)
    found = taken_up(path)
    if type(found.learner) is not type(begun.learner):
        raise fault("V404", path, "this checkpoint is of another learner", DAMAGED)
    return found


def _keep(run: AnyRun, folder: Path | None, *, is_last: bool) -> None:
    if folder is not None:
        keep(run, folders.checkpoint(folder, run.seed), is_last=is_last)
