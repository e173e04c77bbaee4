"""The learner as it is used: act and learn, run, decide, and what it refuses."""

import numpy as np
import pytest

from lcs.alcsr.config import Config, Readings
from lcs.alcsr.definition.accuracy import feed
from lcs.alcsr.definition.covering import cover
from lcs.alcsr.definition.cycle import live_on
from lcs.alcsr.definition.organisms import Landscape, World, covers, experience
from lcs.alcsr.learner import ALCSR
from lcs.alcsr.readings import RangeIs
from lcs.faults import LearnerError
from lcs.problems.classes import SKEWED, checkerboard, multiplexer


def test_cycle_by_cycle_is_the_same_as_all_at_once() -> None:
    x, rewards, _ = checkerboard(3).drawn(3_000, np.random.default_rng(1))
    at_once, stepwise = ALCSR(2, 2, seed=3), ALCSR(2, 2, seed=3)

    course = at_once.run(x, rewards)
    taken = []
    for one, given in zip(x, rewards, strict=True):
        taken.append(stepwise.act(one))
        stepwise.learn(given[taken[-1]])

    assert taken == course.action.tolist()
    for ours, theirs in zip(at_once.population.rules, stepwise.population.rules, strict=True):
        assert np.array_equal(ours, theirs)


def test_two_learners_in_one_process_do_not_disturb_each_other() -> None:
    x, rewards, _ = checkerboard(3).drawn(1_000, np.random.default_rng(1))
    alone = ALCSR(2, 2, seed=5).run(x, rewards)
    one, other = ALCSR(2, 2, seed=5), ALCSR(2, 2, seed=6)
    actions = []
    for part in np.split(np.arange(1_000), 10):
        actions += one.run(x[part], rewards[part]).action.tolist()
        other.run(x[part], rewards[part])
        np.random.default_rng().random()

    assert actions == alone.action.tolist()


def test_a_checkerboard_is_learnt() -> None:
    board = checkerboard(3)
    x, rewards, _ = board.drawn(40_000, np.random.default_rng(2))
    learner = ALCSR(2, 2, Config(), seed=1)
    learner.run(x, rewards)

    fresh, _, right = board.drawn(5_000, np.random.default_rng(3))
    actions, _ = learner.decide(fresh)

    assert np.mean(actions == right) > 0.95


@pytest.mark.parametrize("thresholds", [(0.5,), SKEWED])
def test_the_multiplexer_asks_the_bit_that_its_address_names(thresholds: tuple[float, ...]) -> None:
    problem = multiplexer(2, thresholds)
    at = np.resize(thresholds, 6)
    x = np.random.default_rng(0).random((200, 6))

    for one, label in zip(x, problem.label(x), strict=True):
        high = one >= at
        asked = 2 * int(high[0]) + int(high[1])
        assert label == high[2 + asked]


def test_what_is_no_input_and_what_is_no_reward_is_refused() -> None:
    learner = ALCSR(2, 3)
    with pytest.raises(LearnerError, match="3 numbers"):
        learner.act([1.0, 2.0])
    with pytest.raises(LearnerError, match="not finite"):
        learner.act([1.0, np.nan, 2.0])
    learner.act([0.1, 0.2, 0.3])
    with pytest.raises(LearnerError, match="finite number"):
        learner.learn(np.inf)
    with pytest.raises(LearnerError, match="waits for its reward"):
        learner.act([0.1, 0.2, 0.3])


def test_all_rewards_of_an_input_are_learnt_in_turn_as_the_definition_has_it() -> None:
    x, rewards, _ = checkerboard(3).drawn(1_500, np.random.default_rng(2))
    learner = ALCSR(2, 2, seed=1)
    learner.teach(x[:1_000], rewards[:1_000])
    learner.teach(x[1_000:], rewards[1_000:])

    world = World(Config(), [Landscape(), Landscape()], [np.inf] * 2, [-np.inf] * 2, 2000.0)
    rng = np.random.default_rng(1)
    for one, given in zip(x.tolist(), rewards.tolist(), strict=True):
        experience(world, one)
        for land, reward in zip(world.landscapes, given, strict=True):
            feeding = [each for each in land.organisms if covers(world, each, one)]
            if feeding:
                feed(world, feeding, one, reward)
                live_on(world, land, feeding, rng)
            else:
                cover(world, land, one, reward, rng)

    rules = learner.population.rules
    for a, land in enumerate(world.landscapes):
        assert rules.living[a] == len(land.organisms)
        for name in ("lower", "upper", "prediction", "strength", "experience"):
            expected = [getattr(each, name) for each in land.organisms]
            assert getattr(rules, name)[a, : rules.living[a]].tolist() == expected


def test_the_weights_of_a_table_are_numbers_above_zero() -> None:
    learner = ALCSR(2, 2)
    x, rewards, _ = checkerboard(3).drawn(20, np.random.default_rng(2))
    learner.teach(x, rewards)  # the first rule is a point: the range was one then

    assert np.all(learner.rules().weight > 0.0)
    assert np.all(np.isfinite(learner.rules().weight))


def test_asking_between_an_action_and_its_reward_changes_nothing() -> None:
    x, rewards, _ = checkerboard(3).drawn(300, np.random.default_rng(1))
    asked, alone = ALCSR(2, 2, seed=3), ALCSR(2, 2, seed=3)
    for one, given in zip(x, rewards, strict=True):
        for learner in (asked, alone):
            action = learner.act(one)
            if learner is asked:
                asked.decide(x[:5])
            learner.learn(given[action])

    for ours, theirs in zip(asked.population.rules, alone.population.rules, strict=True):
        assert np.array_equal(ours, theirs)


def test_many_cycles_are_refused_while_a_reward_is_owed() -> None:
    learner = ALCSR(2, 2)
    learner.act([0.1, 0.2])
    with pytest.raises(LearnerError, match="waits for its reward"):
        learner.run([[0.1, 0.2]], [[1.0, -1.0]])
    with pytest.raises(LearnerError, match="waits for its reward"):
        learner.teach([[0.1, 0.2]], [[1.0, -1.0]])


def test_a_range_that_is_declared_has_to_be_given_and_stays() -> None:
    declared = Config(readings=Readings(range_is=RangeIs.DECLARED))
    with pytest.raises(LearnerError, match="give low= and high="):
        ALCSR(2, 2, declared)
    with pytest.raises(LearnerError, match="low must lie below high"):
        ALCSR(2, 2, low=[0.0, 1.0], high=1.0)

    learner = ALCSR(2, 2, declared, low=0.0, high=1.0)
    x, rewards, _ = checkerboard(2).drawn(3_000, np.random.default_rng(1))
    learner.run(x, rewards)

    assert learner.rules().high.tolist() == [1.0, 1.0]
    fresh, _, right = checkerboard(2).drawn(3_000, np.random.default_rng(2))
    assert np.mean(learner.decide(fresh)[0] == right) > 0.8


def test_constants_that_can_be_none_are_refused() -> None:
    with pytest.raises(LearnerError, match="explore is from 0 to 1"):
        Config(explore=2.0)
    with pytest.raises(LearnerError, match="sprout_width is a number of 0 or more"):
        Config(sprout_width=-1.0)
    with pytest.raises(LearnerError, match="actions is a whole number of 1 or more, and 0 is none"):
        ALCSR(0, 2)
