"""Robots that are stuck are reported, with what holds them; those that move are not."""

from collections import deque

import numpy as np

from runtime.world.audit import LOOK, LOOKS, Cause, _cause, _Look
from runtime.world.model import DriveKind
from tests.runtime.world.worlds import body, box, drive, simulated, thing, world


def test_a_robot_that_pushes_what_does_not_yield_is_reported_with_it() -> None:
    desk = thing("desk", box(0.5, 0.5), (2.0, 1.5, 0.0), is_fixed=True)
    sim = simulated(world([desk]), (body(), (1.5, 1.5, 0.0)))

    drive(sim, 0.3, 0.0, seconds=5.0)
    drive(sim, -0.3, 0.0, seconds=2.0)

    (jam,) = sim.audit().jams
    assert (jam.robot, jam.thing, jam.cause) == ("r0", "desk", Cause.STALLED)
    assert 0.2 < jam.begin < 1.5
    assert 4.9 < jam.end < 5.5
    assert abs(jam.force - 0.8 * 3.0 * 9.81) < 1.0


def test_a_jam_that_lasts_is_told_before_it_ends() -> None:
    sim = simulated(world(), (body(), (3.8, 1.5, 0.0)))

    drive(sim, 0.3, 0.0, seconds=3.0)

    (jam,) = sim.audit().jams
    assert (jam.thing, jam.end) == ("walls", 3.0)


def test_who_moves_or_stands_by_command_is_not_stuck() -> None:
    crate = thing("crate", box(0.2, 0.2), (1.5, 1.5, 0.0))
    sim = simulated(
        world([crate]),
        (body(), (1.0, 1.5, 0.0)),
        (body(DriveKind.HOLONOMIC), (3.0, 0.5, 0.0)),
        (body(), (3.0, 2.5, 0.0)),
    )
    sim.command(1, np.array([0.0, 0.0, 1.0]), np.ones(3, dtype=np.bool_))

    drive(sim, 0.2, 0.0, seconds=4.0)

    assert sim.poses()[0, 0] > 1.7  # it pushed
    assert sim.audit().jams == ()


def looks(force: float, *, speed: float = 0.3, done: float = 0.0) -> deque[_Look]:
    return deque([_Look((speed, 0.0), (done, 0.0), force, 3)] * LOOKS)


def test_contacts_that_hold_with_far_more_than_the_drive_has_are_a_wedge() -> None:
    assert _cause(looks(force=120.0), 23.0, LOOK) is Cause.WEDGED
    assert _cause(looks(force=120.0, speed=0.0), 23.0, LOOK) is Cause.WEDGED
    assert _cause(looks(force=60.0), 23.0, LOOK) is Cause.STALLED
    assert _cause(looks(force=60.0, speed=0.0), 23.0, LOOK) is None
    assert _cause(looks(force=60.0, done=0.3 * LOOK), 23.0, LOOK) is None


def test_bodies_that_stand_in_one_another_are_told_with_their_names() -> None:
    left = thing("left", box(0.2, 0.2), (1.79, 1.5, 0.0), is_fixed=True)
    sim = simulated(world([left]), (body(), (2.0, 1.5, 0.0)))

    drive(sim, 0.0, 0.0, seconds=0.1)

    assert sim.audit().depth > 5e-3
    assert sim.audit().pair == ("left", "r0")


def test_an_impact_is_no_wedge() -> None:
    sim = simulated(world(), (body(), (3.0, 1.5, 0.0)))

    for _ in range(4):
        drive(sim, 0.5, 0.0, seconds=1.9)
        drive(sim, -0.5, 0.0, seconds=1.5)

    assert all(jam.cause is Cause.STALLED for jam in sim.audit().jams)
