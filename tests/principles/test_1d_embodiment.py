"""Principle 1d: an agent has a body: it acts on the world, and the world on it, and it feels it."""

from functools import cache

import numpy as np

from runtime.run import Run, run
from tests.principles.scenes import GO, SPIN, halt, robot, scenario

EVERY = 0.01
"""Seconds between two samples of each sensor."""


def crate(mass: str) -> str:
    return (
        "arena: {box: [4 m, 3 m]}\nthings: {crate: {shape: {box: [0.3, 0.2]}, at: [2, 1.5], "
        f"mass: {mass}, floor: 0.5}}}}"
    )


@cache
def pushed(mass: str) -> Run:
    """A robot of 3 kg drives at 0.4 m/s against a crate, for 4 s."""
    return run(scenario(robot("[1.4 m, 1.5 m]", go=GO), world=crate(mass), duration="4 s"))


def way_of(made: Run, name: str) -> float:
    x = made.signals[f"{name}.x"].values
    return float(x[-1] - x[0])


def test_what_is_too_heavy_holds_the_robot_back_and_what_is_light_goes_along() -> None:
    """1d: how far it gets follows from masses and the floor, not from what it was told to do."""
    free = run(scenario(robot("[1.4 m, 1.5 m]", go=GO), duration="4 s"))

    assert way_of(free, "r0") > 1.5
    assert way_of(pushed("0.5 kg"), "r0") > 1.5
    assert way_of(pushed("0.5 kg"), "crate") > 1.0
    assert way_of(pushed("40 kg"), "r0") < 0.35
    assert abs(way_of(pushed("40 kg"), "crate")) < 1e-3


@cache
def felt_after() -> float:
    """Seconds from the first contact to the first time at which the bumper says so."""
    made = pushed("40 kg")
    touched, hit = made.signals["r0.contacts"], made.signals["r0.bumper.hit"]
    first = touched.times[np.flatnonzero(touched.values)[0]]
    return float(hit.times[np.flatnonzero(hit.values)[0]] - first)


def test_what_it_runs_into_is_felt_at_the_next_sample() -> None:
    """1d: its actions have immediate feedback on its own sensations (Brooks)."""
    assert 0.0 <= felt_after() <= EVERY + 1e-9


def test_one_that_does_nothing_is_moved_by_another_and_senses_it() -> None:
    """1d: the body is a part of the world, whatever its behaviors do."""
    made = run(
        scenario(
            robot("[1 m, 1.5 m]", go=GO),
            robot("[2 m, 1.5 m]", stand=halt(near="3 m")),
            duration="4 s",
        )
    )
    told = made.signals["r1.ahead.range"].values

    assert way_of(made, "r1") > 0.1
    assert told[-1] < told[0] - 0.1
    assert made.signals["r1.bumper.hit"].values.max() == 1.0


def test_a_turn_comes_back_as_what_is_seen_at_the_next_sample() -> None:
    """1d: 0.5 rad/s, once it turns, are 5 mrad less of bearing every 10 ms."""
    made = run(
        scenario(
            robot("[1 m, 1.5 m]", spin=SPIN),
            world="arena: {box: [4 m, 3 m]}\nlights: {b: {at: [3 m, 2.5 m], power: 10 cd}}",
            duration="1 s",
        )
    )
    bearing = made.signals["r0.beacon.bearing"].values

    assert np.allclose(np.diff(bearing)[10:], -0.5 * EVERY, atol=1e-9)
