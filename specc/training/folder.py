"""The folder of a training: what it is, the scenario that it was begun with, and where it stands.

training.json     what is trained, and how
scenario.specc    the scenario as it was, with the arbiter as it was
checkpoint.npz    all that was lived, and each policy, to go on from
trials.json       who won the last race, and what trials said since, until it is done
...               the arbiter with its rules, curves and the summary, once it is done
"""

import dataclasses
import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final, final

from runtime.arbiter import Arbiter, Rule
from runtime.program import Origin
from runtime.scenario import Robot, Scenario
from runtime.scenario_artifact import to_bytes
from specc.faults import fault
from specc.files import json_bytes, write_atomically
from specc.kept import record_in, refuse_file, refuse_taken
from specc.loading import load_scenario
from specc.origins import renamed
from specc.training.checkpoint import CHECKPOINT, keep, taken_up
from specc.training.course import Course
from specc.training.episode import trained_arbiter, training_of
from specc.training.remembered import Remembered
from specc.training.settings import Settings

TRAINING: Final = "training.json"
SCENARIO: Final = "scenario.specc"
TRIALS: Final = "trials.json"
SUMMARY: Final = "summary.txt"
RECORD: Final = "summary.json"
CURVES: Final = "curves.svg"
RESULTS: Final = SUMMARY, RECORD, CURVES
VERSION: Final = 1
"""Of the record of a training."""
TRIALS_VERSION: Final = 1
"""Of what trials said: one more whenever others are tried, or in another order."""


@final
@dataclass(frozen=True, slots=True)
class Begun:
    """What is trained, and how: all that its results follow from, beside the scenario itself.

    scenario: its path, from where one is; kept is that from the folder. held_out: worlds that are
    held out for judging.
    """

    scenario: str
    settings: Settings
    held_out: int


def begin_in(folder: Path, begun: Begun, scenario: Scenario) -> None:
    """Write what is trained, where nothing else is.

    Raises:
        SpecError: the folder holds a training (V411), is none or holds something that a training
            would write over (V414), or can't be written (V347).
    """
    refuse_file(folder, "V414")
    if (folder / TRAINING).exists():
        remedy = f"`specc train --resume -o {folder}` goes on with it; or name another folder"
        raise fault("V411", folder, "this folder holds a training already", remedy)
    names = (SCENARIO, CHECKPOINT, TRIALS, *RESULTS, arbiter_name(scenario))
    refuse_taken([folder / name for name in names], "V414", "training")
    write_atomically(folder / SCENARIO, to_bytes(scenario))
    beside = os.path.relpath(begun.scenario, folder)
    record = {"version": VERSION, **asdict(begun), "scenario": Path(beside).as_posix()}
    write_atomically(folder / TRAINING, json_bytes(record))


def begun_in(folder: Path) -> Begun:
    """What is trained there.

    Raises:
        SpecError: the folder holds no training (V411), or none that can be read (V412), or is no
            folder (V414).
        OSError: it can't be read.
    """
    refuse_file(folder, "V414")
    path = folder / TRAINING
    if not path.exists():
        lacks = f"no {TRAINING}" if folder.exists() else "it does not exist"
        remedy = "name the folder that -o named; or begin anew: specc train SCENARIO -o FOLDER"
        raise fault("V411", folder, f"there is nothing to resume in this folder: {lacks}", remedy)
    begun = record_in(path, "V412", "training", _begun_of)
    return dataclasses.replace(begun, scenario=os.path.relpath(folder / begun.scenario))


def scenario_in(folder: Path, now: Scenario) -> Scenario:
    """The scenario that a training was begun with; but for its rules it is as it is now.

    Raises:
        SpecError: it has changed (V413), or what is kept can't be read (V335).
    """
    kept = load_scenario(folder / SCENARIO).scenario
    if _essence(kept) != _essence(now):
        remedy = "put it back as it was; or begin again in another folder"
        raise fault("V413", now.source.file, _changed(kept, now), remedy)
    return kept


def course_in(folder: Path | None) -> Course:
    """The training so far; a new one where nothing is kept.

    Raises:
        SpecError: what is kept can't be read (V412).
        OSError: it can't be read.
    """
    if folder is None or not (folder / CHECKPOINT).exists():
        return Course()
    return taken_up(folder / CHECKPOINT)


def keep_in(folder: Path | None, course: Course) -> None:
    """Keep the training so far, if anywhere.

    Raises:
        SpecError: it can't be written (V347).
    """
    if folder is not None:
        keep(course, folder / CHECKPOINT)


def remembered_in(folder: Path | None, course: Course) -> Remembered:
    """What the end of the training found out so far, which keeps what is found out now.

    What was found of another course, or by other trials, is forgotten.

    Raises:
        SpecError: what is kept can't be read (V412).
        OSError: it can't be read.
    """
    if folder is None:
        return Remembered()
    path, made = folder / TRIALS, partial(_remembered_of, course=course)
    found = record_in(path, "V412", "list of trials", made) if path.exists() else None
    found = found or Remembered()
    found.keep = partial(_keep_trials, path, course=course)
    return found


