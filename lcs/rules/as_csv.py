"""Rules as CSV, one a row, and back, bit for bit; `docs/rules.md` says what the columns mean."""

import csv
import io
import re
from collections.abc import Sequence
from typing import Final

import numpy as np

from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.rules.names import Names, names_for
from lcs.rules.table import RuleTable

FIXED: Final = ("row", "action", "name", "prediction", "weight", "right", "wrong")
HEADER: Final = re.compile(r"(?P<name>.*?)(?: \[(?P<unit>.*)\])? (?:from|below)", re.DOTALL)


def as_csv(table: RuleTable, names: Names) -> str:
    """CSV with a header, a row of the known range, a row for each action, and one for each rule.

    Values and declared ranges of inputs are not in it; `as_json` keeps them.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*FIXED, *(f"{_titled(each)} {end}" for each in names.inputs for end in ENDS)])
    known = np.stack([table.low, table.high], axis=1).reshape(-1)
    writer.writerow(["range", *[""] * 6, *map(repr, known.tolist())])
    blank = [""] * (4 + len(known))
    writer.writerows(["action", a, name, *blank] for a, name in enumerate(names.actions))
    bounds = np.stack([table.lower, table.upper], axis=2).reshape(len(table), len(known))
    for r, row in enumerate(bounds.tolist()):
        action = int(table.action[r])
        numbers = [float(table.prediction[r]), float(table.weight[r])]
        counts = [int(table.right[r]), int(table.wrong[r])]
        writer.writerow(
            ["rule", action, names.actions[action], *map(repr, numbers), *counts, *map(repr, row)]
        )
    return text.getvalue()


ENDS: Final = ("from", "below")


def _titled(each: Input) -> str:
    return f"{each.name} [{each.unit}]" if each.unit else each.name


def of_csv(text: str) -> tuple[RuleTable, Names]:
    """The rules of a text that `as_csv` made.

    Raises:
        LearnerError: a column is missing, or a value is unfit; with its line.
    """
    lines = list(csv.reader(io.StringIO(text)))
    if not lines or tuple(lines[0][: len(FIXED)]) != FIXED or len(lines[0]) % 2 == 0:
        raise LearnerError(f"the first line has to begin with {','.join(FIXED)}")
    inputs = [_input(title) for title in lines[0][len(FIXED) :: 2]]
    rows = [(i + 1, line) for i, line in enumerate(lines) if i > 0 and line]
    for at, line in rows:
        if len(line) != len(lines[0]):
            raise LearnerError(f"line {at} has {len(line)} values, the first {len(lines[0])}")
        if line[0] not in {"range", "action", "rule"}:
            raise LearnerError(f"line {at} begins with '{line[0]}'; known are range, action, rule")
    known = [_bounds(at, line) for at, line in rows if line[0] == "range"]
    if len(known) != 1:
        raise LearnerError("there has to be one line that begins with range")
    actions = [line[2] for _, line in rows if line[0] == "action"]
    rules = [(at, line) for at, line in rows if line[0] == "rule"]
    bounds = np.array([_bounds(at, line) for at, line in rules]).reshape(-1, len(inputs), 2)
    table = RuleTable(
        actions=len(actions),
        action=np.array([_whole(at, line, 1, len(actions)) for at, line in rules], np.int64),
        lower=np.ascontiguousarray(bounds[:, :, 0]),
        upper=np.ascontiguousarray(bounds[:, :, 1]),
        prediction=np.array([_number(at, line[3]) for at, line in rules], np.float64),
        weight=np.array([_number(at, line[4]) for at, line in rules], np.float64),
        right=np.array([_whole(at, line, 5) for at, line in rules], np.int64),
        wrong=np.array([_whole(at, line, 6) for at, line in rules], np.int64),
        low=np.array(known[0][::2]),
        high=np.array(known[0][1::2]),
    )
    return table, names_for(table, inputs, actions)


def _input(title: str) -> Input:
    found = HEADER.fullmatch(title)
    if found is None:
        raise LearnerError(f"a column of an input is titled 'NAME [UNIT] from', and not '{title}'")
    return Input(found["name"], found["unit"] or "")


def _bounds(at: int, line: Sequence[str]) -> list[float]:
    return [_number(at, each) for each in line[len(FIXED) :]]


def _number(at: int, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise LearnerError(f"line {at}: '{text}' is no number") from error


def _whole(at: int, line: Sequence[str], column: int, below: int | None = None) -> int:
    text = line[column]
    if not text.isdecimal() or (below is not None and int(text) >= below):
        raise LearnerError(f"line {at}: '{text}' is no {FIXED[column]}")
    return int(text)
