"""All problems by name, and what each may be made with."""

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Final, Generic, TypeAlias, TypeVar, final

from lcs.faults import LearnerError
from lcs.problems.classes import SKEWED, Classes, checkerboard, multiplexer
from lcs.problems.csv_table import read_table
from lcs.problems.problem import Problem
from lcs.problems.scitos import scitos
from lcs.problems.steps import NOISE, Plane, gridworld, puddle_world
from lcs.problems.table import Table, at_random, in_folds

Value: TypeAlias = int | float | str | tuple[float, ...]
Made_co = TypeVar("Made_co", bound=Problem | Plane, covariant=True)


@final
@dataclass(frozen=True, slots=True)
class Offer(Generic[Made_co]):
    """A problem by name: what it is, how it is made, and with what if nothing else is said."""

    about: str
    make: Callable[..., Made_co]
    defaults: Mapping[str, Value] = field(default_factory=dict)


FLIPPED: Final[Mapping[str, Value]] = {"flipped": 0.0}
SPLIT: Final[Mapping[str, Value]] = {"folds": 4, "tested": 4, "shuffled": 0.0, **FLIPPED}
COLUMNS: Final[Mapping[str, Value]] = {"target": "", "without": ""}

MEANINGS: Final[Mapping[str, str]] = {
    "thresholds": "what an input reaches as a 1; several are taken in turn",
    "divisions": "fields along each input",
    "inputs": "how many inputs",
    "flipped": "the chance that a reward is the other one",
    "folds": "how many parts the rows are cut into, in their order",
    "tested": "which of these parts is tested on, from 1 on",
    "shuffled": "a share of the rows, at random, to test on instead of a part",
    "target": "the column that holds the class; without a word the last one",
    "without": "columns that are no input, parted by commas",
    "noise": "standard deviation of what chance adds to a move, along each coordinate",
}
"""What each name means that a problem is made with."""

LIMITS: Final[Mapping[str, tuple[float, float]]] = {
    "thresholds": (0.0, 1.0),
    "divisions": (1, 100),
    "inputs": (1, 24),
    "flipped": (0.0, 1.0),
    "shuffled": (0.0, 1.0),
    "noise": (0.0, 0.2),
}
"""The least and the most of what is not checked where it is used."""


def _multiplexer(address: int, thresholds: tuple[float, ...], flipped: float) -> Classes:
    return dataclasses.replace(multiplexer(address, thresholds), flipped=flipped)


def _experiment(name: str, thresholds: tuple[float, ...], flipped: float) -> Classes:
    return dataclasses.replace(multiplexer(2, thresholds), name=name, flipped=flipped)


def _checkerboard(divisions: int, inputs: int, flipped: float) -> Classes:
    return dataclasses.replace(checkerboard(divisions, inputs), flipped=flipped)


def _split(table: Table, folds: int, tested: int, shuffled: float, flipped: float) -> Table:
    table = dataclasses.replace(table, flipped=flipped)
    return at_random(table, shuffled) if shuffled else in_folds(table, folds, tested)


def _scitos(count: int, **split: Value) -> Table:
    return _split(scitos(count), **split)  # type: ignore[arg-type]  # of the types of SPLIT


def _table(path: Path, target: str, without: str, **split: Value) -> Table:
    names = [name.strip() for name in without.split(",") if name.strip()]
    return _split(read_table(path, target or None, names), **split)  # type: ignore[arg-type]


def _bits(address: int) -> Offer[Problem]:
    n = address + 2**address
    about = f"real multiplexer of {n} inputs: {address} of them name which of the others is asked"
    made = partial(_multiplexer, address)
    return Offer(about, made, {"thresholds": (0.5,), **FLIPPED})


def _board(divisions: int) -> Offer[Problem]:
    about = f"fields of two colors in turn, {divisions} along each of two inputs"
    return Offer(about, _checkerboard, {"divisions": divisions, "inputs": 2, **FLIPPED})


def _robot(count: int, which: str) -> Offer[Problem]:
    return Offer(
        f"a real robot's four actions, following walls, by {which}", partial(_scitos, count), SPLIT
    )


PROBLEMS: Final[Mapping[str, Offer[Problem]]] = {
    "experiment_1": Offer(
        "the thesis's first (4.4): the real 6-multiplexer, all thresholds 0.5",
        partial(_experiment, "experiment_1"),
        {"thresholds": (0.5,), **FLIPPED},
    ),
    "experiment_2": Offer(
        "the thesis's second: the same, thresholds 0.25 and 0.75 in turn",
        partial(_experiment, "experiment_2"),
        {"thresholds": SKEWED, **FLIPPED},
    ),
    "multiplexer_6": _bits(2),
    "multiplexer_11": _bits(3),
    "multiplexer_20": _bits(4),
    "checkerboard_3x3": _board(3),
    "checkerboard_5x5": _board(5),
    "scitos_2": _robot(2, "the least range in front and to the left"),
    "scitos_4": _robot(4, "the least ranges of four arcs"),
    "scitos_24": _robot(24, "24 ultrasonic ranges"),
}
"""In the order in which they are listed."""

WORLDS: Final[Mapping[str, Offer[Plane]]] = {
    "gridworld": Offer(
        "four moves of 0.05 in the unit square to the goal x + y > 1.9 (Lanzi et al. 2005)",
        gridworld,
        {"noise": 0.0},
    ),
    "puddles": Offer(
        "the same with noise, around puddles that cost (Sutton 1996)",
        puddle_world,
        {"noise": NOISE},
    ),
}
"""Problems of several steps, in that order too."""


def table_offer(path: Path) -> Offer[Problem]:
    """The rows of a CSV file as a problem."""
    return Offer("the rows of a table", partial(_table, path), {**COLUMNS, **SPLIT})


def made(offer: Offer[Made_co], given: Mapping[str, Value]) -> Made_co:
    """The problem, with what is given of what it may be made with.

    Raises:
        LearnerError: it can't be made so.
        OSError: the file can't be read.
    """
    for name, value in given.items():
        _refuse_outside(name, value)
    return offer.make(**{**offer.defaults, **given})


def _refuse_outside(name: str, value: Value) -> None:
    if name not in LIMITS or isinstance(value, str):
        return
    low, high = LIMITS[name]
    for each in value if isinstance(value, tuple) else (value,):
        if not low <= each <= high:
            raise LearnerError(f"{name} = {each:g}: write one from {low:g} to {high:g}")
