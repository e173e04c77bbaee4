"""The worlds of several steps, against closed forms and the papers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lcs.problems.optimum import fewest_steps, optimum
from lcs.problems.steps import STEP, gridworld, puddle_world

PLACES = st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)).filter(lambda x: sum(x) <= 1.9)
CHANCE = np.random.default_rng(0)


@given(PLACES, st.integers(0, 3))
def test_a_step_is_one_move_within_the_border(x: tuple[float, float], action: int) -> None:
    move = STEP * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])[action]

    after, reward, ends = gridworld().step(np.array(x), action, CHANCE)

    assert np.allclose(after, np.clip(x + move, 0.0, 1.0), atol=1e-15)
    assert ends == (after.sum() > 1.9)
    assert reward == (0.0 if ends else -0.5)


@pytest.mark.parametrize(
    ("place", "cost"),
    [
        ((0.3, 0.75), 40.0),  # on the first puddle's middle line: the whole radius deep
        ((0.45, 0.5), 40.0),
        ((0.3, 0.8), 20.0),  # half the radius off it
        ((0.05, 0.75), 20.0),  # half the radius beyond its end
        ((0.45, 0.35), 20.0),
        ((0.6, 0.6), 0.0),
        ((0.35, 0.65), 0.0),
        ((0.40, 0.70), 20.0),  # in both, equally deep: the cost is that of one
    ],
)
def test_a_puddle_costs_400_times_its_depth(place: tuple[float, float], cost: float) -> None:
    x = np.array(place) - (STEP, 0.0)

    _, reward, ends = puddle_world(noise=0.0).step(x, 0, CHANCE)

    assert reward == pytest.approx(-1.0 - cost)
    assert not ends


def test_noise_has_the_spread_it_is_said_to_have() -> None:
    world, chance = puddle_world(), np.random.default_rng(1)

    after = np.array([world.step(np.array([0.5, 0.2]), 1, chance)[0] for _ in range(4_000)])

    assert np.allclose(after.mean(axis=0), (0.5, 0.25), atol=0.001)  # 6 standard errors
    assert np.allclose(after.std(axis=0), 0.01, rtol=0.07)  # 6 standard errors


def below(s: float) -> float:
    """P(x + y <= s) of a uniform place."""
    return s**2 / 2 if s < 1 else 1 - (2 - s) ** 2 / 2


def test_the_fewest_steps_are_18_6_in_the_mean_as_the_literature_has_it() -> None:
    mean = sum(below(1.9 - STEP * k) for k in range(38)) / below(1.9)
    places = np.random.default_rng(2).random((200_000, 2))

    drawn = fewest_steps(places[places.sum(axis=1) <= 1.9])

    assert round(mean, 1) == 18.6
    assert drawn.mean() == pytest.approx(mean, abs=0.1)  # 5 standard errors


def test_value_iteration_finds_the_fewest_steps() -> None:
    best = optimum(gridworld(), cells=40)
    places = np.random.default_rng(3).random((500, 2))
    places = places[places.sum(axis=1) <= 1.9]

    steps, returns = best.follow(places, CHANCE)

    assert np.array_equal(steps, fewest_steps(places))
    assert np.array_equal(returns, -0.5 * (steps - 1.0))


def test_around_the_puddles_is_longer_and_dry() -> None:
    best = optimum(puddle_world(noise=0.0), cells=40)
    behind = np.array([[0.3, 0.62]])  # below the first puddle, left of the second

    steps, returns = best.follow(behind, CHANCE)

    assert steps[0] > fewest_steps(behind)[0]
    assert returns[0] == -steps[0]
