"""`specc learn`: run an experiment of a learner, interrupt it, go on with it."""

from dataclasses import dataclass, fields
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias, final

import typer

from specc.cli.console import print_json, print_text, progress_bar, say
from specc.cli.interrupts import postponed
from specc.cli.options import Format, FormatOption, assignments
from specc.cli.portrait import StyleOption
from specc.cli.status import Status
from specc.cli.warming import warmed_learner
from specc.figures.style_names import Style

if TYPE_CHECKING:
    from specc.learning.experiment import Experiment
    from specc.learning.learning import Learnt, Stopped


@final
class LearnerName(StrEnum):
    """Who learns."""

    ALCSR = "alcsr"
    THESIS = "thesis"
    XCSR = "xcsr"
    STEPS = "steps"


@final
@dataclass(frozen=True, slots=True)
class Asked:
    """What a user says of a new experiment; None where nothing is said."""

    learner: LearnerName | None
    explore: float | None
    given: dict[str, str]
    settings: dict[str, str]
    runs: int | None
    seed: int | None
    tests: int | None

    @property
    def is_something(self) -> bool:
        """Whether anything is said."""
        return any(getattr(self, each.name) not in (None, {}) for each in fields(self))


ProblemName: TypeAlias = Annotated[
    str | None,
    typer.Argument(
        help="A problem by name (--list tells them), or a table: a .csv file.", metavar="PROBLEM"
    ),
]
By: TypeAlias = Annotated[
    LearnerName | None,
    typer.Option("--learner", "-l", help="Who learns; default alcsr, in a world steps."),
]
Cycles: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--cycles",
        "--episodes",
        "-n",
        min=1,
        help="Of each run, tests included; default 100,000 cycles, in a world 1,000 episodes.",
    ),
]
Explore: TypeAlias = Annotated[
    float | None,
    typer.Option(
        "--explore",
        min=0.0,
        max=1.0,
        help="Share of cycles, or of steps, that try at random; default 0.9, or 0.5.",
    ),
]
Given: TypeAlias = Annotated[
    list[str],
    typer.Option(
        "--with",
        metavar="NAME=VALUE",
        help="What the problem is made with: `flipped=0.1`. Repeatable.",
    ),
]
Constants: TypeAlias = Annotated[
    list[str],
    typer.Option(
        "--set",
        "-s",
        metavar="NAME=VALUE",
        help="A constant or a reading of the learner: `mutate=0.1`. Repeatable.",
    ),
]
Runs: TypeAlias = Annotated[
    int | None, typer.Option("--runs", min=1, help="Runs, each from a seed of its own; default 1.")
]
FirstSeed: TypeAlias = Annotated[
    int | None, typer.Option("--seed", min=0, help="Of the first run; default 0.")
]
Tests: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--tests",
        min=1,
        help="Fresh problems at the end; default 100,000, in a world 1,000 starts.",
    ),
]
Folder: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FOLDER",
        help="Keep runs, curves, figures and rules there; without it only results are printed.",
    ),
]
Resume: TypeAlias = Annotated[
    bool, typer.Option("--resume", help="Go on with the experiment that is kept in FOLDER.")
]
Listing: TypeAlias = Annotated[
    bool, typer.Option("--list", help="List problems, learners, and all that can be set.")
]


def learn(
    problem: ProblemName = None,
    learner: By = None,
    cycles: Cycles = None,
    explore: Explore = None,
    given: Given = [],  # noqa: B006  typer copies it
    settings: Constants = [],  # noqa: B006
    runs: Runs = None,
    seed: FirstSeed = None,
    tests: Tests = None,
    output: Folder = None,
    resume: Resume = False,
    listing: Listing = False,
    style: StyleOption = Style.SCREEN,
    form: FormatOption = Format.TEXT,
) -> int:
    """Let a classifier system learn a problem; see how well, how fast, and by which rules.

    In a world, such as gridworld, the reward comes after several steps, and episodes are counted.

    Ctrl-C stops it. What a folder keeps goes on with --resume, and ends with the same bits as if it
    had never been stopped; so does what was killed, from its last checkpoint. A run that is done
    goes on to more --cycles.

    Accuracy is that on fresh problems; one where some action has no rule counts as wrong.

    **Examples**

    `specc learn experiment_1 --cycles 300000 -o out/experiment_1`

    `specc learn --resume -o out/experiment_1`

    `specc learn checkerboard_3x3 --with flipped=0.1 --runs 5 --format json`

    `specc learn multiplexer_6 --learner thesis --set mutation_is=always --set sprout_width=1.15`

    `specc learn rows.csv --with target=kind --with without=time -o out/rows`

    `specc learn gridworld --episodes 2000 -o out/gridworld`

    `specc learn --list`
    """
    if listing:
        return _list(learner or LearnerName.ALCSR, form)
    asked = Asked(learner, explore, assignments(given), assignments(settings), runs, seed, tests)
    if resume:
        experiment = _resumed(problem, cycles, asked, output)
    else:
        experiment = _begun(problem, cycles, asked)
    return _run(experiment, output, style, form, is_new=not resume)


