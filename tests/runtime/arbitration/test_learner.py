"""A learner that fits the protocol by its shape: epsilon-greedy over a table (thesis, chapter 4).

Two lamps stand left and right of a point; which one feeds it is told by a color that it sees. It
has two behaviors, to go left and to go right, and learns from reward alone which one to let act.
"""

from dataclasses import replace
from typing import final

import numpy as np
import pytest

from runtime.arbiter import Paradigm
from runtime.architecture import Way
from runtime.arrays import Array
from runtime.scheduler.nodes import Learner
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.arbitration.test_paradigms import arbiter
from tests.runtime.scheduler.plane import (
    STEP,
    Noted,
    Plain,
    Plane,
    architecture,
    resolution,
    scenario,
)
from tests.runtime.scheduler.test_acting import chooser, seek

TRIAL = 20
"""Steps of one trial: the learner decides at its beginning."""


@final
class EpsilonGreedy:
    """Values of choices in each situation, learned as running means; now and then it explores."""

    def __init__(self, situations: int, choices: int, epsilon: float, rate: float) -> None:
        self.values = np.zeros((situations, choices))
        self._epsilon, self._rate = epsilon, rate
        self.reset(0)

    def reset(self, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        self._last: tuple[int, int] | None = None

    def decide(self, reads: Array, time: float) -> Array:  # noqa: ARG002  # a table has no clock
        situation = int(reads[0])
        explores = self._rng.random() < self._epsilon
        choices = self.values.shape[1]
        best = int(np.argmax(self.values[situation]))
        choice = int(self._rng.integers(choices)) if explores else best
        self._last = (situation, choice)
        return np.eye(choices)[choice]

    def learn(self, reward: float) -> None:
        assert self._last is not None, "there was a decision before"
        self.values[self._last] += self._rate * (reward - self.values[self._last])


class Lamps(Plane):
    """The color changes by chance between trials; the point starts each in the middle."""

    def __init__(self, seed: int) -> None:
        super().__init__(outside=lambda *_: (self.color, 0.0))
        self._rng = np.random.default_rng(seed)
        self.color = 0.0
        self.rewards: list[float] = []

    def advance(self) -> None:
        super().advance()
        if self.steps % TRIAL == 0:
            side = 1.0 if self.color == 1.0 else -1.0
            self.rewards.append(float(np.sign(self.at[0, 0]) * side))
            self.at[0] = 0.0
            self.color = float(self._rng.integers(2))


def trials(learner: EpsilonGreedy, count: int, seed: int) -> list[float]:
    """The rewards of so many trials."""
    lamps = Lamps(seed)
    decides = replace(arbiter(["left", "right"], Paradigm.WEIGHTS), weights=())
    nodes = [
        replace(
            chooser("choose", decides, {"left": ["go_left"], "right": ["go_right"]}),
            period=TRIAL * STEP,
        ),
        seek("go_left", -1.0),
        seek("go_right", 1.0),
    ]
    wired = architecture(nodes, ways={"x": resolution(Way.EXCLUSIVE, 1, 2, arbiter=0)})
    noted = Noted()
    scheduler = Scheduler(
        scenario(wired, seed=seed),
        lamps,
        Plain(lamps),
        observer=noted,
        learners={"r.choose": Learner(learner, lambda: lamps.rewards[-1])},
    )
    scheduler.run(count * TRIAL)
    assert not noted.events
    return lamps.rewards


@pytest.mark.parametrize("seed", range(3))
def test_a_learner_learns_a_two_choice_task_through_the_protocol(seed: int) -> None:
    learner = EpsilonGreedy(2, 2, epsilon=0.1, rate=0.2)

    rewards = trials(learner, 200, seed)

    assert np.mean(rewards[100:]) > 0.75  # it explores in every tenth trial: 0.9 at best
    assert np.argmax(learner.values, axis=1).tolist() == [0, 1]


def test_without_learning_it_is_right_half_of_the_time() -> None:
    rewards = trials(EpsilonGreedy(2, 2, epsilon=1.0, rate=0.2), 200, 0)

    assert abs(np.mean(rewards)) < 4.0 / np.sqrt(200)
