"""Checkpoints: all that a training goes on from in one file, which is whole or as it was before."""

import io
from dataclasses import fields
from pathlib import Path
from typing import Any, Final

import numpy as np

from lcs.arrays import Array
from lcs.policies.decision_list import OF_EACH, DecisionList
from lcs.policies.steps import Steps, joined
from specc.faults import fault
from specc.files import write_atomically
from specc.kept import UNREADABLE
from specc.training.course import Course, Failure, Generation, Took, Trial

CHECKPOINT: Final = "checkpoint.npz"
VERSION: Final = 1
"""Of what its columns mean."""

OF_STEPS: Final = tuple(each.name for each in fields(Steps))
DAMAGED: Final = "begin again in another folder"


def keep(course: Course, path: Path) -> None:
    """Write a training of one generation or more; what was kept before is replaced in one step.

    Raises:
        SpecError: it can't be written (V347).
    """
    steps, every = joined(course.lived), course.generations
    failed = [each.failed for each in every]
    columns: dict[str, Any] = {
        "version": VERSION,
        "lengths": [len(each) for each in course.lived],
        **{name: getattr(steps, name) for name in OF_STEPS},
        "episodes": [each.episodes for each in every],
        "decisions": [each.decisions for each in every],
        "explored": [_numbers(each.explored) for each in every],
        "tried": [_numbers(each.tried) for each in every],
        "took": [_numbers(each.took) for each in every],
        "is_new": [each.is_new for each in every],
        "raced": [each.raced for each in every],
        "failed": np.array([(f.world, f.decisions) for each in failed for f in each], np.int64),
        "failures": [len(each) for each in failed],
        "rules": [len(each.rules) for each in every],
        "otherwise": [each.rules.otherwise for each in every],
    }
    for name in OF_EACH:
        columns[f"rules_{name}"] = np.concatenate([getattr(each.rules, name) for each in every])
    content = io.BytesIO()
    np.savez(content, **columns)
    write_atomically(path, content.getvalue())


def taken_up(path: Path) -> Course:
    """The training that was kept there.

    Raises:
        SpecError: the file is damaged, or of another version (V412).
        OSError: it can't be read.
    """
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as kept:
            return _course({name: kept[name] for name in kept.files})
    except UNREADABLE as error:
        raise fault("V412", path, f"this checkpoint can't be read: {error}", DAMAGED) from error


def _course(kept: dict[str, Any]) -> Course:
    """What the columns say.

    Raises:
        KeyError, ValueError: they are of another version, or do not fit together.
    """
    if int(kept.get("version", 0)) != VERSION:
        raise ValueError("it is of another version")
    of_steps = [_parts(kept[name], kept["lengths"]) for name in OF_STEPS]
    lived = [Steps(*columns) for columns in zip(*of_steps, strict=True)]
    of_rules = [_parts(kept[f"rules_{name}"], kept["rules"]) for name in OF_EACH]
    columns_of = zip(*of_rules, strict=True)
    rules = [
        DecisionList(action, lower, upper, right, wrong, otherwise)
        for (action, lower, upper, right, wrong), otherwise in zip(
            columns_of, kept["otherwise"].tolist(), strict=True
        )
    ]
    failed = _parts(kept["failed"], kept["failures"])
    generations = tuple(
        Generation(
            episodes=int(kept["episodes"][g]),
            decisions=int(kept["decisions"][g]),
            explored=_trial(kept["explored"][g]),
            tried=_trial(kept["tried"][g]),
            failed=tuple(Failure(*numbers) for numbers in failed[g].tolist()),
            rules=rules[g],
            is_new=bool(kept["is_new"][g]),
            raced=int(kept["raced"][g]),
            took=Took(*kept["took"][g].tolist()),
        )
        for g in range(len(rules))
    )
    return Course(tuple(lived), generations)


def _parts(column: Any, lengths: Any) -> list[Any]:
    """A column in pieces of these lengths.

    Raises:
        ValueError: it is not as long as all of them.
    """
    if lengths.sum() != len(column):
        raise ValueError("its parts do not fit together")
    return np.split(column, np.cumsum(lengths)[:-1])


def _numbers(of: Trial | Took) -> list[float]:
    return [getattr(of, each.name) for each in fields(of)]


def _trial(numbers: Array) -> Trial:
    reward, success, seconds, decisions = numbers.tolist()
    return Trial(reward, success, seconds, int(decisions))
