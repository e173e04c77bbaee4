"""`specc train`: let an arbiter of a scenario learn what to choose, and write its rules."""

from dataclasses import dataclass, fields
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, TypeAlias, final

import typer

from specc.cli.console import (
    print_json,
    print_text,
    progress_bar,
    say,
    show_diagnostics,
    shown_bar,
)
from specc.cli.options import Format, FormatOption
from specc.cli.portrait import StyleOption
from specc.cli.status import Status
from specc.cli.warming import warmed, warmed_policies
from specc.figures.style_names import Style

if TYPE_CHECKING:
    from runtime.scenario import Scenario
    from spec_schema.load import Loaded
    from specc.training.course import Course
    from specc.training.folder import Begun
    from specc.training.result import Trained


WITHOUT_CODE: Final = "train it in a scenario without Python of your own: none is run here"
"""What helps where a scenario needs Python of the user's."""
UNTRAINED: Final = "S390"
"""The code of the warning that says `run specc train`."""
AFTERWARDS: Final = "now the last race, trials that make its best list plain, and judging"


@final
class PolicyLearner(StrEnum):
    """Who learns."""

    ALCSR = "alcsr"
    XCSR = "xcsr"


@final
@dataclass(frozen=True, slots=True)
class Asked:
    """What a user says of a new training; None where nothing is said."""

    learner: PolicyLearner | None
    episodes: int | None
    held_out: int | None
    rules: int | None
    seed: int | None

    @property
    def is_something(self) -> bool:
        """Whether anything is said."""
        return any(getattr(self, each.name) is not None for each in fields(self))


@final
@dataclass(frozen=True, slots=True)
class Output:
    """What is done with the result."""

    folder: Path | None
    writes: bool
    jobs: int
    style: Style
    form: Format


ScenarioPath: TypeAlias = Annotated[
    Path | None,
    typer.Argument(help="A scenario (.yaml) that says what to `train`.", metavar="SCENARIO"),
]
By: TypeAlias = Annotated[
    PolicyLearner | None,
    typer.Option("--learner", "-l", help="Who learns; default: by whom the arbiter decides."),
]
Episodes: TypeAlias = Annotated[
    int | None,
    typer.Option("--episodes", "-n", min=1, help="To live, races included; default 4,500."),
]
HeldOut: TypeAlias = Annotated[
    int | None,
    typer.Option("--held-out", min=0, help="Worlds to judge in at the end; default 100."),
]
Rules: TypeAlias = Annotated[
    int | None, typer.Option("--rules", min=1, help="Rules, at most; default 20.")
]
Seed: TypeAlias = Annotated[
    int | None, typer.Option("--seed", min=0, help="What all chance follows from; default 0.")
]
Jobs: TypeAlias = Annotated[
    int, typer.Option("--jobs", "-j", min=1, help="Processes; the result is the same.")
]
Folder: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FOLDER",
        help="Keep the training, the arbiter with its rules, curves and the summary there.",
    ),
]
Resume: TypeAlias = Annotated[
    bool, typer.Option("--resume", help="Go on with the training that is kept in FOLDER.")
]
Write: TypeAlias = Annotated[
    bool, typer.Option("--write", help="Also write the rules into the arbiter's own file.")
]


def train(
    scenario: ScenarioPath = None,
    learner: By = None,
    episodes: Episodes = None,
    held_out: HeldOut = None,
    rules: Rules = None,
    seed: Seed = None,
    jobs: Jobs = 1,
    output: Folder = None,
    resume: Resume = False,
    write: Write = False,
    style: StyleOption = Style.SCREEN,
    form: FormatOption = Format.TEXT,
) -> int:
    """Let an arbiter of a scenario learn what to choose, and write what it learnt as rules.

    The scenario says under `train` which arbiter learns, and what its decisions are rewarded for.
    Episodes run in worlds at random. After some, all that was lived is learnt from anew. What comes
    out races with the best list so far, and with lists like that, in worlds that none of them has
    seen. The best of all generations is made plain by trials, and judged in worlds held out.

    The result is the arbiter's own YAML with a short list of rules in it: in FOLDER, and with
    --write in its place. All else in the file stays.

    Ctrl-C stops it. What a folder keeps goes on with --resume, and ends as if it had never been
    stopped; so does what was killed.

    **Examples**

    `specc train specs/scenarios/errand_learned.yaml -o out/errand --jobs 4`

    `specc train --resume -o out/errand`

    `specc train specs/scenarios/errand_learned.yaml --learner xcsr --rules 6 --format json`
    """
    asked = Asked(learner, episodes, held_out, rules, seed)
    given = Output(output, write, jobs, style, form)
    return _resumed(scenario, asked, given) if resume else _begun(scenario, asked, given)


