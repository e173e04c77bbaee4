"""The learner's two-choice task in the world: to keep near a lamp, by reward alone.

The robot drives along a line that passes by a lamp, and sees whether that is ahead or behind. Its
reward is by how much it got brighter since its last decision. Nobody tells it what its two
behaviors do: which of them leads to the lamp depends on where that is.
"""

import dataclasses
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import final

import numpy as np
import pytest

from compiler.world.scenario import compile_scenario
from lcs.alcsr.config import GROWN
from lcs.alcsr.learner import ALCSR
from lcs.arbiter import LearningArbiter
from lcs.xcsr.learner import XCSR
from runtime.arbitration.protocol import Arbiter
from runtime.run import Run, run
from runtime.scenario import Scenario
from runtime.scheduler.environment import Delivery
from runtime.scheduler.nodes import Learner
from runtime.scheduler.observer import Silent
from tests.runtime.arbitration.test_from_file_to_run import BEHAVIOR, BODY
from tests.runtime.arbitration.test_learner import EpsilonGreedy

LAMP = 2.0
SENSE = "sense: {x: {from: truth.x, outside: clip}}"
FILES = {
    "puck": BODY.replace(
        "sensors: {",
        "sensors: {lamp: {senses: light, every: 50 ms}, "
        "ahead: {senses: sight, of: [bulb], reach: 5 m, every: 50 ms}, ",
    ),
    "forth": BEHAVIOR.replace("NAME", "forth").replace("PACE", "0.3"),
    "back": BEHAVIOR.replace("NAME", "back").replace("PACE", "-0.3"),
    "learn": """
specc: 1
kind: arbiter
name: learn
reads: {bearing: {unit: rad, domain: [-pi, pi], kind: periodic}}
output: {behind: {unit: "1", is: cos(bearing) < 0}}
choices: [forth, back]
by: {module: "nothing:here"}
""",
    "robot": f"""
specc: 1
kind: architecture
name: robot
body: puck.yaml
nodes:
  forth: {{behavior: forth.yaml, period: 50 ms, {SENSE}}}
  back: {{behavior: back.yaml, period: 50 ms, {SENSE}}}
  learn:
    arbiter: learn.yaml
    period: 500 ms
    sense: {{bearing: ahead.bearing}}
    choices: {{forth: [forth], back: [back]}}
channels: {{base.forward: {{priority: [forth, back]}}}}
""",
    "room": f"""
specc: 1
kind: world
name: room
arena: {{box: [4 m, 3 m]}}
lights: {{bulb: {{at: [{LAMP}, 2], power: 10 cd}}}}
""",
    "task": """
specc: 1
kind: scenario
name: task
world: room.yaml
robots: {r: {architecture: robot.yaml, at: [1, 1.5]}}
duration: 100 s
""",
}


@final
class Brightness(Silent):
    """By how much it got brighter since it was last asked."""

    def __init__(self) -> None:
        self.now = self.before = 0.0

    def sensed(self, instant: int, delivery: Delivery) -> None:  # noqa: ARG002  # the newest counts
        if delivery.sensor == 0:
            self.now = float(delivery.readings[0])

    def reward(self) -> float:
        gained, self.before = self.now - self.before, self.now
        return gained


@final
class BySide(EpsilonGreedy):
    """A table whose situations are: the lamp is ahead, or behind."""

    def decide(self, reads, time):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
        return super().decide(np.array([float(np.cos(reads[0]) < 0.0)]), time)


@cache
def task() -> Scenario:
    with TemporaryDirectory() as folder:
        for name, text in FILES.items():
            (Path(folder) / f"{name}.yaml").write_text(text.lstrip(), encoding="utf-8")
        return compile_scenario(Path(folder) / "task.yaml", lambda _what, _done, _of: None).scenario


def lived(seed: int, epsilon: float) -> tuple[BySide, Run]:
    """What it learned in 200 decisions, and the run."""
    brightness, table = Brightness(), BySide(2, 2, epsilon, rate=0.2)
    learners = {"r.learn": Learner(table, brightness.reward)}
    scenario = dataclasses.replace(task(), seed=seed)
    return table, run(scenario, learners=learners, observer=brightness)


@pytest.mark.parametrize("seed", range(3))
def test_it_learns_to_stay_at_the_lamp(seed: int) -> None:
    table, made = lived(seed, epsilon=0.1)

    x = made.signals["r.x"].values
    away = np.abs(x[len(x) // 2 :] - LAMP)
    assert np.argmax(table.values, axis=1).tolist() == [0, 1]
    assert np.mean(away) < 0.15  # one decision takes it 15 cm on
    assert np.quantile(away, 0.95) < 0.45  # two explorations in a row, sometimes
    choices = made.signals["r.learn.choice"].values
    behind = made.signals["r.learn.behind"].values
    assert np.mean(choices[100:] == behind[100:]) > 0.8


def test_alcsr_learns_which_behavior_leads_to_the_lamp() -> None:
    learner = ALCSR(2, 1, dataclasses.replace(GROWN, explore=0.8), low=-4.0, high=4.0, seed=1)
    brightness = Brightness()
    arbiter: Arbiter = LearningArbiter(learner, 2)
    rewarded = Learner(arbiter, lambda: 1000.0 * (brightness.reward() > 0.0))

    for seed in range(3):
        scenario = dataclasses.replace(task(), seed=seed)
        run(scenario, learners={"r.learn": rewarded}, observer=brightness)

    bearings = [[0.5], [1.2], [2.0], [2.6]]  # the lamp hangs half a metre to the left of its way
    assert learner.decide(bearings)[0].tolist() == [0, 0, 1, 1]


def test_xcsr_stands_in_the_same_place() -> None:
    learner = XCSR(2, 1, low=-4.0, high=4.0, seed=1)
    arbiter: Arbiter = LearningArbiter(learner, 2)
    scenario = dataclasses.replace(task(), duration=10.0)

    for _ in range(2):  # the second run begins while the last reward of the first is owed
        made = run(scenario, learners={"r.learn": Learner(arbiter, lambda: 1000.0)})

    assert set(made.signals["r.learn.choice"].values.tolist()) <= {-1.0, 0.0, 1.0}
    assert len(learner.rules()) > 0


def test_by_chance_alone_it_strays() -> None:
    _, made = lived(1, epsilon=1.0)

    x = made.signals["r.x"].values
    assert np.mean(np.abs(x[len(x) // 2 :] - LAMP)) > 0.3
