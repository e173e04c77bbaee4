"""Beyond the thesis: bodies that grow in a land that remembers, held against brute force."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcs.alcsr.config import GROWN, Beyond, Config
from lcs.alcsr.kernels.growing import grow_along
from lcs.alcsr.kernels.layout import Land, Scratch
from lcs.alcsr.kernels.remembering import count_outside, penalty_of, remember
from lcs.alcsr.kernels.sorting import sort_in
from lcs.alcsr.learner import ALCSR
from lcs.alcsr.population import Population, empty
from lcs.arrays import Array
from lcs.compiled import kernel
from lcs.faults import LearnerError
from lcs.problems.classes import checkerboard, multiplexer

BODY = np.array([[0.3, 0.2], [0.7, 0.6]])


@kernel
def grown_along(land: Land, scratch: Scratch, seed: float, reward: float, penalty: float) -> None:
    """Grow `scratch.body` of landscape 0 along its first dimension."""
    total = land.met[0]
    count_outside(land, 0, total, scratch.body[0], scratch.body[1], scratch.outside)
    sort_in(land, scratch, 0)
    grow_along(land, scratch, 0, 0, land.order[0, 0, :total], seed, reward, penalty)


@kernel
def penalty(share: float, noise: float) -> float:
    """`penalty_of`, for Python."""
    return penalty_of(share, noise)


def land_of(foods: Array, is_right: Array) -> Population:
    """A landscape of two inputs in [0, 1] that remembers these foods (N, 2)."""
    population = empty(1, 2, Config(beyond=Beyond(remembers=len(foods))), 2000.0)
    population.land.low[:], population.land.high[:] = 0.0, 1.0
    population.land.foods[0] = foods.T
    population.land.rewards[0] = np.where(is_right, 1000.0, -1000.0)
    population.land.met[0] = len(foods)
    population.scratch.body[:2] = BODY
    return population


def score(values: Array, worth: Array, low: float, up: float) -> float:
    """The worth of all foods in [low, up), closed at 1."""
    return float(worth[(values >= low) & ((values < up) | (up >= 1.0))].sum())


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10_000), st.sampled_from([0.9, 1.5, 20.0]), st.sampled_from([40, 1_000]))
def test_a_body_takes_the_interval_that_holds_most(seed: int, price: float, steps: int) -> None:
    """Steps of 1/40 make many foods of equal value, which no bound may part."""
    chance = np.random.default_rng(seed)
    foods = chance.integers(0, steps, (60, 2)) / steps
    is_right = chance.random(60) < 0.6
    population = land_of(foods, is_right)
    grown_along(population.land, population.scratch, 0.5, 1000.0, price)
    low, up = population.scratch.body[:2, 0]

    slab = (foods[:, 1] >= BODY[0, 1]) & (foods[:, 1] < BODY[1, 1])
    values, worth = foods[slab, 0], np.where(is_right[slab], 1.0, -price)
    ends = np.unique(np.concatenate([values, [0.5]]))
    lows = [0.0, *(0.5 * (ends[1:] + ends[:-1]))]
    ups = [*(0.5 * (ends[1:] + ends[:-1])), 1.0]
    best = max(score(values, worth, a, b) for a in lows for b in ups if a <= 0.5 < b)

    assert low <= 0.5 < up
    assert population.scratch.body[0, 1] == BODY[0, 1]
    assert score(values, worth, low, up) == pytest.approx(best, abs=1e-9)


@kernel
def remembered_and_sorted(land: Land, scratch: Scratch, x: Array, reward: float) -> None:
    """Food on landscape 0, and what follows for the orders."""
    remember(land, 0, x, reward)
    sort_in(land, scratch, 0)


@pytest.mark.parametrize("every", [1, 7])
def test_food_stays_in_order_while_old_food_is_forgotten(every: int) -> None:
    chance = np.random.default_rng(3)
    population = land_of(np.zeros((40, 2)), np.zeros(40, np.bool_))
    land, scratch = population.land, population.scratch
    land.met[0] = 0
    for turn in range(150):
        x = chance.integers(0, 20, 2) / 20
        if turn % every:
            kept_only(land, x)
            continue
        remembered_and_sorted(land, scratch, x, 1000.0)
        total = min(turn + 1, 40)
        for i in range(2):
            order = land.order[0, i, :total]
            assert sorted(order.tolist()) == list(range(total))
            assert np.all(np.diff(land.foods[0, i, order]) >= 0.0)
            assert sorted(land.sample[0, i, :total].tolist()) == list(range(total))


@kernel
def kept_only(land: Land, x: Array) -> None:
    """Food on landscape 0 that is not sorted in yet."""
    remember(land, 0, x, 1000.0)


@pytest.mark.parametrize(("share", "noise"), [(0.5, 0.1), (0.5, 0.2), (0.25, 0.01), (0.9, 0.05)])
def test_the_penalty_is_a_ratio_of_evidence(share: float, noise: float) -> None:
    """A region with so many wrong foods that it gains nothing is as likely inside as outside."""
    price = penalty(share, noise)
    wrong = 1.0 / (1.0 + price)
    inside = wrong * np.log(noise) + (1 - wrong) * np.log(1 - noise)
    outside = wrong * np.log(1 - share) + (1 - wrong) * np.log(share)
    assert inside == pytest.approx(outside, abs=1e-9)


def accuracy(learner: ALCSR, board: int) -> float:
    """On fresh inputs; where an action is unknown it is wrong."""
    x, _, right = checkerboard(board).drawn(20_000, np.random.default_rng(9))
    return float(np.mean(learner.decide(x)[0] == right))


@pytest.mark.parametrize(
    "beyond",
    [
        Beyond(remembers=5_000, sprouts=2),
        Beyond(remembers=5_000, grows=True),
        Beyond(remembers=5_000, withdraws=True),
        Beyond(remembers=5_000, famine=True),
        Beyond(remembers=5_000, doubts=True),
        Beyond(hunger=2_000),
        Beyond(breeds=False),
        Beyond(weighs_evidence=True),
    ],
)
def test_each_switch_can_be_turned_on_alone(beyond: Beyond) -> None:
    x, rewards, _ = checkerboard(3).drawn(12_000, np.random.default_rng(2))
    learner = ALCSR(2, 2, Config(beyond=beyond), seed=1)
    learner.run(x, rewards)

    without = ALCSR(2, 2, seed=1)
    without.run(x, rewards)
    assert accuracy(learner, 3) > 0.8  # the thesis's own has .88 by then
    if beyond.weighs_evidence:
        assert not np.array_equal(learner.rules().weight, without.rules().weight)
    elif not beyond.doubts:  # nothing is doubted where nobody withdraws
        assert learner.rules().lower.tolist() != without.rules().lower.tolist()


def test_all_together_find_each_field_of_a_board() -> None:
    x, rewards, _ = checkerboard(5).drawn(12_000, np.random.default_rng(2))
    learner = ALCSR(2, 2, GROWN, seed=1)
    learner.run(x, rewards)

    assert accuracy(learner, 5) > 0.985  # 0.994 in the study; 25 fields, two rules each
    assert len(learner.rules()) < 75


def test_noise_is_told_and_borne() -> None:
    flipped = replace(multiplexer(2), flipped=0.1)
    x, rewards, _ = flipped.drawn(15_000, np.random.default_rng(4))
    learner = ALCSR(2, 6, GROWN, seed=1)
    learner.run(x, rewards)

    fresh, _, right = multiplexer(2).drawn(20_000, np.random.default_rng(5))
    assert np.mean(learner.decide(fresh)[0] == right) > 0.95
    assert learner.population.land.noise == pytest.approx([0.1, 0.1], abs=0.06)


def test_whoever_is_not_fed_for_too_long_starves() -> None:
    learner = ALCSR(2, 2, Config(beyond=Beyond(hunger=100)), seed=1)
    x, rewards, _ = checkerboard(2).drawn(2_000, np.random.default_rng(4))
    learner.run(x, rewards)
    held = learner.rules()
    assert len(held) > 0

    corner = 0.25 * np.random.default_rng(6).random((3_000, 2))
    learner.run(corner, np.full((3_000, 2), 1000.0))

    assert not ((learner.rules().lower > 0.25).all(axis=1)).any()


def test_what_needs_a_memory_says_so() -> None:
    with pytest.raises(LearnerError, match="grows needs a land that remembers"):
        Beyond(grows=True)


def test_each_level_of_reward_gets_its_rules_with_any_number_of_actions() -> None:
    """Three actions; the first has three levels of reward, the second two, the third one."""

    def rewards(x: Array) -> Array:
        first = np.where(x[:, 0] < 0.3, 10.0, np.where(x[:, 1] > 0.6, 2.0, 0.0))
        return np.stack([first, np.where(x[:, 2] > 0.5, 5.0, -1.0), np.ones(len(x))], axis=1)

    chance = np.random.default_rng(0)
    x, fresh = chance.random((12_000, 3)), chance.random((10_000, 3))
    learner = ALCSR(3, 3, GROWN, reward_range=11.0, seed=1)
    learner.run(x, rewards(x))

    taken = learner.decide(fresh)[0]
    earned = rewards(fresh)[np.arange(len(fresh)), taken]
    assert np.mean((taken >= 0) & (earned == rewards(fresh).max(axis=1))) > 0.995
    table = learner.rules()
    assert sorted(zip(table.action.tolist(), table.prediction.tolist(), strict=True)) == [
        (0, 0.0),
        (0, 2.0),
        (0, 10.0),
        (1, -1.0),
        (1, 5.0),
        (2, 1.0),
    ]
