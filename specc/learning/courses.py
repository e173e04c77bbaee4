"""Courses of runs: what went on cycle by cycle or episode by episode, in pieces put together."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Self, TypeVar, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.course import Course


@final
@dataclass(frozen=True, eq=False, slots=True)
class Answered:
    """A course of T cycles and the right actions, all (T,), as `lcs.course.Course` has them."""

    kind: Integers
    action: Integers
    error: Array
    rules: Integers
    births: Integers
    deaths: Integers
    right: Integers

    @classmethod
    def of(cls, course: Course, right: Integers) -> Self:
        """A course, and the right actions (T,)."""
        return cls(
            **{each.name: getattr(course, each.name) for each in fields(Course)}, right=right
        )

    @classmethod
    def none(cls) -> Self:
        """No cycle."""
        count = np.zeros(0, np.int64)
        return cls(count, count, np.zeros(0), count, count, count, count)

    @property
    def course(self) -> Course:
        """What the learner told."""
        return Course(**{each.name: getattr(self, each.name) for each in fields(Course)})


@final
@dataclass(frozen=True, eq=False, slots=True)
class Walked:
    """E episodes, all (E,).

    steps, returns, reached: of the episode that was learnt in, tries at random among its steps.
    boxes: of the learner after it. best_steps, best_returns, best_reached: what the best actions
    then led to from all test starts, on average.
    """

    steps: Integers
    returns: Array
    reached: Booleans
    boxes: Integers
    best_steps: Array
    best_returns: Array
    best_reached: Array

    @classmethod
    def none(cls) -> Self:
        """No episode."""
        count, number = np.zeros(0, np.int64), np.zeros(0)
        return cls(count, number, np.zeros(0, np.bool_), count, number, number, number)


Piece = TypeVar("Piece", Answered, Walked)


def joined(pieces: Sequence[Piece], none: Piece) -> Piece:
    """Pieces of one course, in their order, as one; `none` of no pieces."""
    names = [each.name for each in fields(none)]
    columns = {name: [getattr(piece, name) for piece in (none, *pieces)] for name in names}
    return type(none)(**{name: np.concatenate(column) for name, column in columns.items()})


def last_tests(answered: Answered, most: int) -> Booleans:
    """Which of the last tests of a course were right, of so many at most."""
    tests = np.flatnonzero(answered.course.is_test)[-most:]
    found: Booleans = answered.action[tests] == answered.right[tests]
    return found