def _begun(path: Path | None, asked: Asked, given: Output) -> Status:
    from specc.training.folder import Begun, begin_in
    from specc.training.result import text_of
    from specc.training.settings import HELD_OUT, Settings

    if path is None:
        raise typer.BadParameter("SCENARIO is missing: a .yaml that says what to `train`")
    scenario = _scenario(path)
    usual = Settings()
    episodes = asked.episodes or usual.episodes
    settings = Settings(
        learner=_learner(scenario) if asked.learner is None else asked.learner.value,
        episodes=episodes,
        first=min(usual.first, -(-episodes // 3)),
        rules=asked.rules or usual.rules,
        seed=asked.seed or usual.seed,
    )
    held_out = HELD_OUT if asked.held_out is None else asked.held_out
    begun = Begun(str(path), settings, held_out)
    text = text_of(scenario, settings.learner)
    if given.folder is not None:
        begin_in(given.folder, begun, scenario)
    return _run(begun, scenario, text, given)


def _resumed(path: Path | None, asked: Asked, given: Output) -> Status:
    from specc.training.folder import begun_in, is_finished, scenario_in
    from specc.training.result import text_of

    if given.folder is None:
        raise typer.BadParameter("name the folder that --resume goes on with: -o FOLDER")
    begun = begun_in(given.folder)
    is_other = path is not None and path.resolve() != Path(begun.scenario).resolve()
    if asked.is_something or is_other:
        raise typer.BadParameter(
            f"--resume goes on with the training of {begun.scenario} that {given.folder} keeps, "
            f"as it was begun: leave out what else is said"
        )
    now = _scenario(Path(begun.scenario))
    text, scenario = text_of(now, begun.settings.learner), scenario_in(given.folder, now)
    if is_finished(given.folder, scenario):
        return _told_again(given.folder, scenario, text, begun.settings.learner, given)
    return _run(begun, scenario, text, given)


def _told_again(
    folder: Path, scenario: "Scenario", text: "Loaded", learner: str, given: Output
) -> Status:
    """What a finished training left."""
    import json

    from specc.training.folder import RECORD, SUMMARY
    from specc.training.written import kept_text, write_in_place

    say(f"this training is finished; its results are in {folder}", "bold")
    if given.form is Format.JSON:
        print_json(json.loads((folder / RECORD).read_text(encoding="utf-8")))
    else:
        print_text((folder / SUMMARY).read_text(encoding="utf-8").rstrip("\n"))
    if given.writes:
        edited = kept_text(folder, scenario, text.source, learner)
        say(f"wrote the rules into {write_in_place(text.source, edited)}", "bold")
    return Status.YES


def _scenario(path: Path) -> "Scenario":
    """The scenario, which trains.

    Raises:
        SpecError: it is wrong, or trains nothing (V410).
    """
    from specc.faults import fault
    from specc.loading import load_scenario

    warmed(path)
    with progress_bar("specc") as bar:
        compiled = load_scenario(path, bar)
    if compiled.scenario.training is None:
        message = "this scenario trains nothing"
        remedy = "say under `train` which arbiter learns, and from which reward"
        raise fault("V410", path, message, remedy)
    show_diagnostics(each for each in compiled.warnings if each.code != UNTRAINED)
    return compiled.scenario


def _learner(scenario: "Scenario") -> str:
    """By whom the arbiter decides that is trained."""
    from specc.training.episode import trained_arbiter

    return trained_arbiter(scenario).learner


def _run(begun: "Begun", scenario: "Scenario", text: "Loaded", given: Output) -> Status:
    from specc.scenarios.failures import told_failures
    from specc.texts.training import generation_text
    from specc.training.folder import course_in, keep_in, remembered_in
    from specc.training.result import concluded
    from specc.training.training import go_on
    from specc.training.unlearnable import told_unlearnable
    from specc.training.workers import Workers

    course = course_in(given.folder)
    warmed_policies(begun.settings.learner)

    def keep(now: "Course") -> None:
        nonlocal course
        keep_in(given.folder, now)
        course = now
        with bar.aside():
            say(generation_text(now, begun.settings.tried_in))

    try:
        with (
            told_failures(scenario, WITHOUT_CODE),
            told_unlearnable(scenario),
            Workers(scenario, given.jobs) as workers,
        ):
            with shown_bar(scenario.name) as bar:
                course = go_on(course, scenario, begun.settings, workers, bar.advance, keep)
            remembered = remembered_in(given.folder, course)
            say(AFTERWARDS)
            with progress_bar(scenario.name) as tell:
                trained = concluded(begun, scenario, text, course, workers, tell, remembered)
    except KeyboardInterrupt:
        return _stopped(begun, course, given.folder)
    _tell(trained, given.form)
    _write(trained, given)
    return Status.YES


def _stopped(begun: "Begun", kept: "Course", folder: Path | None) -> Status:
    """Say how far it came with whole generations, and how it goes on."""
    if not kept.generations:
        say("interrupted in the first generation", "bold")
    elif kept.is_over(begun.settings):
        say(f"interrupted in the end, after all {kept.episodes:,} episodes", "bold")
    else:
        say(f"interrupted after {kept.episodes:,} of {begun.settings.episodes:,} episodes", "bold")
    what = "these are kept" if kept.generations else "none of it is kept yet"
    if folder is None:
        say("nothing was kept, since no folder was named: -o FOLDER")
    else:
        say(f"{what}; go on with: specc train --resume -o {folder}")
    return Status.INTERRUPTED


def _write(trained: "Trained", given: Output) -> None:
    from specc.training.folder import forget_trials
    from specc.training.written import write_all, write_in_place

    if given.folder is not None:
        with progress_bar(trained.scenario.name) as bar:
            names = write_all(trained, given.folder, given.style, bar)
        forget_trials(given.folder)
        say(f"wrote {', '.join(names)} into {given.folder}", "bold")
    if given.writes:
        path = write_in_place(trained.source, trained.edited)
        say(f"wrote the rules into {path}", "bold")


def _tell(trained: "Trained", form: Format) -> None:
    from specc.texts.training import training_record, training_text

    show_diagnostics(each for each in trained.warnings if each.code != UNTRAINED)
    if form is Format.JSON:
        print_json(training_record(trained))
    else:
        print_text(training_text(trained))
