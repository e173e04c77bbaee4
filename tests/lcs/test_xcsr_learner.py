"""XCSR as it is used, by hand where it can be, and what it refuses."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcs.course import Kind
from lcs.faults import LearnerError
from lcs.problems.classes import checkerboard
from lcs.saving import as_bytes, load, save
from lcs.xcsr.config import Bounds, Config, Outside, Selection
from lcs.xcsr.kernels.layout import COPIES, DEATHS
from lcs.xcsr.learner import XCSR

ALONE = Config(explore=1.0, theta_GA=math.inf, s_0=0.3)
"""Nobody is born but by covering."""


def test_an_update_is_the_one_of_the_algorithmic_description() -> None:
    # One classifier in [A]: p and error move to the mean until 1 / beta, then by beta; fitness
    # moves to 1, which is the accuracy of one alone relative to itself.
    learner = XCSR(1, 1, Config(N=10, explore=1.0, theta_GA=math.inf, beta=0.5))
    for reward in (1000.0, 0.0, 500.0):
        learner.act([0.5])
        learner.learn(reward)

    them = learner.population.classifiers
    assert them.prediction[0] == 500.0  # 1000; 500; 500 + .5 (500 - 500)
    assert them.error[0] == 125.0  # 0; 0 + (500 - 0) / 2 = 250; 250 + .5 (0 - 250)
    assert them.set_size[0] == 1.0
    assert them.fitness[0] == pytest.approx(1.0 - 0.99 * 0.5**3, rel=1e-12)  # from F_I = .01
    assert (them.right[0], them.wrong[0]) == (2, 1)


def test_fitness_goes_to_the_accurate_by_the_fifth_power_of_error() -> None:
    learner = XCSR(1, 1, ALONE)
    learner.act([0.5])
    learner.learn(0.0)
    learner.population.classifiers.counts[:2] = 2  # a second one that is equal, but for its error
    them = learner.population.classifiers
    for values in (them.action, them.prediction, them.fitness, them.numerosity, them.experience):
        values[1] = values[0]
    them.lower[0, 1], them.upper[0, 1] = them.lower[0, 0], them.upper[0, 0]
    them.fitness[:2], them.experience[:2], them.error[:2] = 0.0, 1_000_000, (20.0, 40.0)
    learner.population.numbers = learner.population.numbers._replace(beta=1e-9)
    learner.act([0.5])
    learner.learn(0.0)

    assert them.fitness[0] / them.fitness[1] == pytest.approx(2.0**5, rel=1e-5)  # beta is small


def test_what_comes_next_counts_by_gamma() -> None:
    # A corridor of three places with one action: reward 1000 at its end, so gamma^k x 1000 before.
    learner = XCSR(1, 1, Config(explore=1.0, theta_GA=math.inf, s_0=0.1, gamma=0.71, beta=0.2))
    places = [[0.1], [0.5], [0.9]]
    for _ in range(200):
        for at, place in enumerate(places):
            learner.act(place)
            learner.learn(1000.0 * (at == 2), places[at + 1] if at < 2 else None)

    _, expected = learner.decide(places)
    assert expected[:, 0] == pytest.approx([1000.0 * 0.71**2, 710.0, 1000.0], rel=1e-6)


@pytest.mark.parametrize("bounds", Bounds)
def test_a_checkerboard_is_learnt(bounds: Bounds) -> None:
    board = checkerboard(3)
    x, rewards, _ = board.drawn(20_000, np.random.default_rng(2))
    learner = XCSR(2, 2, Config(bounds=bounds, s_0=0.25), seed=1)
    learner.run(x, rewards)

    fresh, _, right = board.drawn(5_000, np.random.default_rng(3))
    actions, _ = learner.decide(fresh)

    assert np.mean(actions == right) > 0.97  # 99 % is usual


def test_where_all_rewards_are_known_all_are_taught() -> None:
    board = checkerboard(3)
    x, rewards, right = board.drawn(10_000, np.random.default_rng(2))
    learner = XCSR(2, 2, seed=1)
    learner.teach(x, rewards)

    assert np.mean(learner.decide(x)[0] == right) > 0.97


def test_cycle_by_cycle_is_the_same_as_all_at_once_whatever_is_asked_between() -> None:
    x, rewards, _ = checkerboard(3).drawn(1_500, np.random.default_rng(1))
    at_once, stepwise = XCSR(2, 2, seed=3), XCSR(2, 2, seed=3)

    course = at_once.run(x, rewards)
    taken = []
    for one, reward in zip(x, rewards, strict=True):
        taken.append(stepwise.act(one))
        assert stepwise.is_trying == (course.kind[len(taken) - 1] != Kind.TEST)
        stepwise.decide(x[:2])
        stepwise.learn(reward[taken[-1]])

    assert taken == course.action.tolist()
    assert as_bytes(at_once.state()) != as_bytes(XCSR(2, 2, seed=3).state())
    for ours, theirs in zip(
        at_once.population.classifiers, stepwise.population.classifiers, strict=True
    ):
        assert np.array_equal(ours, theirs)


def test_a_learner_that_was_saved_with_its_reward_owed_goes_on_bit_for_bit(tmp_path: Path) -> None:
    x, rewards, _ = checkerboard(3).drawn(2_000, np.random.default_rng(1))
    going = XCSR(2, 2, Config(N=100, explore=1.0), low=[-1.0, 0.0], seed=3)
    going.run(x[:1_000], rewards[:1_000])
    action = going.act(x[1_000])

    save(going, tmp_path / "xcsr")
    stopped = load(tmp_path / "xcsr")
    for each in (going, stopped):
        each.learn(rewards[1_000, action])
        each.run(x[1_001:], rewards[1_001:])

    assert as_bytes(going.state()) == as_bytes(stopped.state())


def test_a_saved_set_that_names_nobody_is_refused() -> None:
    learner = XCSR(2, 2)
    learner.act([0.5, 0.5])
    state = learner.state()
    state.arrays["scratch.sets"][1, 0] = 400

    with pytest.raises(LearnerError, match="not there"):
        XCSR.from_state(state)


@given(
    seed=st.integers(0, 1_000),
    most=st.integers(4, 60),
    bounds=st.sampled_from(Bounds),
    selection=st.sampled_from(Selection),
    subsumes=st.booleans(),
)
@settings(max_examples=30, deadline=None)
def test_copies_are_counted_and_never_more_than_there_may_be(
    seed: int, most: int, bounds: Bounds, selection: Selection, *, subsumes: bool
) -> None:
    config = Config(
        N=most, bounds=bounds, selection=selection, action_set_subsumption=subsumes, theta_GA=0.0
    )
    learner = XCSR(2, 2, config, seed=seed)
    x, rewards, right = checkerboard(2).drawn(400, np.random.default_rng(seed))
    course = learner.run(x, rewards)

    them, rules = learner.population.classifiers, learner.rules()
    lines = len(rules)
    assert them.counts[COPIES] == them.numerosity[:lines].sum() <= most
    assert (them.numerosity[:lines] > 0).all()
    assert lines == course.births[-1] - course.deaths[-1] == course.rules[-1]
    assert them.counts[DEATHS] == course.deaths[-1]
    assert np.array_equal(rules.right + rules.wrong, them.experience[:lines])
    assert (rules.lower >= 0.0).all()
    assert (rules.upper <= 1.0).all()
    assert (them.fitness[:lines] > 0.0).all()
    assert right.size == 400


def test_decisions_are_those_of_the_table_of_rules() -> None:
    x, rewards, _ = checkerboard(3).drawn(8_000, np.random.default_rng(1))
    learner = XCSR(2, 2, seed=3)
    learner.run(x, rewards)
    rules = learner.rules()
    asked = np.vstack([np.random.default_rng(2).random((300, 2)), [[1.0, 0.5], [0.0, 1.0]]])

    actions, expected = learner.decide(asked)

    for one, action, given_back in zip(asked, actions, expected, strict=True):
        below = (one < rules.upper) | ((one == rules.upper) & (one == rules.high))
        holds = (below & (one >= rules.lower)).all(axis=1)
        said = []
        for a in range(2):
            voters = holds & (rules.action == a)
            weight = rules.weight[voters]
            said.append(np.sum(weight * rules.prediction[voters]) / weight.sum())
        assert given_back == pytest.approx(said, rel=1e-9)
        assert action == np.argmax(said)


def test_what_is_out_of_range_is_refused_or_clipped() -> None:
    with pytest.raises(LearnerError, match=r"number 1 of an input is 7, out of its range 0 to 5"):
        XCSR(2, 2, low=[-1.0, 0.0], high=5.0).act([-1.0, 7.0])
    clipping = XCSR(2, 2, Config(outside=Outside.CLIPPED), high=5.0)
    clipping.act([9.0, 1.0])
    clipping.learn(1.0)
    assert (clipping.population.classifiers.first[0, 0]) == 5.0


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (lambda: XCSR(2, 3, low=1.0, high=1.0), "low must lie below high"),
        (lambda: XCSR(2, 3, low=[0.0, 0.0]), "3 numbers each"),
        (lambda: XCSR(2, 3, high=np.inf), "both finite"),
        (lambda: XCSR(8, 3, Config(N=10)), "N of 16 at least"),
        (lambda: XCSR(2, 3, Config(epsilon_0=0.0)), "epsilon_0 must lie above 0"),
        (lambda: XCSR(2, 3, Config(theta_mna=3)), "theta_mna is 0 to 2"),
        (lambda: XCSR(2, 3).act([0.1, np.nan, 0.2]), "not finite"),
        (lambda: XCSR(2, 3).decide([[0.1, 0.2]]), "3 numbers"),
        (lambda: XCSR(2, 3).run(np.zeros((4, 3)), np.zeros((4, 3))), "4 inputs and 2 actions"),
        (lambda: XCSR(2, 3).learn(np.inf), "finite number"),
    ],
)
def test_what_can_not_be_used_is_refused(asked: object, said: str) -> None:
    assert callable(asked)
    with pytest.raises(LearnerError, match=said):
        asked()


def test_a_reward_that_is_owed_is_asked_for() -> None:
    learner = XCSR(2, 1)
    learner.act([0.5])
    with pytest.raises(LearnerError, match="waits for its reward"):
        learner.run([[0.5]], [[0.0, 1.0]])
