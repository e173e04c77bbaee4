"""All files that an experiment leaves in its folder."""

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from lcs.curves import curve_of, over_last
from lcs.rules.as_csv import as_csv
from lcs.rules.as_json import as_record
from lcs.rules.words import in_words
from lcs.saving import as_bytes
from runtime.progress import Progress
from specc.figures.style_names import Style
from specc.files import json_bytes, write_atomically
from specc.learning.courses import Answered, Walked
from specc.learning.folder import RECORD, SUMMARY, run_folder
from specc.learning.learning import Learnt
from specc.learning.pictures import count_of, pictures
from specc.learning.teaching_problems import WINDOW
from specc.learning.thinning import names_of
from specc.texts.learning import learning_record, learning_text

COLUMNS: Final = (
    "cycles",
    "tried",
    "right",
    "error",
    "performance",
    "system_error",
    "rules",
    "births",
    "deaths",
)


def write_all(learnt: Learnt, folder: Path, style: Style, tell: Progress) -> list[str]:
    """Write curves, rules, figures and the summary; their names in the folder.

    Raises:
        SpecError: one can't be written (V347).
    """
    written: list[str] = []
    count = 2 + 7 * len(learnt.runs) + count_of(learnt)
    for path, content in _files(learnt, folder, style):
        name = path.relative_to(folder).as_posix()
        tell(f"writing {name}", len(written), count)
        write_atomically(path, content)
        written.append(name)
    return written


def _files(learnt: Learnt, folder: Path, style: Style) -> Iterator[tuple[Path, bytes]]:
    """Each file and what it holds, the summary first: who interrupts the figures keeps it."""
    yield folder / SUMMARY, f"{learning_text(learnt)}\n".encode()
    yield folder / RECORD, json_bytes(learning_record(learnt))
    for run in learnt.runs:
        inside = run_folder(folder, run.seed)
        yield inside / "learner.npz", as_bytes(run.learner.state())
        course = run.so_far()
        yield inside / "curve.csv", _walks(course) if isinstance(course, Walked) else _csv(course)
        yield inside / "course.npz", _npz(course)
    names = names_of(learnt.problem)
    for run, outcome in zip(learnt.runs, learnt.outcomes, strict=True):
        inside, few = run_folder(folder, run.seed), outcome.compacted.table
        text = "".join(f"{each}\n" for each in in_words(few, names, outcome.seen.inputs))
        yield inside / "rules.txt", text.encode()
        yield inside / "rules.csv", as_csv(few, names).encode()
        yield inside / "rules.json", json_bytes(as_record(few, names))
        yield inside / "all_rules.csv", as_csv(run.learner.rules(), names).encode()
    for name, content in pictures(learnt, style):
        yield folder / name, content


def _csv(answered: Answered) -> bytes:
    """What each test showed, a row for each; performance and system error are of the last 50."""
    course = answered.course
    curve, at = curve_of(course, answered.right), np.flatnonzero(course.is_test)
    columns = (
        at + 1,
        curve.tries,
        curve.right.astype(np.int64),
        curve.error.round(6),
        over_last(curve.right, WINDOW).round(6),
        over_last(curve.error, WINDOW).round(6),
        course.rules[at],
        course.births[at],
        course.deaths[at],
    )
    return _table(COLUMNS, columns)


def _walks(walked: Walked) -> bytes:
    """Each episode, and what the best actions led to after it; a row for each."""
    names = [each.name for each in fields(walked)]
    columns = [getattr(walked, name) for name in names]
    rounded = [each.round(6) if each.dtype == np.float64 else each * 1 for each in columns]
    return _table(("episode", *names), (np.arange(1, len(walked.steps) + 1), *rounded))


def _table(names: Sequence[str], columns: Sequence[npt.NDArray[Any]]) -> bytes:
    """Columns as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(zip(*(column.tolist() for column in columns), strict=True))
    return text.getvalue().encode()


def _npz(course: Answered | Walked) -> bytes:
    """Every cycle or episode of a run."""
    content = io.BytesIO()
    columns = {each.name: getattr(course, each.name) for each in fields(course)}
    np.savez_compressed(content, **columns)
    return content.getvalue()
