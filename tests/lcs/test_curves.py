"""Learning curves against direct counts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lcs.arrays import Integers
from lcs.course import Course, Kind
from lcs.curves import curve_of, over_last, tries_of
from tests.study.lcs.measures import NEAR, counted_near, performance


def course_of(kinds: list[int], actions: Integers) -> Course:
    """A course of such kinds and actions; tests err by 500."""
    kind = np.array(kinds)
    none = np.zeros(len(kind), np.int64)
    return Course(kind, actions, np.where(kind == Kind.TEST, 500.0, np.nan), none, none, none)


@given(st.lists(st.booleans(), min_size=1, max_size=200), st.integers(1, 60))
def test_the_mean_over_the_last_tests_is_a_direct_count(right: list[bool], window: int) -> None:
    counted = [
        sum(right[max(0, k + 1 - window) : k + 1]) / min(window, k + 1) for k in range(len(right))
    ]

    assert over_last(np.array(right), window) == pytest.approx(counted)


@given(st.lists(st.sampled_from(list(Kind)), min_size=1, max_size=100), st.integers(0, 2**16))
def test_a_curve_has_each_test_behind_the_problems_tried_before_it(
    kinds: list[int], seed: int
) -> None:
    chance = np.random.default_rng(seed)
    actions, right = chance.integers(3, size=(2, len(kinds)))
    course = course_of(kinds, actions)
    curve = curve_of(course, right, reward_range=1000.0)

    tests = [t for t, kind in enumerate(kinds) if kind == Kind.TEST]
    before = [sum(kind != Kind.TEST for kind in kinds[:t]) for t in tests]
    assert curve.tries.tolist() == before
    assert curve.right.tolist() == [bool(actions[t] == right[t]) for t in tests]
    assert curve.error.tolist() == [0.5] * len(tests)
    assert tries_of(course)[-1] == len(kinds) - len(tests)


def test_performance_counts_the_tests_up_to_a_number_of_explore_problems() -> None:
    kinds = [Kind.TRIED, Kind.TEST] * 60
    right = np.zeros(120, np.int64)
    actions = right.copy()
    actions[1] = actions[39] = 1  # the tests after 1 and after 20 explore problems were wrong
    curve = curve_of(course_of(list(kinds), actions), right)

    assert performance(curve, 20, 50) == 18 / 20
    assert performance(curve, 20, 10) == 9 / 10
    assert performance(curve, 60, 50) == 49 / 50
    assert np.isnan(performance(curve, 61, 50))


def test_tests_near_a_number_of_explore_problems_are_those_on_both_sides_of_it() -> None:
    kinds = [Kind.TRIED, Kind.TEST] * 5_000
    right = np.zeros(10_000, np.int64)
    actions = (np.arange(10_000) // 2 + 1 > 3_000).astype(np.int64)  # wrong from 3,001 on
    curve = curve_of(course_of(list(kinds), actions), right)

    assert counted_near(curve, 2_500) == (1_750, 2 * NEAR)
