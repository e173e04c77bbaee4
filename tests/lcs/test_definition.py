"""The compiled core gives the same bits as the definition that is read, in every reading."""

from dataclasses import fields

import numpy as np
import pytest

from lcs.alcsr.config import Config, Readings
from lcs.alcsr.definition.cycle import cycle as cycle_as_defined
from lcs.alcsr.definition.organisms import Landscape, World
from lcs.alcsr.kernels import cycle
from lcs.alcsr.population import Population, empty
from lcs.arrays import Array, Integers

INPUTS, CYCLES = 3, 1_200


def problem(seed: int) -> tuple[Array, Array]:
    """Inputs, and the reward of both actions: a corner that is another class."""
    rng = np.random.default_rng(seed)
    inputs = rng.random((CYCLES, INPUTS))
    label = (inputs[:, 0] < 0.3) & (inputs[:, 1] > 0.4)
    rewards = np.where(np.arange(2) == label[:, None], 1000.0, -1000.0)
    return inputs, rewards


def compiled(config: Config, inputs: Array, rewards: Array) -> tuple[Population, Integers]:
    """What the kernels make of it; room is made whenever it is short."""
    population = empty(2, INPUTS, config, 2000.0)
    rng = np.random.default_rng(7)
    told, errors = np.zeros((CYCLES, 5), np.int64), np.zeros(CYCLES)
    done = 0
    while done < CYCLES:
        done = cycle.run(
            population.rules,
            population.corpses,
            population.land,
            population.numbers,
            population.scratch,
            inputs,
            rewards,
            done,
            cycle.CYCLES,
            told,
            errors,
            rng,
        )
        if done < CYCLES:
            population.make_room()
    return population, told


def defined(config: Config, inputs: Array, rewards: Array) -> tuple[World, list[int], list[int]]:
    """What the definition makes of it: the world, each action, how many live after each cycle."""
    nowhere = [np.inf] * INPUTS, [-np.inf] * INPUTS
    world = World(config, [Landscape(), Landscape()], *nowhere, 2000.0)
    rng = np.random.default_rng(7)
    actions, living = [], []
    for x, reward in zip(inputs.tolist(), rewards.tolist(), strict=True):
        actions.append(cycle_as_defined(world, x, reward.__getitem__, rng).action)
        living.append(sum(len(land.organisms) for land in world.landscapes))
    return world, actions, living


def drawn(seed: int) -> Readings:
    """The default readings, or others at random."""
    if seed == 0:
        return Readings()
    chance = np.random.default_rng(seed)
    kinds = {each.name: type(getattr(Readings(), each.name)) for each in fields(Readings)}
    return Readings(**{name: kind(int(chance.integers(len(kind)))) for name, kind in kinds.items()})


@pytest.mark.parametrize("seed", range(12))
def test_kernels_give_the_bits_of_the_definition(seed: int) -> None:
    config = Config(explore=0.8, readings=drawn(seed), corpses=5)
    inputs, rewards = problem(seed)

    population, told = compiled(config, inputs, rewards)
    world, actions, living = defined(config, inputs, rewards)

    assert told[:, 1].tolist() == actions
    assert told[:, 2].tolist() == living
    rules, corpses = population.rules, population.corpses
    for a, land in enumerate(world.landscapes):
        count = len(land.organisms)
        assert rules.living[a] == count
        for name in ("lower", "upper", "prediction", "strength", "experience", "volume", "damaged"):
            expected = [getattr(each, name) for each in land.organisms]
            assert getattr(rules, name)[a, :count].tolist() == expected
        assert corpses.buried[a] == len(land.mausoleum)
        buried = corpses.upper[a, : corpses.buried[a]].tolist()
        assert buried == [each.upper_fraction for each in land.mausoleum]
