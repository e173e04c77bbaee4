"""Principle 2f: how late a behavior answers has nothing to do with how long it is computed."""

from functools import cache

import numpy as np
import pytest

from runtime.arrays import Array
from tests.principles.loads import Burning
from tests.principles.scenes import Started, halt, hashes, robot, scenario

SPEED, NEAR, GRIP = 0.4, 2.0, 2.0
RESPONSES = (0, 50, 100, 200, 400)
"""Milliseconds: multiples of the period of 10 ms, so that all are sampled at the same places."""


@cache
def overruns() -> Array:
    """Metres that a robot goes on behind the place where it was to stop, for each response time."""
    found = []
    for late in RESPONSES:
        node = halt(f"{late} ms", near=f"{NEAR} m", pace=f"{SPEED} m/s")
        made = scenario(robot("[1.5 m, 1.5 m]", halt=node), duration="3 s")
        found.append(float(Started(made).finish()[0, 0]) - (4.0 - NEAR - 0.12))
    return np.array(found)


@cache
def seconds_per_second() -> float:
    """By how much more it overruns for each second of response time, at 1 m/s."""
    return float(np.polyfit(np.array(RESPONSES) / 1e3, overruns(), 1)[0]) / SPEED


def test_a_robot_overruns_by_its_speed_times_its_response_time() -> None:
    """2f: v T + v^2 / 2a and at most one period: the same code, told to be slow, is slow."""
    braking = SPEED**2 / (2.0 * GRIP)

    assert seconds_per_second() == pytest.approx(1.0, abs=1e-6)
    assert 0.0 <= overruns()[0] - braking <= SPEED * (0.01 + 0.005)


def test_a_behavior_over_which_the_computer_broods_answers_no_later() -> None:
    """2f: its processing takes up to 2 ms of real time at every tick, its response none."""
    node = halt("0 ms", near=f"{NEAR} m")
    made = scenario(robot("[1.5 m, 1.5 m]", halt=node), duration="1 s")
    burning = Burning(most=2e-3, seed=1)

    slow = hashes(Started(made, burning))

    assert burning.burnt > 0.05
    assert slow == hashes(Started(made))
