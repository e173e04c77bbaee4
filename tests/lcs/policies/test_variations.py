"""Lists that differ a little from one: still lists, of no more rules, and near it."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lcs.arrays import Array
from lcs.policies.decision_list import DecisionList, always
from lcs.policies.variations import Variation

ACTIONS, MOST = 3, 4


def a_list(seed: int, rules: int) -> DecisionList:
    """Rules of two inputs, most of them with bounds."""
    chance = np.random.default_rng(seed)
    low = chance.random((rules, 2))
    lower = np.where(chance.random((rules, 2)) < 0.5, low, -np.inf)
    upper = np.where(chance.random((rules, 2)) < 0.5, low + 0.3, np.inf)
    counts = np.arange(rules)
    return DecisionList(chance.integers(ACTIONS, size=rules), lower, upper, counts, counts, 0)


def variation(seed: int, *others: DecisionList) -> Variation:
    """By the chance of a seed, in the unit square."""
    places: Array = np.random.default_rng(99).random((200, 2))
    return Variation(others, places, ACTIONS, MOST, np.random.default_rng(seed))


@given(st.integers(0, 10_000), st.integers(0, MOST))
def test_what_comes_is_a_list_of_no_more_rules_than_are_allowed(seed: int, rules: int) -> None:
    made = variation(seed, a_list(seed, 3)).of(a_list(seed + 1, rules))

    assert len(made) <= MOST
    assert abs(len(made) - rules) <= 2
    assert made.lower.shape == made.upper.shape == (len(made), 2)
    assert len(made.right) == len(made.wrong) == len(made)
    assert set(made.action.tolist()) | {made.otherwise} <= set(range(ACTIONS))
    assert not np.isnan(made.lower).any()
    assert not np.isnan(made.upper).any()


@given(st.integers(0, 10_000))
def test_the_list_itself_stays_as_it_is(seed: int) -> None:
    rules = a_list(seed, 3)
    before = [rules.action.copy(), rules.lower.copy(), rules.upper.copy()]
    variation(seed, a_list(5, 2)).of(rules)
    assert all(
        (one == other).all()
        for one, other in zip(before, (rules.action, rules.lower, rules.upper), strict=True)
    )


def test_a_moved_bound_is_of_the_same_rule_and_input_and_among_the_places() -> None:
    rules = a_list(1, 3)
    varied = variation(3)
    made = [varied.moved(rules) for _ in range(50)]

    assert all((each.action == rules.action).all() for each in made)
    changed = [
        (each.lower != rules.lower).sum() + (each.upper != rules.upper).sum() for each in made
    ]
    assert max(changed) == 1
    assert sum(changed) > 25
    assert all(
        ((each.upper >= 0.0) & ((each.upper <= 1.3) | (each.upper == np.inf))).all()
        for each in made
    )


def test_what_can_not_be_done_leaves_the_list() -> None:
    bare, varied = always(1, 2), variation(4)
    for change in (varied.moved, varied.wider, varied.fewer, varied.swapped, varied.more):
        assert change(bare) is bare


def test_each_change_does_what_it_says() -> None:
    rules, varied = a_list(7, 3), variation(8, a_list(9, 2))
    assert len(varied.fewer(rules)) == 2
    assert len(varied.more(rules)) == 4
    assert sorted(varied.swapped(rules).right.tolist()) == [0, 1, 2]
    assert varied.swapped(rules).right.tolist() != [0, 1, 2]
    bounds = np.isfinite(rules.lower).sum() + np.isfinite(rules.upper).sum()
    wider = varied.wider(rules)
    assert np.isfinite(wider.lower).sum() + np.isfinite(wider.upper).sum() == bounds - 1
