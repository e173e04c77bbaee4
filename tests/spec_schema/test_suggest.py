"""Distances against a slow, plain second implementation; suggestions by example."""

from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.suggest import did_you_mean, distance, nearest

WORDS = st.text("abc", max_size=6)
KEYS = ("unit", "domain", "kind", "values", "role", "relates", "hold", "closure", "about")


@cache
def slow_distance(a: str, b: str) -> int:
    """By the recursive definition."""
    if not a or not b:
        return len(a) + len(b)
    choices = [
        slow_distance(a[:-1], b) + 1,
        slow_distance(a, b[:-1]) + 1,
        slow_distance(a[:-1], b[:-1]) + (a[-1] != b[-1]),
    ]
    if len(a) > 1 and len(b) > 1 and a[-1] == b[-2] and a[-2] == b[-1]:
        choices.append(slow_distance(a[:-2], b[:-2]) + 1)
    return min(choices)


@given(WORDS, WORDS)
def test_the_distance_is_that_of_the_definition(a: str, b: str) -> None:
    assert distance(a, b) == slow_distance(a, b)


@given(WORDS, WORDS)
def test_the_distance_is_symmetric_and_zero_only_to_itself(a: str, b: str) -> None:
    assert distance(a, b) == distance(b, a)
    assert (distance(a, b) == 0) == (a == b)


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("domian", "domain"),
        ("rol", "role"),
        ("Unit", "unit"),
        ("value", "values"),
        ("closrue", "closure"),
        ("colour", None),
        ("x", None),
        ("u" * 100_000, None),
    ],
)
def test_a_slip_of_the_pen_is_recognized(written: str, meant: str | None) -> None:
    assert nearest(written, KEYS) == meant


def test_nothing_is_said_where_nothing_is_near() -> None:
    assert did_you_mean("velocity", KEYS) == ""
    assert did_you_mean("rolle", KEYS) == "did you mean 'role'?"


@given(st.text(max_size=50), st.lists(st.text(max_size=20), max_size=5))
def test_a_suggestion_is_one_of_the_candidates(word: str, candidates: list[str]) -> None:
    assert nearest(word, candidates) in [None, *candidates]
