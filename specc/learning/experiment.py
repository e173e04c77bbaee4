"""What is run: a problem, a learner, how long, and from which seeds; and what its names mean."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final, TypeAlias, final

from lcs.faults import LearnerError
from lcs.problems.problem import Problem
from lcs.problems.registry import PROBLEMS, WORLDS, Offer, Value, made, table_offer
from lcs.problems.steps import Plane
from lcs.steps.learner import StepsLearner
from spec_schema.diagnostics import Diagnostic, SpecError
from spec_schema.suggest import did_you_mean, there_are
from specc.faults import fault, mistake
from specc.learning.learners import ALL, LEARNERS, OF_WORLDS, STEPS, learner_for
from specc.learning.settings import choices, configured, value_of

TABLE: Final = ".csv"
VERSION: Final = 1
"""Of the record of an experiment."""

Subject: TypeAlias = Problem | Plane
"""What is learnt: a problem of one step, or a world of several."""


@final
@dataclass(frozen=True, slots=True)
class Experiment:
    """Everything that the figures follow from.

    problem: a name of `PROBLEMS` or `WORLDS`, or a CSV file. given: what it is made with, as it was
    written. learner: a name of `ALL`. settings: of its constants, as they were written.
    cycles: of each run, tests included; of a world episodes. seeds: one run from each. tests: fresh
    problems at the end; of a world starts.
    digest: of the table's file, SHA-256; "" where there is none.
    """

    problem: str
    given: Mapping[str, str]
    learner: str
    settings: Mapping[str, str]
    cycles: int
    seeds: tuple[int, ...]
    tests: int
    digest: str = ""


@final
@dataclass(frozen=True, slots=True)
class Usual:
    """What is meant where nothing is said, and what `cycles` counts."""

    learner: str
    cycles: int
    tests: int
    unit: str


OF_PROBLEMS: Final = Usual("alcsr", 100_000, 100_000, "cycle")
OF_STEPS: Final = Usual(STEPS, 1_000, 1_000, "episode")


def usual(problem: str) -> Usual:
    """What is meant for a problem where nothing is said."""
    return OF_STEPS if problem in WORLDS else OF_PROBLEMS


def record_of(experiment: Experiment) -> dict[str, Any]:
    """As JSON has it."""
    return {"version": VERSION, **asdict(experiment), "seeds": list(experiment.seeds)}


def experiment_of(record: Mapping[str, Any]) -> Experiment:
    """The experiment of a record.

    Raises:
        AttributeError, KeyError, TypeError, ValueError: it is no record of this version.
    """
    values = dict(record)
    if values.pop("version") != VERSION:
        raise ValueError("it is of another version")
    found = Experiment(**{**values, "seeds": tuple(values["seeds"])})
    _refuse_unfit(found)
    return found


def problem_of(experiment: Experiment) -> Subject:
    """The problem or the world that is learnt.

    Raises:
        SpecError: it is unknown (V401), a name or value of it is wrong (V341, V342), or a table or
            what it is made with does not fit (V402).
        OSError: the file of a table can't be read.
    """
    offer = offer_of(experiment.problem)
    try:
        return made(offer, _values(offer, experiment.given, experiment.problem))
    except LearnerError as error:
        raise fault("V402", experiment.problem, str(error)) from error


def config_of(experiment: Experiment, made: Subject) -> Any:
    """The config of the learner, which is tried on the problem.

    Raises:
        SpecError: a constant or reading is unknown (V341), or can't have that value, alone or
            beside the others, or the learner learns no such problems (V342).
    """
    named = ", ".join(f"{name}={text}" for name, text in experiment.settings.items())
    _refuse_other_learners(experiment, made)
    known = ALL[experiment.learner]
    try:
        config = configured(known.config, experiment.settings, experiment.learner)
        if isinstance(made, Plane):
            StepsLearner(made.actions, made.inputs, config)
        else:
            learner_for(made, experiment.learner, config, 0)
    except LearnerError as error:
        raise fault("V342", named or experiment.learner, str(error)) from error
    if not 0.0 <= config.explore <= 1.0:
        raise fault("V342", named, "explore is a share, from 0 to 1")
    return config


def offer_of(name: str) -> Offer[Subject]:
    """The problem or the world of a name, or the table of a file.

    Raises:
        SpecError: nothing is named so (V401).
    """
    if name in PROBLEMS:
        return PROBLEMS[name]
    if name in WORLDS:
        return WORLDS[name]
    if Path(name).is_dir():
        raise fault("V401", name, "this is a folder", "name a table in it: a .csv file")
    if is_table(name):
        return table_offer(Path(name))
    remedy = did_you_mean(name, [*PROBLEMS, *WORLDS])
    remedy = remedy or "`specc learn --list` lists them; a table is named by its file, rows.csv"
    raise fault("V401", name, f"no problem is named '{name}'", remedy)


def _refuse_other_learners(experiment: Experiment, made: Subject) -> None:
    of_them, what = (OF_WORLDS, "a world") if isinstance(made, Plane) else (LEARNERS, "a problem")
    if experiment.learner not in of_them:
        steps = "several steps" if isinstance(made, Plane) else "one step"
        message = f"{experiment.problem} is {what} of {steps}, which it does not learn"
        written = " or ".join(f"--learner {name}" for name in of_them)
        raise fault("V342", f"--learner {experiment.learner}", message, f"write {written}")


def _refuse_unfit(read: Experiment) -> None:
    """A record is a file that somebody may have edited."""
    for name, least in (("cycles", 1), ("tests", 1), ("seeds", 0)):
        given = getattr(read, name)
        for each in given if name == "seeds" else [given]:
            if type(each) is not int or each < least:
                raise ValueError(f"'{name}' has {each!r}: whole numbers from {least} on fit")
    if not read.seeds:
        raise ValueError("'seeds' is empty")
    written = [*read.given.items(), *read.settings.items(), (read.problem, read.learner)]
    for each in (word for words in written for word in words):
        if not isinstance(each, str):
            raise TypeError(f"{each!r} is no text")
    if read.learner not in ALL:
        raise ValueError(f"no learner is named '{read.learner}'")


def is_table(problem: str) -> bool:
    """Whether a problem is the table of a file."""
    return problem not in {*PROBLEMS, *WORLDS} and Path(problem).suffix.lower() == TABLE


def _values(offer: Offer[Subject], given: Mapping[str, str], named: str) -> dict[str, Value]:
    """What the problem is made with, as values."""
    values: dict[str, Any] = {}
    problems: list[Diagnostic] = []
    for name, text in given.items():
        if name not in offer.defaults:
            remedy = did_you_mean(name, list(offer.defaults)) or there_are(list(offer.defaults))
            message = f"{named} is not made with '{name}'"
            problems.append(mistake("V341", f"{name}={text}", message, remedy))
            continue
        like = offer.defaults[name]
        try:
            values[name] = value_of(text, like)
        except ValueError as error:
            problems.append(mistake("V342", f"{name}={text}", str(error), choices(like)))
    if problems:
        raise SpecError(problems)
    return values
