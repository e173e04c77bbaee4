"""A CSV file as a table to learn from: a line of names, then a row for each example."""

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from lcs.arrays import Integers
from lcs.encoding import Encoding
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.problems.table import Table

SEPARATORS: Final = ",;\t"
MOST_NAMES: Final = 64
"""So many different words in a column, and it is no choice between a few values."""


def read_table(path: Path, target: str | None = None, without: Sequence[str] = ()) -> Table:
    """The table in a CSV file; all its rows are to learn from and to test on, until it is split.

    A column of numbers is an input with a range; of a column of words each word is an input, which
    is 1 where it stands and else 0.

    Args:
        path: of the file, in UTF-8; fields are parted by commas, semicolons or tabs.
        target: the column that holds the class; None for the last one.
        without: columns that are no input.

    Raises:
        LearnerError: with the line and the column that can't be used.
        OSError: there is no such file.
    """
    names, lines, rows = _cells(path)
    target = names[-1] if target is None else target
    for name in (target, *without):
        if name not in names:
            raise LearnerError(f"no column is named '{name}': there are {', '.join(names)}")
    if target in without:
        raise LearnerError(
            f"'{target}' is the class (target), so it can't be left out (without): name another "
            "column in one of both"
        )
    columns = {name: [row[i] for row in rows] for i, name in enumerate(names)}
    labels, right = _classes(target, columns[target], lines)
    used = [name for name in names if name not in {target, *without}]
    if not used:
        raise LearnerError("no column is left to decide by: the inputs stand beside the class")
    encoding = Encoding(tuple(_input(name, columns[name], lines) for name in used))
    x = encoding.encoded({name: columns[name] for name in used})
    all_rows = np.arange(len(rows))
    return Table(path.stem, encoding.columns, labels, x, right, all_rows, all_rows)


def _cells(path: Path) -> tuple[list[str], list[int], list[list[str]]]:
    """The names, the numbers of the lines that rows begin in, and the rows, all stripped."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            head = file.readline()
            file.seek(0)
            separator = max(SEPARATORS, key=head.count)
            reader = csv.reader(file, delimiter=separator, strict=True)
            read = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if row]
    except UnicodeDecodeError as error:
        raise LearnerError("this is no text in UTF-8") from error
    except csv.Error as error:
        raise LearnerError(f"this is no CSV: {error}") from error
    if len(read) < 3:
        raise LearnerError("a table has a line of names and two rows at least")
    (_, names), *rest = read
    _refuse_names(names)
    for line, row in rest:
        if len(row) != len(names):
            raise LearnerError(f"line {line} has {len(row)} fields, the line of names {len(names)}")
    return names, [line for line, _ in rest], [row for _, row in rest]


def _refuse_names(names: list[str]) -> None:
    if len(names) < 2:
        raise LearnerError("there is one column only: inputs and a class are needed")
    if all(_number(name) is not None for name in names):
        raise LearnerError("line 1 holds numbers: write the names of the columns there")
    for i, name in enumerate(names):
        if not name:
            raise LearnerError(f"line 1 does not name column {i + 1}")
        if name in names[:i]:
            raise LearnerError(f"two columns are named '{name}'")


def _classes(name: str, column: list[str], lines: list[int]) -> tuple[tuple[str, ...], Integers]:
    """The names of the classes, in the order of numbers or else of the alphabet; each row's."""
    _refuse_gaps(name, column, lines)
    numbers = [_number(cell) for cell in column]
    if None in numbers:
        labels = sorted(set(column))
    else:
        labels = [cell for _, cell in sorted(set(zip(numbers, column, strict=True)))]
    if len(labels) < 2:
        raise LearnerError(f"all rows are of one class: '{name}' is always {labels[0]}")
    if len(labels) > MOST_NAMES:
        raise LearnerError(
            f"'{name}' has {len(labels)} different values, and classes are {MOST_NAMES} at most: "
            "name the column that holds the class"
        )
    place = {label: i for i, label in enumerate(labels)}
    return tuple(labels), np.array([place[cell] for cell in column])


def _input(name: str, column: list[str], lines: list[int]) -> Input:
    """What a column is: numbers in a range, or one of a few words."""
    _refuse_gaps(name, column, lines)
    numbers = [_number(cell) for cell in column]
    missing = [i for i, number in enumerate(numbers) if number is None]
    if not missing:
        values = np.array(numbers, np.float64)
        return Input(name, low=float(values.min()), high=float(values.max()))
    if 2 * len(missing) < len(numbers):
        i = missing[0]
        raise LearnerError(
            f"line {lines[i]}: '{name}' is '{column[i]}', where most rows have a number; "
            "leave the row out, or write a finite number"
        )
    words = sorted(set(column))
    if len(words) > MOST_NAMES:
        raise LearnerError(
            f"'{name}' has {len(words)} different words, and {MOST_NAMES} are the most that an "
            "input may have; leave the column out"
        )
    return Input(name, values=tuple(words))


def _refuse_gaps(name: str, column: list[str], lines: list[int]) -> None:
    for line, cell in zip(lines, column, strict=True):
        if not cell:
            raise LearnerError(f"line {line}: '{name}' is empty; leave the row out, or fill it")


def _number(text: str) -> float | None:
    """The finite number that is written there; None where none is."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if np.isfinite(number) else None
