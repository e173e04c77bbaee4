"""The learner for several steps: what it reaches, and that it is the same however it is run."""

from dataclasses import dataclass

import numpy as np
import pytest

from lcs.arrays import Array
from lcs.faults import LearnerError
from lcs.problems.optimum import fewest_steps
from lcs.problems.steps import Plane, gridworld
from lcs.steps.config import Config
from lcs.steps.learner import StepsLearner
from lcs.steps.policy import GOOD, policy

SMALL = Config(memories=4_000, families=2, generations=3, first=500, longest=200)


@dataclass(frozen=True, slots=True)
class Corridor:
    """A world in one dimension with three actions: left, right by a little, right by more."""

    actions: int = 3
    inputs: int = 1

    def reset(self, chance: np.random.Generator) -> Array:
        return chance.random(1)

    def step(self, x: Array, action: int, chance: np.random.Generator) -> tuple[Array, float, bool]:
        after = np.clip(x + (-0.1, 0.02, 0.1)[action] + 0.005 * chance.normal(), 0.0, 1.0)
        done = bool(after[0] >= 1.0)
        return after, 10.0 if done else -1.0, done


@dataclass(frozen=True, slots=True)
class Stepwise:
    """A plane that doesn't say it is one: the learner has to ask it step by step."""

    plane: Plane
    actions: int = 4
    inputs: int = 2

    def reset(self, chance: np.random.Generator) -> Array:
        return self.plane.reset(chance)

    def step(self, x: Array, action: int, chance: np.random.Generator) -> tuple[Array, float, bool]:
        return self.plane.step(x, action, chance)


def learner(seed: int = 0, config: Config = SMALL) -> StepsLearner:
    return StepsLearner(4, 2, config, seed=seed)


def starts(count: int) -> Array:
    places = np.random.default_rng(4).random((2 * count, 2))
    return np.asarray(places[places.sum(axis=1) <= 1.9][:count])


@pytest.fixture(scope="module")
def experienced() -> StepsLearner:
    ours = learner(config=Config())
    ours.run(gridworld(), 300, np.random.default_rng(1))
    return ours


def test_after_300_episodes_it_reaches_the_goal_from_everywhere(experienced: StepsLearner) -> None:
    went = experienced.follow(gridworld(), starts(200), np.random.default_rng(2))

    assert went.reached.all()
    assert went.steps.mean() < 1.1 * fewest_steps(starts(200)).mean()


def test_its_policy_in_few_rules_is_to_go_right_or_up(experienced: StepsLearner) -> None:
    few = policy(experienced, starts(400), tolerance=0.3).table

    is_good = few.prediction == GOOD

    assert len(few) <= 16
    assert set(few.action[is_good]) == {0, 1}
    for a in (0, 1):  # the places where the action is no worse than any: all but a border
        of_it = is_good & (few.action == a)
        size = np.prod(few.upper[of_it] - few.lower[of_it], axis=1)
        assert size.max() > 0.6


def test_step_by_step_is_the_same_as_compiled() -> None:
    compiled, stepwise = learner(), learner()

    one = compiled.run(gridworld(), 40, np.random.default_rng(1))
    other = stepwise.run(Stepwise(gridworld()), 40, np.random.default_rng(1))

    assert len(compiled.bodies.lower) > 10
    for ours, theirs in zip(
        (*compiled.land, *compiled.bodies), (*stepwise.land, *stepwise.bodies), strict=True
    ):
        assert np.array_equal(ours, theirs)
    assert np.array_equal(one.steps, other.steps)
    assert np.array_equal(one.bodies, other.bodies)


def test_two_learners_in_one_process_do_not_disturb_each_other() -> None:
    alone, one, other = learner(5), learner(5), learner(6)
    alone.run(gridworld(), 60, np.random.default_rng(1))
    outside = np.random.default_rng(1)
    for _ in range(6):
        one.run(gridworld(), 10, outside)
        other.run(gridworld(), 10, np.random.default_rng(2))

    for ours, theirs in zip(alone.bodies, one.bodies, strict=True):
        assert np.array_equal(ours, theirs)
    assert not np.array_equal(one.land.x, other.land.x)


def test_each_family_covers_everything_once() -> None:
    ours = learner()
    ours.run(gridworld(), 60, np.random.default_rng(1))
    places = np.random.default_rng(2).normal(size=(500, 1, 2))

    is_in = np.all((places >= ours.bodies.lower) & (places < ours.bodies.upper), axis=2)

    of_families = np.add.reduceat(is_in, ours.bodies.first[:-1], axis=1)
    assert of_families.shape == (500, 2)
    assert (of_families == 1).all()


def test_a_body_expects_the_mean_of_what_its_memories_led_to() -> None:
    ours = learner()
    ours.run(gridworld(), 60, np.random.default_rng(1))
    ours.grow()
    land, bodies = ours.land, ours.bodies
    kept = min(int(land.seen[0]), len(land.action))
    _, worth = ours.decide(land.after[:kept])
    led_to = land.reward[:kept] + 0.99 * np.where(land.ends[:kept], 0.0, worth.max(axis=1))

    for b in range(len(bodies.lower)):
        x = land.x[:kept]
        is_in = ((x >= bodies.lower[b]) & (x < bodies.upper[b])).all(axis=1)
        for a in range(4):
            own = led_to[is_in & (land.action[:kept] == a)]
            assert len(own) == bodies.meals[b, a]
            assert bodies.expected[b, a] == pytest.approx(
                own.mean(), abs=1e-3
            )  # settled to 1e-6 of the range


def test_the_rules_say_what_the_learner_decides() -> None:
    ours = learner()
    ours.run(gridworld(), 60, np.random.default_rng(1))
    table, x = ours.rules(), starts(300)

    holds = np.all((x[:, None] >= table.lower) & (x[:, None] < table.upper), axis=2)
    votes = holds[:, None] & (table.action == np.arange(4)[:, None])
    expected = (votes * table.prediction).sum(axis=2) / votes.sum(axis=2)

    assert np.allclose(expected, ours.decide(x)[1])


def test_other_worlds_have_other_numbers_of_actions_and_inputs() -> None:
    ours = StepsLearner(3, 1, SMALL, seed=1)
    ours.run(Corridor(), 120, np.random.default_rng(1))

    actions, _ = ours.decide(np.linspace(0.0, 0.95, 20)[:, None])

    assert (actions == 2).mean() > 0.9


def test_what_is_out_of_turn_or_no_number_is_refused() -> None:
    ours = learner()
    with pytest.raises(LearnerError, match="no action waits"):
        ours.learn(1.0, [0.0, 0.0], done=False)
    with pytest.raises(LearnerError, match="input 0 is not finite"):
        ours.act([0.5, np.nan])
    ours.act([0.5, 0.5])
    with pytest.raises(LearnerError, match="waits for what it led to"):
        ours.act([0.5, 0.5])
    with pytest.raises(LearnerError, match="a reward is a finite number"):
        ours.learn(np.inf, [0.0, 0.0], done=False)
    with pytest.raises(LearnerError, match="the world has 3 actions and 1 inputs"):
        ours.run(Corridor(), 1, np.random.default_rng(0))
