"""Courses of runs: pieces put together, and what the last tests among them say."""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from lcs.arrays import Booleans, Integers
from lcs.course import Course


def joined(pieces: Sequence[Course]) -> Course:
    """Pieces of one course, in their order, as one; nothing of no pieces."""
    if not pieces:
        none = np.zeros(0, np.int64)
        return Course(none, none, np.zeros(0), none, none, none)
    columns = [[getattr(piece, each.name) for piece in pieces] for each in fields(Course)]
    return Course(*(np.concatenate(column) for column in columns))


def last_tests(course: Course, right: Integers, most: int) -> Booleans:
    """Which of the last tests of a course were right, of so many at most.

    right (T,): the right actions.
    """
    tests = np.flatnonzero(course.is_test)[-most:]
    found: Booleans = course.action[tests] == right[tests]
    return found
