"""Principle 2a: simulated time proceeds independently of any behavior."""

from functools import cache

import numpy as np
import pytest

from runtime.arrays import Array
from runtime.run import run
from tests.principles.scenes import GO, PROBE, SPIN, WATCH, Started, halt, robot, scenario, way

SECONDS = 3.0
PUSHED = """
arena: {box: [4 m, 3 m]}
things: {crate: {shape: {box: [0.3, 0.2]}, at: [1.5, 2.2, 20 deg], mass: 0.5 kg}}
"""
MINDS = {
    "nothing to do": {"stand": "{behavior: halt.yaml, period: 1 s, sense: {ahead: ahead.range}, "
    "set: {near: 3 m}}"},
    "one that is quick": {"stand": halt(near="3 m", period="5 ms")},
    "many": {"stand": halt(near="3 m")}
    | {f"eye{n}": WATCH.format(10 * n + 10) for n in range(20)},
    "one that never acts": {"stand": halt(near="3 m")[:-1] + ", acts_when: ahead > 5 * near}"},
}  # fmt: skip


def world_beside(mind: str) -> Array:
    """(steps, 2, 3): the way of a crate and of who pushes it, while another has this in mind."""
    made = scenario(
        robot("[0.8 m, 2.2 m]", go=GO, spin=SPIN.replace("}}", "}, set: {rate: 0.1 rad/s}}")),
        robot("[1 m, 0.5 m]", **MINDS[mind]),
        world=PUSHED,
        duration=f"{SECONDS} s",
    )
    found = way(made)
    assert np.ptp(found[:, 2], axis=0).max() == 0.0  # it stands, whatever it thinks
    return found[:, :2]


@pytest.mark.parametrize("mind", list(MINDS)[1:])
def test_the_world_goes_on_in_the_same_way_whatever_a_behavior_does(mind: str) -> None:
    """2a: what others do takes place at the same times, to the last bit."""
    first, same = world_beside(next(iter(MINDS))), world_beside(mind)

    assert np.ptp(first[:, 0, 0]) > 0.1  # a crate was pushed meanwhile
    assert np.array_equal(first, same)


def test_the_clock_runs_where_nothing_is_due() -> None:
    """2a: a behavior that samples once a second does not hold time up until it does."""
    made = scenario(robot("[1 m, 0.5 m]", **MINDS["nothing to do"]), duration="2.5 s")
    times = list(Started(made).steps())

    assert times == [made.step * (k + 1) for k in range(500)]


@cache
def late_ticks() -> float:
    """Seconds by which any tick of 22 behaviors at 20 rates is off its multiple of the period."""
    made = run(
        scenario(robot("[1 m, 0.5 m]", **MINDS["many"], go=GO, body=PROBE,
                       channels="channels: {base.speed: {priority: [go, stand]}}\n"),
                 duration=f"{SECONDS} s")
    )  # fmt: skip
    worst = 0.0
    nodes = made.scenario.robots[0].architecture.nodes
    for node, track in zip(nodes, made.robots[0].nodes, strict=True):
        meant = node.period * np.arange(np.ceil(SECONDS / node.period - 1e-9))
        assert len(meant) == len(track.times)
        worst = max(worst, float(np.abs(track.times - meant).max()))
    return worst


def test_every_behavior_ticks_at_its_own_multiples_and_misses_none() -> None:
    """2a: nor does the one hold the other up."""
    assert late_ticks() < 1e-9
