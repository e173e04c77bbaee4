"""Mending: rules go where a list loses most at the places where it comes itself."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lcs.policies.decision_list import DecisionList, always
from lcs.policies.listing import Offer
from lcs.policies.mending import mended
from lcs.policies.weighed import weighed

INF = np.inf


def lost(rules: DecisionList, x: np.ndarray, cost: np.ndarray) -> float:
    """What it loses at the places, summed up."""
    return float(cost[np.arange(len(x)), rules.decide(x)].sum())


@st.composite
def tasks(draw: st.DrawFn) -> tuple[DecisionList, Offer, np.ndarray, np.ndarray]:
    """A list, boxes, and places with costs of three actions of which one is always best."""
    chance = np.random.default_rng(draw(st.integers(0, 10_000)))
    boxes, places, own = draw(st.integers(1, 20)), draw(st.integers(1, 60)), draw(st.integers(0, 4))
    ends = np.sort(chance.random((2, boxes + own, 2)), axis=0)
    lower = np.where(chance.random(ends[0].shape) < 0.3, -INF, ends[0])
    upper = np.where(chance.random(ends[0].shape) < 0.3, INF, ends[1])
    actions = chance.integers(0, 3, boxes + own)
    rules = always(int(chance.integers(3)), 2)
    for k in range(own):
        rules = rules.with_rule(0, int(actions[k]), lower[k], upper[k])
    cost = chance.random((places, 3))
    cost -= cost.min(axis=1, keepdims=True)
    return rules, Offer(actions[own:], lower[own:], upper[own:]), chance.random((places, 2)), cost


@given(tasks(), st.integers(1, 5))
def test_a_mended_list_loses_less_where_it_was_mended(
    task: tuple[DecisionList, Offer, np.ndarray, np.ndarray], count: int
) -> None:
    rules, offer, x, cost = task
    made = list(mended(rules, offer, x, cost, most=50, count=count))
    assert len(made) <= 2 * count - 1
    assert all(lost(each, x, cost) < lost(rules, x, cost) for each in made)


def test_a_rule_that_goes_in_asks_for_what_matters_alone() -> None:
    chance = np.random.default_rng(2)
    x = chance.random((2_000, 2))
    cost = np.where(x[:, :1] < 0.3, [[1.0, 0.0]], [[0.0, 1.0]])
    offer = Offer(np.array([1]), np.array([[-INF, 0.001]]), np.array([[0.3, 0.999]]))
    (one,) = mended(always(0, 2), offer, x, cost, most=5, count=1)
    assert one.lower.tolist() == [[-INF, -INF]]
    assert one.upper.tolist() == [[0.3, INF]]


@given(tasks())
def test_what_a_rule_saves_is_what_the_list_with_it_loses_less(
    task: tuple[DecisionList, Offer, np.ndarray, np.ndarray],
) -> None:
    """At each place in the list, for each box: counted by the list itself."""
    rules, offer, x, cost = task
    inside = (x[None] >= offer.lower[:, None]) & (x[None] < offer.upper[:, None])
    saved = weighed(rules, x, cost.T).saved(offer.action, inside.all(axis=2).astype(float))
    for place in range(len(rules) + 1):
        for box, action in enumerate(offer.action):
            more = rules.with_rule(place, int(action), offer.lower[box], offer.upper[box])
            less = lost(rules, x, cost) - lost(more, x, cost)
            assert np.isclose(saved[place, box], less, atol=1e-9)


def test_a_list_that_is_full_gives_up_the_rule_that_is_missed_least() -> None:
    x = np.linspace(0.0, 1.0, 101)[:, None]
    cost = np.where(x < 0.5, [[0.0, 1.0]], [[1.0, 0.0]])
    idle, half = (np.array([-INF]), np.array([-1.0])), (np.array([0.5]), np.array([INF]))
    rules = always(0, 1).with_rule(0, 1, *idle)
    offer = Offer(np.array([1]), half[0][None], half[1][None])
    (one,) = mended(rules, offer, x, cost, most=1, count=1)
    assert one.lower.tolist() == [[0.5]]
    assert lost(one, x, cost) == 0.0


def test_where_nothing_is_lost_nothing_is_mended() -> None:
    x, cost = np.zeros((3, 1)), np.tile([0.0, 1.0], (3, 1))
    offer = Offer(np.array([1]), np.array([[-INF]]), np.array([[INF]]))
    assert not list(mended(always(0, 1), offer, x, cost, most=9, count=3))
    assert not list(mended(always(0, 1), offer, x[:0], cost[:0], most=9, count=3))
