"""Compaction: nothing is uncovered, nothing right gets wrong, and the ideal map is found."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcs.arrays import Array
from lcs.faults import LearnerError
from lcs.problems.classes import Classes, checkerboard, multiplexer
from lcs.problems.rewards import RIGHT, WRONG
from lcs.rules.compaction import compact
from lcs.rules.deciding import decide
from lcs.rules.experience import Experience, accuracy, experience_of, nearest_level, remembered
from lcs.rules.table import RuleTable
from tests.lcs.rules.tables import LEVELS, drawn_inputs, drawn_table, table_of

SEEDS = st.integers(0, 10_000)


def random_labels(seed: int, inputs: Array, actions: int) -> Array:
    """Rewards without any order; equal inputs may be told different ones."""
    chance = np.random.default_rng(seed)
    rewards = LEVELS[chance.integers(2, size=(len(inputs), actions))]
    return np.where(chance.random(rewards.shape) < 0.3, np.nan, rewards)


def drawn_case(seed: int, grid: int) -> tuple[RuleTable, Experience]:
    chance = np.random.default_rng(seed + 1)
    inputs = drawn_inputs(chance, 60, 2, grid)
    rewards = random_labels(seed, inputs, 2)
    rewards[0] = LEVELS
    return drawn_table(seed, rules=14, grid=grid), experience_of(inputs, rewards)


@settings(max_examples=40)
@given(seed=SEEDS, grid=st.sampled_from([0, 5]), few_digits=st.booleans())
def test_what_was_covered_stays_covered_and_what_was_right_stays_right(
    *, seed: int, grid: int, few_digits: bool
) -> None:
    table, seen = drawn_case(seed, grid)

    found = compact(table, seen, few_digits=few_digits)

    before, after = decide(table, seen.inputs), decide(found.table, seen.inputs)
    assert not ((before.voters > 0) & (after.voters == 0)).any()
    known = np.isfinite(seen.rewards)
    told = nearest_level(seen.rewards, LEVELS)
    was_right = known & (nearest_level(before.expected, LEVELS) == told)
    is_right = known & (nearest_level(after.expected, LEVELS) == told)
    if grid == 0:  # equal inputs with different rewards can't all be right
        assert not (was_right & ~is_right).any()
    assert is_right.sum() >= was_right.sum()
    assert found.after.expected >= found.before.expected
    assert found.after == accuracy(found.table, seen)


@settings(max_examples=30)
@given(seed=SEEDS, grid=st.sampled_from([0, 5]))
def test_compacting_again_changes_nothing(seed: int, grid: int) -> None:
    table, seen = drawn_case(seed, grid)

    once = compact(table, seen)
    twice = compact(once.table, seen)

    for name in ("action", "lower", "upper", "prediction", "weight", "right", "wrong"):
        np.testing.assert_array_equal(getattr(twice.table, name), getattr(once.table, name))


def as_if_learnt(problem: Classes, seed: int) -> RuleTable:
    """Boxes a quarter of the range wide in a problem of two inputs: right in their middle."""
    chance = np.random.default_rng(seed)
    corner = chance.random((400, 2)) * 1.2 - 0.2
    lower, upper = np.maximum(corner, 0.0), np.minimum(corner + 0.25, 1.0)
    label = problem.label((lower + upper) / 2.0)
    return table_of(
        [
            (action, low, up, RIGHT if action == right else WRONG)
            for low, up, right in zip(lower.tolist(), upper.tolist(), label, strict=True)
            for action in range(2)
        ],
        range_to=1.0,
    )


def test_of_a_checkerboard_the_fields_are_left() -> None:
    problem = checkerboard(3)
    inputs, rewards, _ = problem.drawn(20_000, np.random.default_rng(1))

    found = compact(as_if_learnt(problem, seed=2), experience_of(inputs, rewards))

    assert len(found.table) == 18  # nine fields, two actions
    assert found.after.decided == 1.0
    bounds = np.concatenate([found.table.lower, found.table.upper])
    inner = bounds[(bounds > 0.1) & (bounds < 0.9)]
    np.testing.assert_allclose(inner, np.round(3 * inner) / 3, atol=2e-3)  # gaps in 20,000 inputs


def test_of_random_boxes_the_sixteen_rules_of_the_multiplexer_are_left() -> None:
    problem, chance = multiplexer(2), np.random.default_rng(3)
    inputs, rewards, _ = problem.drawn(10_000, chance)
    corner = chance.random((300, 6)) * 0.7
    rules = [
        (k % 2, low.tolist(), np.minimum(low + 0.6, 1.0).tolist(), float(LEVELS[k // 2 % 2]))
        for k, low in enumerate(corner)
    ]

    found = compact(table_of(rules, range_to=1.0), experience_of(inputs, rewards))

    assert found.after.expected == 1.0
    assert len(found.table) == 16
    asked = (found.table.lower > 0.0) | (found.table.upper < 1.0)
    np.testing.assert_array_equal(asked.sum(axis=1), 3)  # two of the address, and one
    bounds = np.where(found.table.lower > 0.0, found.table.lower, found.table.upper)[asked]
    np.testing.assert_allclose(bounds, 0.5, atol=1e-2)  # gaps in 10,000 inputs


def test_flipped_rewards_are_passed_over() -> None:
    problem, chance = checkerboard(3), np.random.default_rng(5)
    inputs, rewards, _ = problem.drawn(10_000, chance)
    flipped = np.where(chance.random(rewards.shape) < 0.15, -rewards, rewards)

    found = compact(as_if_learnt(problem, seed=2), experience_of(inputs, flipped), noise=0.15)

    truth = accuracy(found.table, experience_of(inputs, rewards))
    assert truth.decided > 0.97
    assert len(found.table) <= 30


def test_one_tried_action_of_each_input_is_enough() -> None:
    problem, chance = checkerboard(3), np.random.default_rng(6)
    inputs, rewards, _ = problem.drawn(20_000, chance)
    tried = chance.integers(2, size=len(inputs))
    seen = remembered(inputs, tried, rewards[np.arange(len(inputs)), tried], actions=2)

    found = compact(as_if_learnt(problem, seed=2), seen)

    assert accuracy(found.table, experience_of(inputs, rewards)).decided > 0.99
    assert np.isnan(found.after.decided)
    assert found.after.uncovered <= found.before.uncovered


def test_what_can_not_be_compacted_is_refused() -> None:
    table, seen = drawn_case(0, grid=0)
    with pytest.raises(LearnerError, match="noise"):
        compact(table, seen, noise=0.5)
    with pytest.raises(LearnerError, match="2 actions"):
        compact(table, experience_of(seen.inputs, seen.rewards[:, :1]))
    many = experience_of(seen.inputs, np.random.default_rng(0).random((60, 2)))
    with pytest.raises(LearnerError, match="120"):
        compact(table, many)
    with pytest.raises(LearnerError, match="actions are 0 to 1"):
        remembered(seen.inputs, [2] * 60, [1.0] * 60, actions=2)
