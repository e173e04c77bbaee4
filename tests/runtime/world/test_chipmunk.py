"""What is asked of the physics without a detour is what its own methods say."""

import math

import numpy as np
import pymunk
import pytest
from pymunk.batch import ArbiterFields

from runtime.world import chipmunk
from runtime.world.chipmunk import Bodies, Contacts, aimer, compass, finder, stepper
from runtime.world.kernels import memory


def pile(count: int) -> tuple[pymunk.Space, list[pymunk.Body]]:
    """Discs that overlap their neighbors, one fixed."""
    space, bodies = pymunk.Space(), []
    for k in range(count):
        body = pymunk.Body(1.0 + k, 2.0) if k else pymunk.Body(body_type=pymunk.Body.STATIC)
        body.position = (0.9 * k, 0.1 * k)
        body.angle = 0.3 * k
        space.add(body, pymunk.Circle(body, 0.5))
        if k:
            body.velocity, body.angular_velocity = (0.1 * k, -0.2 * k), 0.05 * k
        bodies.append(body)
    return space, bodies


def test_a_step_is_a_step() -> None:
    (one, bodies), (other, others) = pile(5), pile(5)
    step = stepper(one)
    one.step(0.01)
    other.step(0.01)

    for _ in range(20):
        step(0.005)
        other.step(0.005)

    assert [(*b.position, b.angle) for b in bodies] == [(*b.position, b.angle) for b in others]


def test_a_velocity_is_set_and_a_heading_foreseen() -> None:
    space = pymunk.Space()
    body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    body.angle, body.angular_velocity = 0.7, -2.0
    space.add(body)

    aimer(body)(0.3, -0.4)

    assert body.velocity == (0.3, -0.4)
    foreseen = compass(body)(0.25)
    space.step(0.25)
    assert foreseen == pytest.approx(body.angle, abs=1e-15)


def test_a_body_is_found_where_it_is() -> None:
    space = pymunk.Space()
    body = pymunk.Body(1.0, 1.0)
    body.center_of_gravity = (0.1, 0.2)
    body.angle, body.position, body.velocity = 0.7, (1.0, -2.0), (3.0, 4.0)
    space.add(body)
    find = finder(body)

    for _ in range(2):
        assert find() == (*body.position, body.angle)
        space.step(0.25)


@pytest.mark.parametrize("count", [1, 3, 40])
def test_all_bodies_are_read_as_they_are_and_as_they_come_to_be(count: int) -> None:
    space, bodies = pile(count)
    bodies[-1].center_of_gravity = (0.1, -0.2)
    asked = Bodies(bodies)
    for _ in range(3):
        space.step(0.01)
        found = asked.states()

        wanted = [(*b.position, b.angle, *b.velocity, b.angular_velocity) for b in bodies]
        assert found.tolist() == [list(row) for row in wanted]
        assert asked.largest_speeds() == tuple(np.abs(found[:, 3:]).max(axis=0))


def test_contacts_are_those_that_arbiters_tell() -> None:
    space, bodies = pile(4)
    depths = Contacts(space, ArbiterFields.BODY_A_ID | ArbiterFields.DISTANCE_1)
    assert depths.read() == []
    assert depths.whole() == []
    told: list[float] = []
    space.step(0.01)

    for body in bodies:
        body.each_arbiter(lambda a: told.append(a.contact_point_set.points[0].distance))

    # Each contact has two bodies, of which the fixed one has no arbiters of its own.
    assert set(depths.read()) == set(told)
    assert len(depths.whole()) == len(depths.read()) == 3
    assert min(told) == pytest.approx(math.hypot(0.9, 0.1) - 1.0, abs=0.02)


PLACES = [
    "INVERSE_MASS",
    "INVERSE_MOMENT",
    "VELOCITY",
    "HEADING",
    "TURN",
    "PLACE",
    "JOINTS",
    "OTHER",
    "OWN",
    "NEXT",
    "ARM",
    "FELT",
]


@pytest.mark.parametrize("name", PLACES)
def test_another_layout_of_memory_is_noticed_and_refused(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    chipmunk.make_sure()
    monkeypatch.setattr(memory, name, getattr(memory, name) + 1)

    with pytest.raises(chipmunk.OtherPhysicsError, match="in memory otherwise"):
        chipmunk.make_sure.__wrapped__()