def _begun(problem: str | None, cycles: int | None, asked: Asked) -> "Experiment":
    """What is asked for."""
    from specc.learning.experiment import Experiment, usual

    if problem is None:
        raise typer.BadParameter("PROBLEM is missing; `specc learn --list` tells which there are")
    settings = dict(asked.settings)
    if asked.explore is not None:
        if "explore" in settings:
            raise typer.BadParameter("--explore and --set explore=... are one: leave one out")
        settings["explore"] = repr(asked.explore)
    first, meant = asked.seed or 0, usual(problem)
    return Experiment(
        problem=problem,
        given=asked.given,
        learner=asked.learner.value if asked.learner else meant.learner,
        settings=settings,
        cycles=cycles or meant.cycles,
        seeds=tuple(range(first, first + (asked.runs or 1))),
        tests=asked.tests or meant.tests,
    )


def _resumed(
    problem: str | None, cycles: int | None, asked: Asked, output: Path | None
) -> "Experiment":
    """What is kept in the folder, maybe with more cycles."""
    from specc.learning.experiment import usual
    from specc.learning.folder import continued, experiment_in
    from specc.learning.unchanged import refuse_changed

    if output is None:
        raise typer.BadParameter("name the folder that --resume goes on with: -o FOLDER")
    kept = experiment_in(output)
    if asked.is_something or problem not in {None, kept.problem}:
        raise typer.BadParameter(
            f"--resume goes on with the {kept.problem} that {output} keeps, as it was begun: only "
            f"--{usual(kept.problem).unit}s can be said anew"
        )
    refuse_changed(kept)
    return continued(output, kept, cycles)


def _run(
    experiment: "Experiment", output: Path | None, style: Style, form: Format, *, is_new: bool
) -> Status:
    from specc.learning.experiment import config_of, problem_of
    from specc.learning.folder import begin_in
    from specc.learning.learning import Stopped, concluded, learnt_from
    from specc.learning.unchanged import with_digest

    made = problem_of(experiment)
    config = config_of(experiment, made)
    if is_new:
        experiment = with_digest(experiment)
    if output is not None and is_new:
        begin_in(output, experiment)
    warmed_learner(experiment.learner)
    with postponed() as wanted, progress_bar(made.name) as bar:
        runs = learnt_from(experiment, made, config, output, tell=bar, shall_stop=wanted.is_set)
    if isinstance(runs, Stopped):
        return _stopped(runs, output)
    with progress_bar(made.name) as bar:
        learnt = concluded(experiment, made, config, runs, bar)
    if output is not None:
        _write(learnt, output, style)
    _tell(learnt, form)
    return Status.YES


def _stopped(learnt: "Stopped", output: Path | None) -> Status:
    """Say how far it came, and how it goes on."""
    from specc.learning.experiment import usual

    experiment = learnt.experiment
    unit = usual(experiment.problem).unit
    which = f"in the run of seed {learnt.seed}, " * (len(experiment.seeds) > 1)
    say(f"interrupted {which}after {learnt.done:,} of {experiment.cycles:,} {unit}s", "bold")
    if output is None:
        say("nothing was kept, since no folder was named: -o FOLDER")
    else:
        say(f"all of it is kept; go on with: specc learn --resume -o {output}")
    return Status.INTERRUPTED


def _write(learnt: "Learnt", output: Path, style: Style) -> None:
    from specc.learning.written import write_all

    with progress_bar(learnt.problem.name) as bar:
        names = write_all(learnt, output, style, bar)
    first = ", ".join(name for name in names if "/" not in name)
    say(f"wrote {len(names)} files into {output}: {first}, and of each run its own", "bold")


def _tell(learnt: "Learnt", form: Format) -> None:
    from specc.texts.learning import learning_record, learning_text

    if form is Format.JSON:
        print_json(learning_record(learnt))
    else:
        print_text(learning_text(learnt))


def _list(learner: LearnerName, form: Format) -> Status:
    from specc.texts.problems import listing_record, listing_text

    if form is Format.JSON:
        print_json(listing_record(learner.value))
    else:
        print_text(listing_text(learner.value))
    return Status.YES
