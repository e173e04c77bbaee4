"""Drives follow their commands exactly where they grip, and slip where they do not."""

import math

import numpy as np
import pytest

from runtime.world.model import DriveKind, Shape
from tests.runtime.world.worlds import body, box, drive, round_, simulated, world


@pytest.mark.parametrize("shape", [round_(0.12), box(0.3, 0.2)])
def test_two_wheels_drive_the_circle_of_their_speed_and_turn(shape: Shape) -> None:
    sim = simulated(world(), (body(shape=shape), (2.0, 1.0, 0.0)))
    drive(sim, 0.3, 0.6, seconds=1.0)
    x, y, heading = sim.poses()[0]
    middle = (x - 0.5 * math.sin(heading), y + 0.5 * math.cos(heading))

    for _ in range(20):
        drive(sim, 0.3, 0.6, seconds=0.5)
        assert math.dist(sim.poses()[0, :2], middle) == pytest.approx(0.5, abs=1e-4)

    assert sim.motion(0).forward == pytest.approx(0.3, abs=1e-4)
    assert sim.motion(0).left == pytest.approx(0.0, abs=1e-3)
    assert sim.motion(0).turn == pytest.approx(0.6, abs=1e-6)
    assert sim.poses()[0, 2] - heading == pytest.approx(6.0, abs=1e-4)


def test_an_axle_off_the_centre_of_mass_still_rolls_about_itself() -> None:
    (part,) = box(0.3, 0.2).polygons
    shape = Shape((), (type(part)(tuple((x + 0.1, y) for x, y in part.vertices)),))
    sim = simulated(world(), (body(shape=shape), (2.0, 1.5, 0.0)))

    drive(sim, 0.0, 1.0, seconds=4.0)

    assert sim.poses()[0, :2] == pytest.approx((2.0, 1.5), abs=5e-3)
    assert sim.motion(0).forward == pytest.approx(0.0, abs=2e-3)


def test_a_holonomic_body_goes_in_any_direction_while_it_turns() -> None:
    sim = simulated(world(), (body(DriveKind.HOLONOMIC), (2.0, 1.5, 0.0)))

    drive(sim, 0.2, -0.1, 0.5, seconds=1.0)

    motion = sim.motion(0)
    assert (motion.forward, motion.left) == pytest.approx((0.2, -0.1), abs=1e-3)
    assert motion.turn == pytest.approx(0.5, abs=1e-9)


def test_set_points_are_approached_no_faster_than_the_drive_can() -> None:
    sim = simulated(world(), (body(), (1.0, 1.5, 0.0)))

    drive(sim, 0.5, 3.0, seconds=0.1)

    assert sim.motion(0).forward == pytest.approx(2.0 * 0.1, abs=2e-3)
    assert sim.motion(0).turn == pytest.approx(20.0 * 0.1, abs=1e-6)
    drive(sim, 0.5, 3.0, seconds=0.2)
    assert sim.motion(0).turn == pytest.approx(3.0, abs=1e-6)


def test_wheels_that_grip_less_than_they_are_asked_for_slip() -> None:
    """On ice: 0.05 * g is less than the 2 m/s² that the motors give."""
    sim = simulated(world(), (body(traction=0.05), (1.0, 1.5, 0.0)))

    drive(sim, 0.5, 0.0, seconds=0.5)

    assert sim.commanded(0).forward == 0.5
    assert sim.motion(0).forward == pytest.approx(0.05 * 9.81 * 0.5, rel=0.02)


def test_wheels_do_not_slide_sideways_below_their_grip() -> None:
    sim = simulated(world(), (body(), (2.0, 1.5, 0.0)))
    drive(sim, 0.0, 0.0, seconds=0.1)
    solid = sim._space.bodies[0]

    for _ in range(240):
        solid.apply_force_at_local_point((0.0, 0.7 * 0.8 * 3.0 * 9.81), (0.0, 0.0))
        sim.advance()
    assert sim.poses()[0, 1] == pytest.approx(1.5, abs=1e-4)

    for _ in range(240):
        solid.apply_force_at_local_point((0.0, 1.5 * 0.8 * 3.0 * 9.81), (0.0, 0.0))
        sim.advance()
    assert sim.poses()[0, 1] > 1.6


def test_a_body_that_coasts_rolls_on_and_one_that_is_driven_to_zero_stops() -> None:
    sim = simulated(world(), (body(), (1.0, 1.5, 0.0)))
    drive(sim, 0.5, 0.0, seconds=0.5)

    sim.command(0, np.zeros(2), np.zeros(2, dtype=np.bool_))
    for _ in range(240):
        sim.advance()
    assert sim.motion(0).forward > 0.3

    drive(sim, 0.0, 0.0, seconds=0.5)
    assert sim.motion(0).forward == pytest.approx(0.0, abs=1e-6)


def test_a_channel_that_nobody_commands_stands_still() -> None:
    sim = simulated(world(), (body(DriveKind.HOLONOMIC), (1.0, 1.5, 0.0)))
    sim._ways = ((0, -1, -1),)

    drive(sim, 0.3, seconds=1.0)

    assert sim.motion(0).forward == pytest.approx(0.3, abs=1e-6)
    assert sim.motion(0).left == pytest.approx(0.0, abs=1e-9)
