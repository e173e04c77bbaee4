"""Decision lists: what they decide, and how few rules are chosen and made simpler."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lcs.policies.decision_list import DecisionList, always, holds, uncounted
from lcs.policies.listing import WORTH_A_RULE, Offer, counted, listed
from lcs.policies.simplifying import OF_A_DIGIT, OF_A_RULE, PASSES, simplified
from lcs.policies.weighed import weighed

INF = np.inf


def test_the_first_rule_that_holds_says_what_to_do() -> None:
    near_and_low = [[-INF, -INF]], [[0.3, 0.5]]
    lower = np.array([*near_and_low[0], [-INF, -INF]])
    upper = np.array([*near_and_low[1], [0.3, INF]])
    counts = np.zeros(2, np.int64)
    rules = DecisionList(np.array([2, 1]), lower, upper, counts, counts, 0)
    x = np.array([[0.1, 0.1], [0.1, 0.5], [0.3, 0.1]])
    assert rules.decide(x).tolist() == [2, 1, 0]
    assert rules.first(x).tolist() == [0, 1, 2]


def test_a_list_without_rules_always_says_the_same() -> None:
    assert always(3, 2).decide(np.zeros((4, 2))).tolist() == [3, 3, 3, 3]


@st.composite
def tasks(draw: st.DrawFn) -> tuple[Offer, np.ndarray, np.ndarray]:
    """Boxes, places, and costs of three actions of which one is always best."""
    chance = np.random.default_rng(draw(st.integers(0, 10_000)))
    boxes, places = draw(st.integers(0, 30)), draw(st.integers(1, 60))
    ends = np.sort(chance.random((2, boxes, 2)), axis=0)
    lower = np.where(chance.random((boxes, 2)) < 0.3, -INF, ends[0])
    upper = np.where(chance.random((boxes, 2)) < 0.3, INF, ends[1])
    cost = chance.random((places, 3))
    cost -= cost.min(axis=1, keepdims=True)
    return Offer(chance.integers(0, 3, boxes), lower, upper), chance.random((places, 2)), cost


@given(tasks(), st.integers(0, 8))
def test_a_list_has_no_more_rules_than_asked_for_and_loses_no_more_than_no_rule(
    task: tuple[Offer, np.ndarray, np.ndarray], most: int
) -> None:
    offer, x, cost = task
    rules = listed(offer, x, cost, 1, most=most)
    assert len(rules) <= most
    lost = cost[np.arange(len(x)), rules.decide(x)].sum()
    alone = cost[:, 1].sum()
    # A rule saves WORTH_A_RULE of that, so to leave out rules, conditions and digits costs at most
    # so much for each of the 8 rules, a fifth of it for their 4 bounds in 3 passes, and the digits.
    spared = most * WORTH_A_RULE * (1.0 + PASSES * 4 * (OF_A_RULE + OF_A_DIGIT))
    assert lost <= (1.0 + spared) * alone + 1e-9


@given(tasks())
def test_counts_are_of_the_places_where_a_rule_is_the_first(
    task: tuple[Offer, np.ndarray, np.ndarray],
) -> None:
    offer, x, cost = task
    rules = counted(listed(offer, x, cost, 0, most=6), x, cost <= 0.1)
    first = rules.first(x)
    for rule in range(len(rules)):
        good = cost[first == rule, rules.action[rule]] <= 0.1
        assert (rules.right[rule], rules.wrong[rule]) == (good.sum(), (~good).sum())


def test_the_boxes_that_are_right_are_found_among_many() -> None:
    chance = np.random.default_rng(5)
    x = chance.random((2_000, 3))
    best = np.where(x[:, 0] < 0.3, 1, np.where(x[:, 2] >= 0.6, 2, 0))
    cost = 1.0 - np.eye(3)[best]
    ends = np.sort(chance.random((2, 200, 3)), axis=0)
    true_lower = np.full((2, 3), -INF)
    true_upper = np.full((2, 3), INF)
    true_upper[0, 0], true_lower[1, 2] = 0.3, 0.6
    offer = Offer(
        np.append(chance.integers(0, 3, 200), [1, 2]),
        np.concatenate([ends[0], true_lower]),
        np.concatenate([ends[1], true_upper]),
    )
    rules = listed(offer, x, cost, 0, most=8)
    assert len(rules) == 2
    assert rules.decide(x).tolist() == best.tolist()
    assert rules.wrong.sum() == 0


def test_a_rule_for_few_places_goes_ahead_of_one_for_many_that_holds_there_too() -> None:
    x = np.linspace(0.0, 1.0, 1_000)[:, None]
    best = np.where(x[:, 0] < 0.1, 1, np.where(x[:, 0] < 0.9, 2, 0))
    cost = 1.0 - np.eye(3)[best]
    offer = Offer(np.array([2, 1]), np.full((2, 1), -INF), np.array([[0.9], [0.1]]))
    rules = listed(offer, x, cost, 0, most=5)
    assert rules.action.tolist() == [1, 2]
    assert rules.decide(x).tolist() == best.tolist()


def test_conditions_and_digits_that_decide_nothing_go() -> None:
    chance = np.random.default_rng(1)
    x = chance.random((4_000, 2))
    best = (x[:, 0] < 0.3).astype(int)
    cost = 1.0 - np.eye(2)[best]
    lower, upper = np.array([[-INF, 0.0012]]), np.array([[0.30001234, 0.99987]])
    before = weighed(uncounted(np.array([1]), lower, upper, 0), x, cost.T)
    short = simplified(before, 0.01 * cost[:, 0].sum())
    assert short.lower.tolist() == [[-INF, -INF]]
    assert short.upper.tolist() == [[0.3, INF]]


def test_a_box_is_closed_below_and_open_above() -> None:
    lower, upper = np.array([[0.0]]), np.array([[1.0]])
    assert holds(lower, upper, np.array([[0.0], [0.5], [1.0]])).tolist() == [[True, True, False]]
