"""Principle 2g: response times and the time to move a share of its length stay in proportion."""

from functools import cache

import pytest

from spec_schema.diagnostics import SpecError
from tests.principles.loads import Burning
from tests.principles.scenes import PROBE, WATCH, Started, halt, robot, scenario

LENGTH = 0.24
"""Metres: of the robot."""
SPEED, RESPONSE = 0.4, 0.3
"""m/s, and seconds: it moves by half of its length before it answers."""


@cache
def stop(response: float, *, scale: float = 1.0, most: float = 0.0) -> float:
    """Where a robot stops, in lengths of its own, when told to keep five lengths from a wall.

    scale: of the robot, its ways and its speed. most: seconds of real time that a tick may take.
    """
    body = PROBE.replace("12 cm", f"{12 * scale} cm").replace("20 cm", f"{20 * scale} cm")
    body = body.replace(
        "speed: 0.5 m/s", f"speed: {0.5 * scale} m/s, acceleration: {2 * scale} m/s^2"
    ).replace("reach: 3 m", "reach: 6 m")
    node = halt(f"{response} s", near=f"{1.2 * scale} m", pace=f"{SPEED * scale} m/s")
    made = scenario(
        robot(f"[{0.3 * scale} m, 1.5 m]", body=body, halt=node),
        world=f"arena: {{box: [{2.4 * scale} m, 3 m]}}",
        duration="4 s",
    )
    started = Started(made, Burning(most, 3) if most else None)
    return float(started.finish()[0, 0]) / (LENGTH * scale)


def moved_before(response: float, *, scale: float = 1.0, most: float = 0.0) -> float:
    """Lengths of its own by which a robot moves on because it answers so late."""
    return stop(response, scale=scale, most=most) - stop(0.0, scale=scale, most=most)


@pytest.mark.parametrize("response", [0.05, 0.1, RESPONSE])
def test_before_it_answers_a_robot_moves_by_as_many_lengths_as_its_speed_and_response_say(
    response: float,
) -> None:
    """2g: 0.4 m/s and 0.3 s are half a length of 24 cm, in simulated time as in the real world."""
    assert moved_before(response) == pytest.approx(SPEED * response / LENGTH, abs=1e-9)


def test_a_robot_twice_as_long_and_twice_as_fast_moves_by_as_many_lengths() -> None:
    """2g: only the proportion counts."""
    assert moved_before(RESPONSE, scale=2.0) == pytest.approx(moved_before(RESPONSE), abs=1e-9)


def test_a_computer_that_is_held_up_does_not_change_the_proportion() -> None:
    """2g: bit for bit, where each tick takes up to a millisecond of real time."""
    assert stop(RESPONSE, most=1e-3) == stop(RESPONSE)


def test_a_behavior_that_answers_too_late_for_what_it_is_to_do_is_refused() -> None:
    """2g: its field changes within 2 s, and it would answer up to 1.5 s late."""
    with pytest.raises(SpecError, match="S353"):
        scenario(robot("[1 m, 1.5 m]", halt=halt(), eye=WATCH.format(1500)))
