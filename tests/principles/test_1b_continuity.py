"""Principle 1b: space is continuous, or as fine as one likes: no cells, no jumps."""

from functools import cache

import numpy as np
import pytest

from runtime.arrays import Array
from tests.principles.scenes import GO, PROBE, SPIN, Started, halt, robot, scenario, way

NANOMETRE = 1e-9
CURVE = robot("[2 m, 1.5 m]", go=GO, spin=SPIN)
SECONDS = 6.0


def place(x: float) -> Array:
    """What a robot at x senses, of a wall and of a lamp: metres, lux."""
    made = scenario(
        robot(f"[{x!r} m, 1.5 m]", halt=halt()),
        world="arena: {box: [4 m, 3 m]}\n"
        "lights: {b: {at: [3 m, 1.5 m], power: 10 cd, height: 30 cm}}",
    )
    world = Started(made).world
    return np.array([world.sample(0, 0)[0], world.sample(0, 3)[0]])


@cache
def smallest_told() -> float:
    """Metres: the smallest of three moves (1 mm, 1 um, 1 nm) that a range sensor tells to 1 %."""
    told = [
        move
        for move in (1e-3, 1e-6, NANOMETRE)
        if abs(place(2.0)[0] - place(2.0 + move)[0] - move) < 0.01 * move
    ]
    return min(told)


def test_a_move_of_a_nanometre_is_a_nanometre_to_a_range_sensor() -> None:
    """1b: places are numbers, not cells."""
    assert smallest_told() == NANOMETRE


def test_light_changes_with_every_micrometre() -> None:
    """1b: nor is the light that is sensed taken from a map of cells."""
    lux = [place(2.0 + k * 1e-6)[1] for k in range(6)]

    steps = np.diff(lux)
    assert (steps > 0.0).all()
    assert np.ptp(steps) < 1e-3 * steps.mean()


def true_end() -> Array:
    """Where the curve ends, integrated apart from the world: 2 m/s^2 and 20 rad/s^2 to full speed.

    For 0.4 m/s and 0.5 rad/s, by the midpoint rule in steps of 10 us.
    """
    times = (np.arange(round(SECONDS * 1e5)) + 0.5) * 1e-5
    heading = np.where(times < 0.025, 10.0 * times**2, 0.5 * times - 0.00625)
    speed = np.minimum(2.0 * times, 0.4)
    ways = np.array([speed * np.cos(heading), speed * np.sin(heading)]).sum(axis=1) * 1e-5
    found: Array = np.array([2.0, 1.5]) + ways
    return found


@cache
def errors_of_curve() -> tuple[float, ...]:
    """Metres by which a curve ends off, with steps of 5, 2.5 and 1.25 ms."""
    found = []
    for step in ("5 ms", "2.5 ms", "1.25 ms"):
        made = scenario(CURVE, world="arena: {box: [4 m, 4 m]}", duration=f"{SECONDS} s", step=step)
        found.append(float(np.hypot(*(way(made)[-1, 0, :2] - true_end()))))
    return tuple(found)


def test_a_step_half_as_long_comes_twice_as_near_to_the_true_curve() -> None:
    """1b: what steps make of a continuous motion is as fine as one asks for."""
    coarse, finer, finest = errors_of_curve()

    assert coarse < 2e-3  # of a way of 2.4 m
    assert 1.8 < coarse / finer < 2.2
    assert 1.8 < finer / finest < 2.2


@pytest.mark.parametrize("thin", ["1 mm", "0.1 mm"])
def test_nothing_drives_through_a_wall_however_thin_it_is(thin: str) -> None:
    """1b: no step is so long that what stands between two places is passed over."""
    fast = PROBE.replace("speed: 0.5 m/s", "speed: 2 m/s, acceleration: 20 m/s^2")
    made = scenario(
        robot("[0.5 m, 1.5 m]", body=fast, go=GO[:-1] + ", set: {speed: 2 m/s}}"),
        world=f"arena: {{box: [4 m, 3 m]}}\nthings: {{w: {{shape: {{box: [{thin}, 1 m]}}, "
        "at: [2.0043 m, 1.5 m], fixed: true}}",
        duration="2 s",
        step="5 ms",
    )

    x = way(made)[:, 1, 0]
    assert x.max() < 2.0043 - 0.12 + 2e-3
    assert x.max() > 2.0043 - 0.12 - 2e-3
