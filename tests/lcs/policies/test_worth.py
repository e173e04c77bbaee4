"""What actions are worth, in corridors where it can be worked out by hand."""

import numpy as np
import pytest

from lcs.faults import LearnerError
from lcs.policies.held import held
from lcs.policies.learner import DRAWS, LEARNERS, Voting, found_policy
from lcs.policies.steps import Steps, joined
from lcs.policies.worth import worth_of

DISCOUNT = 0.9
CELLS = 10


def corridor(count: int, seed: int) -> Steps:
    """Ten cells in a row; action 1 goes to the right, 0 to the left; beyond the last is a 1."""
    chance = np.random.default_rng(seed)
    cell, action = chance.integers(0, CELLS, count), chance.integers(0, 2, count)
    after = np.maximum(cell + 2 * action - 1, 0)
    ends = after == CELLS
    idle = chance.random((count, 2))
    x = np.column_stack([cell, idle[:, 0]]) + 0.0
    led_to = np.column_stack([np.minimum(after, CELLS - 1), idle[:, 1]]) + 0.0
    alone = np.ones(count, np.bool_)
    return Steps(x, action, ends.astype(float), led_to, alone, ends)


def test_a_reward_is_worth_less_by_the_discount_for_each_step_that_it_is_away() -> None:
    lived = corridor(4_000, 1)
    worth = worth_of(lived, 2, DISCOUNT, 0)
    for cell in range(CELLS):
        here = lived.x[:, 0] == cell
        right = DISCOUNT ** (CELLS - 1 - cell)
        left = DISCOUNT ** (CELLS - max(cell - 1, 0))
        # Leaves of ten steps mix neighboring cells here and there.
        assert worth[here].mean(axis=0) == pytest.approx([left, right], abs=0.03)


def test_what_was_never_tried_is_worth_as_little_as_the_least() -> None:
    lived = corridor(1_000, 2)
    worth = worth_of(lived, 3, DISCOUNT, 0)
    assert (worth[:, 2] == worth[:, :2].min()).all()


def test_where_episodes_end_at_once_an_action_is_worth_its_mean_reward() -> None:
    chance = np.random.default_rng(3)
    x, action = np.zeros((500, 1)), chance.integers(0, 2, 500)
    reward = chance.normal(action, 1.0)
    alone = np.ones(500, np.bool_)
    worth = worth_of(Steps(x, action, reward, x, alone, alone), 2, DISCOUNT, 0)
    means = [reward[action == a].mean() for a in (0, 1)]
    assert worth[0] == pytest.approx(means)


@pytest.mark.parametrize("learner", LEARNERS)
def test_rules_for_the_corridor_go_to_the_right(learner: str) -> None:
    lived = corridor(3_000, 4)
    ranges = np.zeros(2), np.array([float(CELLS), 1.0])
    found = found_policy(lived, ranges, 2, discount=DISCOUNT, learner=learner, seed=0)
    again = found_policy(lived, ranges, 2, discount=DISCOUNT, learner=learner, seed=0)
    assert [rules.otherwise for rules in found.lists] == DRAWS * [0, 1]
    for rules, same in zip(found.lists, again.lists, strict=True):
        assert rules.decide(lived.x).mean() > 0.98
        assert same.lower.tobytes() == rules.lower.tobytes()
    assert Voting(found.tables[0], 0).decide(lived.x).mean() > 0.95


def test_steps_of_episodes_are_joined_in_their_order() -> None:
    parts = [corridor(3, 5), corridor(4, 6)]
    whole = joined(parts)
    assert len(whole) == 7
    assert whole.action.tolist() == [*parts[0].action.tolist(), *parts[1].action.tolist()]


def test_a_held_choice_is_worth_all_that_it_brings_and_what_comes_after() -> None:
    x = np.arange(6.0)[:, None]
    action, reward = np.array([1, 1, 1, 0, 0, 0]), np.array([1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
    ends = np.array([False, False, False, False, True, False])
    after = np.append(x[1:], [[9.0]], axis=0)
    longer = held(Steps(x, action, reward, after, ends, ends), 0.5, 2)
    assert longer.reward.tolist() == [2.0, 4.0, 4.0, 16.0, 16.0, 32.0]
    assert longer.after[:, 0].tolist() == [2.0, 3.0, 3.0, 5.0, 5.0, 9.0]
    assert longer.discount.tolist() == [0.25, 0.25, 0.5, 0.25, 0.5, 0.5]
    assert longer.ends.tolist() == [False, False, False, True, True, False]


def test_a_choice_is_held_no_longer_than_its_episode() -> None:
    here = np.zeros((3, 1))
    one = Steps(here, np.zeros(3, np.int64), np.ones(3), here, np.arange(3) == 2, here[:, 0] > 0)
    longer = held(joined([one, one]), 1.0, 9)
    assert longer.reward.tolist() == [3.0, 2.0, 1.0, 3.0, 2.0, 1.0]


@pytest.mark.parametrize("what", ["x", "reward", "after"])
def test_what_is_not_finite_is_refused(what: str) -> None:
    lived = corridor(20, 7)
    getattr(lived, what).flat[3] = np.inf
    with pytest.raises(LearnerError):
        worth_of(lived, 2, DISCOUNT, 0)
