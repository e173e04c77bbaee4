"""A learner for several steps that was saved goes on bit for bit; what is damaged is refused."""

import copy
import dataclasses
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcs.faults import LearnerError
from lcs.problems.steps import gridworld, puddle_world
from lcs.saving import as_bytes, from_bytes, load, save
from lcs.state import State
from lcs.steps.config import Config
from lcs.steps.learner import StepsLearner

SMALL = Config(memories=900, families=2, generations=2, first=200, longest=60)


def learner(seed: int = 3) -> StepsLearner:
    return StepsLearner(4, 2, SMALL, seed=seed)


def bits(one: StepsLearner) -> bytes:
    """The file of a learner."""
    return as_bytes(one.state())


def through_a_file(one: StepsLearner, folder: Path) -> StepsLearner:
    save(one, folder / "learner")
    found = load(folder / "learner")
    assert isinstance(found, StepsLearner)
    return found


COPIES: dict[str, Callable[[StepsLearner, Path], StepsLearner]] = {
    "saved": through_a_file,
    "copied": lambda one, _: copy.deepcopy(one),
    "pickled": lambda one, _: pickle.loads(pickle.dumps(one)),  # noqa: S301  our own
}


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("stopped_at", ["act", "learn"])
def test_a_copy_goes_on_as_if_nothing_had_been_stopped(
    how: str, stopped_at: str, tmp_path: Path
) -> None:
    world, outside = puddle_world(), np.random.default_rng(1)
    stops = {5, 333, 600, 601, 1_100}
    going, stopped = learner(), learner()
    x = world.reset(outside)
    for t in range(1_200):
        if t in stops and stopped_at == "act":
            stopped = COPIES[how](stopped, tmp_path)
        action = going.act(x)
        assert stopped.act(x) == action
        if t in stops and stopped_at == "learn":
            stopped = COPIES[how](stopped, tmp_path)
        after, reward, done = world.step(x, action, outside)
        for each in (going, stopped):
            each.learn(reward, after, done)
            if t % 60 == 59:
                each.end_episode()
        x = world.reset(outside) if done or t % 60 == 59 else after

    assert len(going.bodies.lower) > 10
    assert bits(going) == bits(stopped)


@settings(max_examples=10, deadline=None)
@given(st.lists(st.integers(1, 12), min_size=1, max_size=5), st.integers(0, 9))
def test_what_is_loaded_decides_and_learns_the_same(counts: list[int], seed: int) -> None:
    world, whole, parts = gridworld(), learner(seed), learner(seed)
    places = np.random.default_rng(seed).random((50, 2))
    outside = [np.random.default_rng(seed) for _ in range(2)]
    for count in counts:
        whole.run(world, count, outside[0])
        parts = StepsLearner.from_state(from_bytes(bits(parts)))
        parts.run(world, count, outside[1])

    for ours, theirs in zip(whole.decide(places), parts.decide(places), strict=True):
        assert np.array_equal(ours, theirs)
    assert bits(whole) == bits(parts)


def test_a_copy_and_its_original_share_nothing(tmp_path: Path) -> None:
    one = learner()
    one.run(gridworld(), 20, np.random.default_rng(0))
    before = bits(one)

    for make in COPIES.values():
        make(one, tmp_path).run(gridworld(), 20, np.random.default_rng(1))

    assert bits(one) == before


def damaged(state: State, name: str, value: Any) -> State:
    return dataclasses.replace(state, arrays={**state.arrays, name: np.array(value)})


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("land.action", np.full(900, 4), "an action that there is not"),
        ("land.seen", [-1], "an action that there is not"),
        ("land.reward", np.full(900, np.nan), "not finite"),
        ("land.x", np.zeros((901, 2)), "does not fit|not the room"),
        ("bodies.first", [0, 7], "where families begin"),
        ("bodies.first", [0, 1, 1], "where families begin"),
        ("bodies.lower", np.zeros((2, 2)), "does not fit"),
        ("bodies.meals", np.zeros((2, 4), np.int64), "does not fit|have an array"),
        ("bodies.meals", np.zeros((1, 4)), "is float64"),
    ],
)
def test_what_no_learner_is_is_refused(name: str, value: Any, said: str) -> None:
    with pytest.raises(LearnerError, match=said):
        StepsLearner.from_state(damaged(learner().state(), name, value))


def test_what_is_missing_or_out_of_turn_is_refused() -> None:
    state = learner().state()
    without = {name: each for name, each in state.arrays.items() if name != "land.ends"}
    with pytest.raises(LearnerError, match=r"'land.ends' is missing"):
        StepsLearner.from_state(dataclasses.replace(state, arrays=without))
    with pytest.raises(LearnerError, match="'waits_at' is missing"):
        StepsLearner.from_state(dataclasses.replace(state, plain={**state.plain, "said": 2}))
    with pytest.raises(LearnerError, match="no such action"):
        StepsLearner.from_state(dataclasses.replace(state, plain={**state.plain, "said": 9}))


@pytest.mark.parametrize(
    ("config", "said"),
    [
        (Config(explore=1.5), "explore is from 0 to 1; got 1.5"),
        (Config(discount=float("nan")), "discount is from 0 to 1; got nan"),
        (Config(memories=0), "memories is 1 or more; got 0"),
    ],
)
def test_constants_that_mean_nothing_are_refused(config: Config, said: str) -> None:
    with pytest.raises(LearnerError, match=said):
        StepsLearner(4, 2, config)
