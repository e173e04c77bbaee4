"""The compiled XCSR gives the same bits as the definition that is read."""

from dataclasses import fields

import numpy as np
import pytest

from lcs.arrays import Array
from lcs.xcsr import definition
from lcs.xcsr.conditions import Space
from lcs.xcsr.config import Bounds, Config, Selection
from lcs.xcsr.definition import Classifier, World
from lcs.xcsr.kernels.layout import BIRTHS, COPIES, DEATHS, LINES
from lcs.xcsr.learner import XCSR

INPUTS, ACTIONS, CYCLES = 3, 3, 700
LOW, HIGH = np.array([-1.0, 0.0, 10.0]), np.array([1.0, 5.0, 10.5])


def problem(seed: int) -> tuple[Array, Array]:
    """Inputs, some at the ends of the range, and the reward of each action."""
    chance = np.random.default_rng(seed)
    x = np.clip(chance.normal(0.5, 0.4, (CYCLES, INPUTS)), 0.0, 1.0)
    label = (x[:, 0] < 0.3) + (x[:, 1] > 0.4).astype(int)
    return LOW + x * (HIGH - LOW), np.where(np.arange(ACTIONS) == label[:, None], 1000.0, -1000.0)


def drawn(seed: int) -> Config:
    """A config at random, whose population is full soon."""
    chance = np.random.default_rng(seed)
    return Config(
        N=int(chance.integers(20, 90)),
        theta_GA=float(chance.integers(0, 20)),
        theta_mna=int(chance.integers(ACTIONS + 1)),
        theta_sub=int(chance.integers(1, 10)),
        theta_del=int(chance.integers(1, 20)),
        mu=float(chance.choice([0.0, 0.04, 0.3])),
        s_0=float(chance.choice([0.2, 1.0])),
        P_hash=float(chance.choice([0.0, 0.3])),
        epsilon_0=float(chance.choice([10.0, 300.0])),
        ga_subsumption=bool(chance.integers(2)),
        action_set_subsumption=bool(chance.integers(2)),
        selection=Selection(int(chance.integers(2))),
        bounds=Bounds(seed % 3),
        explore=0.8,
    )


def same(learner: XCSR, world: World) -> None:
    them = learner.population.classifiers
    count = len(world.population)
    assert them.counts[[LINES, BIRTHS, DEATHS]].tolist() == [count, world.births, world.deaths]
    assert them.counts[COPIES] == sum(c.numerosity for c in world.population)
    for name in (each.name for each in fields(Classifier) if each.name != "condition"):
        assert getattr(them, name)[:count].tolist() == [getattr(c, name) for c in world.population]
    assert them.first[:, :count].T.tolist() == [c.condition.first for c in world.population]
    assert them.second[:, :count].T.tolist() == [c.condition.second for c in world.population]


@pytest.mark.parametrize("seed", range(12))
def test_kernels_give_the_bits_of_the_definition(seed: int) -> None:
    inputs, rewards = problem(seed)
    learner = XCSR(ACTIONS, INPUTS, drawn(seed), low=LOW, high=HIGH, seed=7)
    world = World(Space(learner.config, LOW.tolist(), HIGH.tolist()), ACTIONS)
    rng = np.random.default_rng(7)

    course = learner.run(inputs, rewards)
    actions = [
        definition.cycle(world, x, reward.__getitem__, rng).action
        for x, reward in zip(inputs.tolist(), rewards.tolist(), strict=True)
    ]

    assert course.action.tolist() == actions
    same(learner, world)


@pytest.mark.parametrize("seed", range(6))
def test_several_steps_give_the_bits_of_the_definition(seed: int) -> None:
    inputs, rewards = problem(seed)
    learner = XCSR(ACTIONS, INPUTS, drawn(seed), low=LOW, high=HIGH, seed=7)
    world = World(Space(learner.config, LOW.tolist(), HIGH.tolist()), ACTIONS)
    rng = np.random.default_rng(7)

    for t in range(300):
        action = learner.act(inputs[t])
        is_last = t % 5 == 4
        learner.learn(rewards[t, action], None if is_last else inputs[t + 1])
        choice = definition.act(world, inputs[t].tolist(), rng)
        following = None if is_last else inputs[t + 1].tolist()
        if not choice.is_test:
            definition.learn(world, choice.action_set, rewards[t, action], following, rng)
        assert choice.action == action

    same(learner, world)
