"""A pushed box goes where a quasi-static pusher takes it; wheels give what they grip."""

import math

import numpy as np
import pytest

from runtime.world.world import SimulatedWorld
from tests.runtime.world.quasi_static import pushed
from tests.runtime.world.worlds import body, box, drive, simulated, thing, world

PUSH = 0.3
SPEED = 0.05


def pose_after_push(offset: float, friction: float) -> tuple[tuple[float, ...], float]:
    """Where a box of 12 x 20 cm ends, and how far the robot went in truth."""
    crate = thing("crate", box(0.12, 0.2), (1.0, 1.0, 0.0), friction=friction)
    robot = body(mass=20.0, friction=1.0 if friction else 0.0)
    start = 1.0 - 0.06 - 0.12
    sim = simulated(world([crate]), (robot, (start, 1.0 + offset, 0.0)))
    drive(sim, SPEED, 0.0, seconds=PUSH / SPEED)
    drive(sim, 0.0, 0.0, seconds=0.2)
    poses = sim.poses()
    return tuple(poses[0].tolist()), float(poses[1, 0] - start)


ROUGH = 0.36, 125
"""Where the contact sticks, the reference is found by trial, which takes long."""


@pytest.mark.parametrize("offset", [0.01, 0.03, 0.05])
@pytest.mark.parametrize(("friction", "steps"), [(0.0, 250), (0.06, 250), ROUGH])
def test_a_pushed_box_ends_where_the_quasi_static_reference_ends(
    offset: float, friction: float, steps: int
) -> None:
    found, gone = pose_after_push(offset, friction)
    corners = box(0.12, 0.2).polygons[0].vertices
    start = (1.0 - 0.06 - 0.12, 1.0 + offset)
    wanted = pushed(corners, (1.0, 1.0, 0.0), start, 0.12, gone, friction, steps)

    assert math.hypot(found[0] - wanted[0], found[1] - wanted[1]) <= 4e-3
    assert abs(found[2] - wanted[2]) <= math.radians(1.5)
    assert abs(wanted[2]) > math.radians(9.0)  # there was something to turn


def test_the_reference_goes_straight_when_it_is_pushed_in_the_middle() -> None:
    corners = box(0.12, 0.2).polygons[0].vertices

    found = pushed(corners, (1.0, 1.0, 0.0), (0.82, 1.0), 0.12, 0.1, 0.06, steps=20)

    assert found == pytest.approx((1.1, 1.0, 0.0), abs=1e-6)


def test_a_sliding_box_stops_where_dry_friction_stops_it() -> None:
    crate = thing("crate", box(0.2, 0.2), (1.0, 1.0, 0.0), floor=0.4)
    sim = simulated(world([crate]))
    sim._space.bodies[0].velocity = (1.0, 0.0)

    drive_nothing(sim, 0.5)

    assert sim.poses()[0, 0] - 1.0 == pytest.approx(1.0 / (2.0 * 0.4 * 9.81), rel=0.05)


def drive_nothing(sim: SimulatedWorld, seconds: float) -> None:
    for _ in range(round(seconds / sim.step)):
        sim.advance()


def test_a_spinning_box_stops_by_the_torque_of_its_whole_surface() -> None:
    crate = thing("crate", box(0.2, 0.2), (1.0, 1.0, 0.0), floor=0.4)
    sim = simulated(world([crate]))
    sim._space.bodies[0].angular_velocity = 5.0
    gyration = 2 * 0.2**2 / 12.0
    arm = 0.2 * (math.sqrt(2.0) + math.asinh(1.0)) / 6.0  # the mean distance from the middle

    drive_nothing(sim, 0.7)

    slowing = 0.4 * 9.81 * arm / gyration
    assert sim.poses()[0, 2] == pytest.approx(5.0**2 / (2.0 * slowing), rel=0.05)


def test_a_robot_that_pushes_a_wall_stalls_and_its_wheels_slip() -> None:
    sim = simulated(world(), (body(), (3.8, 1.5, 0.0)))

    drive(sim, 0.5, 0.0, seconds=5.0)

    assert sim.poses()[0, 0] == pytest.approx(4.0 - 0.12, abs=2e-3)
    assert sim.motion(0).forward == pytest.approx(0.0, abs=1e-6)
    assert sim.commanded(0).forward == 0.5
    touches = sim._space.touches()
    assert touches[0].impulse / sim.step == pytest.approx(0.8 * 3.0 * 9.81, rel=1e-3)


def test_no_box_is_pushed_through_a_wall() -> None:
    crate = thing("crate", box(0.05, 0.05), (3.8, 1.5, 0.3), mass=0.1)
    sim = simulated(world([crate]), (body(), (3.0, 1.5, 0.0)))

    drive(sim, 0.5, 0.0, seconds=10.0)

    assert sim.poses()[0, 0] < 4.0
    assert sim.audit().depth <= 2e-3


@pytest.mark.parametrize(("mass", "travel"), [(5.0, 0.4), (7.0, 0.0)])
def test_what_is_too_heavy_for_the_grip_of_the_wheels_stays(mass: float, travel: float) -> None:
    """The wheels give 0.8 * 3 kg * g; the floor holds 0.4 * mass * g."""
    crate = thing("crate", box(0.3, 0.3), (2.0, 1.5, 0.0), mass=mass)
    sim = simulated(world([crate]), (body(), (1.73 - 0.005, 1.5, 0.0)))

    drive(sim, 0.2, 0.0, seconds=2.0)

    assert sim.poses()[0, 0] - 2.0 == pytest.approx(travel, abs=0.05)
    before = sim.poses()[0, 0]
    drive(sim, 0.2, 0.0, seconds=5.0)
    assert sim.poses()[0, 0] - before == pytest.approx(1.0 if travel else 0.0, abs=0.01)


def test_robots_push_one_another_by_their_grip() -> None:
    sim = simulated(
        world(),
        (body(mass=6.0), (1.0, 1.5, 0.0)),
        (body(mass=3.0), (1.5, 1.5, math.pi)),
    )
    sim.command(1, np.array([0.3, 0.0]), np.ones(2, dtype=np.bool_))

    drive(sim, 0.3, 0.0, seconds=3.0)

    assert sim.poses()[1, 0] > 1.7  # the heavier one has its way