def forget_trials(folder: Path) -> None:
    """What trials said is of no use once the training is done."""
    (folder / TRIALS).unlink(missing_ok=True)


def is_finished(folder: Path, scenario: Scenario) -> bool:
    """Whether everything is there that a training leaves."""
    return all((folder / name).exists() for name in (arbiter_name(scenario), *RESULTS))


def arbiter_name(scenario: Scenario) -> str:
    """The file of the arbiter that is trained, in the folder."""
    return Path(trained_arbiter(scenario).source.file).name


def _keep_trials(path: Path, found: Remembered, course: Course) -> None:
    said = {"winner": found.winner, "trials": found.trials}
    write_atomically(path, json_bytes({"of": _of(course), **said}))


def _of(course: Course) -> list[int]:
    """What trials are of: their version, and a course of so many generations and episodes."""
    return [TRIALS_VERSION, len(course.generations), course.episodes]


def _remembered_of(record: Mapping[str, Any], course: Course) -> Remembered | None:
    """What a record says; None of one that is of another course.

    Raises:
        AttributeError, KeyError, TypeError, ValueError: it is no such record.
    """
    if record["of"] != _of(course):
        return None
    winner, trials = record["winner"], record["trials"]
    if winner not in range(len(course.generations)) or type(trials) is not list:
        raise ValueError("'winner' is the place of a generation, and 'trials' a list")
    if any(type(each) is not bool for each in trials):
        raise TypeError("each of 'trials' is true or false")
    return Remembered(winner, trials)


def _begun_of(record: Mapping[str, Any]) -> Begun:
    """What a record says.

    Raises:
        AttributeError, KeyError, TypeError, ValueError: it is no record of this version.
    """
    values = dict(record)
    if values.pop("version") != VERSION:
        raise ValueError("it is of another version")
    given = values.pop("settings")
    missing = {each.name for each in dataclasses.fields(Settings)} - set(given)
    if missing:
        raise ValueError(f"it lacks {', '.join(sorted(missing))}")
    begun = Begun(**values, settings=Settings(**given))
    if not isinstance(begun.scenario, str) or type(begun.held_out) is not int:
        raise TypeError("'scenario' is a path, and 'held_out' a number of worlds")
    return begun


def _changed(kept: Scenario, now: Scenario) -> str:
    """What is another since the training was begun."""
    if kept.name != now.name:
        return f"this folder trains '{kept.name}', and not '{now.name}'"
    before = {(Path(each.file).name, each.sha256) for each in _specs(kept)}
    after = {(Path(each.file).name, each.sha256) for each in _specs(now)}
    names = sorted({name for name, _ in after - before})
    what = ", ".join(names) or "the scenario, or something that it reads,"
    return f"{what} changed since the training was begun"


def _specs(scenario: Scenario) -> Iterator[Origin]:
    """Where all its parts come from, but for the arbiter that is trained."""
    yield from (scenario.source, scenario.world.source)
    for robot in scenario.robots:
        made = robot.architecture
        yield from (robot.body.source, made.source, *(each.source for each in made.programs))
    trained = trained_arbiter(scenario)
    every = (each for robot in scenario.robots for each in robot.architecture.arbiters)
    yield from (each.source for each in every if each is not trained)


def _essence(scenario: Scenario) -> bytes:
    """All of a scenario but what its trained arbiter decides by, and from where it was read."""
    training, arbiter = training_of(scenario), trained_arbiter(scenario)
    neutral = _neutral(arbiter)

    def changed(robot: Robot) -> Robot:
        if robot.name != training.robot:
            return robot
        arbiters = [neutral if one is arbiter else one for one in robot.architecture.arbiters]
        made = dataclasses.replace(robot.architecture, arbiters=tuple(arbiters))
        return dataclasses.replace(robot, architecture=made)

    robots = tuple(changed(robot) for robot in scenario.robots)
    whole = dataclasses.replace(scenario, robots=robots)
    return to_bytes(renamed(whole, lambda file: Path(file).name))


def _neutral(arbiter: Arbiter) -> Arbiter:
    """An arbiter without rules, and without the places of its parts in its file."""
    parts: dict[str, Any] = {
        key: tuple(dataclasses.replace(one, origin="") for one in getattr(arbiter, key))
        for key in ("reads", "controls", "constants", "outputs")
    }
    return dataclasses.replace(
        arbiter,
        **parts,
        rules=(Rule(0, None, None, 0.0, ""),),
        agreement=None,
        bindings=(),
        judge_when=None,
        source=Origin(arbiter.source.file, "", ""),
        learner="alcsr",
    )
