"""Principle 2c: relations in simulated time do not depend on how long processing takes."""

from functools import cache

import numpy as np

from runtime.run import Run, run
from tests.principles.loads import Burning
from tests.principles.scenes import SPIN, WATCH, halt, robot, scenario

LATENCY, RESPONSE = 0.03, 0.07
"""Seconds: from a sample to the board; from a tick to the channel."""


def made(burning: Burning | None) -> Run:
    """A robot that stops before a wall while it turns."""
    late = "every: 10 ms, latency: 30 ms}"
    body = robot("[1.5 m, 1.5 m]", halt=halt("70 ms", near="2 m"), eye=WATCH.format(20), spin=SPIN)
    body["body"] = body["body"].replace("reach: 3 m, every: 10 ms}", f"reach: 3 m, {late}")
    return run(scenario(body, duration="1.5 s"), observer=burning)


@cache
def both() -> tuple[Run, Run, float]:
    """The same run undisturbed and held up; and for how long (s) it was."""
    burning = Burning(most=2e-3, seed=2)
    return made(None), made(burning), burning.burnt


def test_no_interval_changes_where_processing_takes_random_times() -> None:
    """2c: all that happened happened at the same times, and the same in all."""
    quiet, held_up, burnt = both()

    assert burnt > 0.1
    assert quiet.digest == held_up.digest
    for one, other in zip(quiet.robots[0].nodes, held_up.robots[0].nodes, strict=True):
        assert np.array_equal(one.times, other.times)
        assert np.array_equal(one.register, other.register)
    channels, same = quiet.robots[0].channels, held_up.robots[0].channels
    assert np.array_equal(channels.times, same.times)
    assert np.array_equal(quiet.world.poses, held_up.world.poses)


@cache
def chain() -> float:
    """Seconds from the sample that was too near to the channel that says stop."""
    _, held_up, _ = both()
    told, channels = held_up.signals["r0.ahead.range"], held_up.robots[0].channels
    near = told.times[np.flatnonzero(told.values <= 2.0)[0]] - LATENCY
    stopped = channels.times[np.flatnonzero(channels.set_points[:, 0] == 0.0)]
    return float(stopped[stopped > 0.5][0] - near)


def test_from_sample_to_channel_it_takes_what_latency_and_response_time_say() -> None:
    """2c: 30 ms and 70 ms are 100 ms, with a computer that is held up at every tick."""
    assert abs(chain() - (LATENCY + RESPONSE)) < 1e-9
