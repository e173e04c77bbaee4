"""The world as a whole: repeats bit for bit, keeps heights, contacts and clearance, and sleeps."""

import math
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from runtime.world.model import DriveKind
from runtime.world.world import SimulatedWorld
from tests.principles.loads import busy_processors
from tests.runtime.world.worlds import (
    body,
    box,
    drive,
    round_,
    scatter,
    simulated,
    thing,
    world,
)

ROOT = Path(__file__).parents[3]
RUN = """
from tests.runtime.world.test_world import crowded, wander
from hashlib import blake2b
chain = blake2b()
wander(crowded(), 1.0, chain.update)
print(chain.hexdigest())
"""


def crowded(seed: int = 5) -> SimulatedWorld:
    scattered = [
        scatter("free", 60, box(0.2, 0.15)),
        scatter("fixed", 20, box(0.2, 0.15), fixed=1.0),
    ]
    model = world(size=(5.0, 4.0), scattered=scattered)
    return simulated(model, (body(), None), (body(DriveKind.HOLONOMIC), None), seed=seed)


def wander(sim: SimulatedWorld, seconds: float, seen: object = None) -> None:
    """Drive all robots at random, and show the hash of every step."""
    random = np.random.default_rng(1)
    until = sim.time + seconds
    while sim.time < until:
        for robot, inhabitant in enumerate(sim.inhabitants):
            values = random.uniform(-0.5, 0.5, len(inhabitant.channels))
            sim.command(robot, values, np.ones(len(values), dtype=np.bool_))
        for _ in range(60):
            sim.advance()
            if callable(seen):
                seen(sim.state_hash())


def test_fresh_processes_give_the_same_hashes_whatever_else_the_machine_does() -> None:
    def started(hash_seed: str) -> "subprocess.Popen[str]":
        environment = os.environ | {"PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-c", RUN]
        return subprocess.Popen(
            command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True
        )

    alone = started("1").communicate()[0]
    with busy_processors(1):
        loaded = started("2").communicate()[0]

    assert len(alone) > 100
    assert alone == loaded


def test_a_crowded_world_keeps_its_bodies_apart_for_a_minute() -> None:
    sim = crowded()

    wander(sim, 60.0)

    assert sim.audit().depth <= 2e-3


def test_the_hash_tells_states_apart() -> None:
    one, other = (simulated(world(), (body(), (1.0, 1.0, 0.0))) for _ in range(2))
    assert one.state_hash() == other.state_hash()

    drive(one, 0.1, 0.0, seconds=0.1)
    drive(other, 0.1, 1e-12, seconds=0.1)

    assert one.state_hash() != other.state_hash()


def test_asking_changes_nothing() -> None:
    silent, asked = crowded(), crowded()
    for _ in range(480):
        for sim in (silent, asked):
            sim.command(0, np.array([0.5, 0.3]), np.ones(2, dtype=np.bool_))
            sim.advance()
        for robot in range(2):
            asked.touching(robot)
            asked.clearance(robot)
            asked.motion(robot)
        asked.geometry()
        asked.poses()
        asked.audit()

    assert asked.state_hash() == silent.state_hash()


@pytest.mark.parametrize(
    ("heights", "passes"), [((0.15, 0.2), True), ((0.0, 0.2), False), ((0.1, 0.2), True)]
)
def test_a_low_robot_passes_below_what_hangs_and_stops_at_what_stands(
    *, heights: tuple[float, float], passes: bool
) -> None:
    light = thing("light", round_(0.1), (2.0, 1.5, 0.0), is_fixed=True, heights=heights)
    sim = simulated(world([light]), (body(high=0.1), (1.0, 1.5, 0.0)))

    drive(sim, 0.5, 0.0, seconds=4.0)

    reached = sim.poses()[1, 0]
    assert reached == pytest.approx(2.0 + 0.95 if passes else 2.0 - 0.22, abs=0.05)
    assert bool(sim.touching(0)) is not passes


def test_clearance_sees_only_what_is_at_the_heights_of_the_robot() -> None:
    hanging = thing("light", round_(0.1), (1.5, 1.5, 0.0), is_fixed=True, heights=(0.15, 0.2))
    standing = thing("box", box(0.2, 0.2), (2.0, 1.5, 0.0), is_fixed=True)
    sim = simulated(world([hanging, standing]), (body(), (1.0, 1.5, 0.0)))

    assert sim.clearance(0) == pytest.approx(0.9 - 0.12, abs=1e-12)


def test_clearance_is_the_least_distance_of_points_on_both_outlines() -> None:
    def outline(corners: np.ndarray) -> np.ndarray:
        following = np.roll(corners, -1, axis=0)
        shares = np.linspace(0.0, 1.0, 400)[:, None, None]
        return (corners + shares * (following - corners)).reshape(-1, 2)

    sim = crowded(seed=11)
    geometry = sim.geometry()
    discs = geometry.owner[len(geometry.segments) :]
    corners = [
        geometry.segments[(geometry.owner == owner).nonzero()[0], :2]
        for owner in range(geometry.things)
    ]
    points = np.vstack([outline(c) for c in corners])
    for robot in range(2):
        x, y, radius = geometry.discs[discs == geometry.things + robot][0]
        other = geometry.discs[discs == geometry.things + 1 - robot][0]
        wanted = min(
            np.hypot(points[:, 0] - x, points[:, 1] - y).min() - radius,
            math.dist((x, y), other[:2]) - radius - other[2],
            min(x, y, 5.0 - x, 4.0 - y) - radius,
        )
        assert sim.clearance(robot) == pytest.approx(wanted, abs=2e-4)


def test_contacts_say_what_touches_and_from_where() -> None:
    crate = thing("crate", box(0.2, 0.2), (1.5, 2.0, 0.0), is_fixed=True)
    sim = simulated(world([crate]), (body(), (1.5, 1.5, math.pi / 4.0)))
    assert sim.touching(0) == ()

    sim = simulated(world([crate]), (body(DriveKind.HOLONOMIC), (1.5, 1.7, math.pi / 4.0)))
    drive(sim, 0.2 * math.sqrt(0.5), 0.2 * math.sqrt(0.5), 0.0, seconds=2.0)

    (contact,) = sim.touching(0)
    assert sim.geometry().names[contact.owner] == "crate"
    assert (contact.x, contact.y) == pytest.approx((1.5, 1.9), abs=2e-3)
    assert contact.bearing == pytest.approx(math.pi / 4.0, abs=0.02)
    assert sim.clearance(0) == pytest.approx(0.0, abs=1e-4)

    drive(sim, -0.2, -0.2, 0.0, seconds=0.5)
    assert sim.touching(0) == ()


def test_a_robot_in_a_corner_touches_two_walls_at_two_bearings() -> None:
    sim = simulated(world(), (body(DriveKind.HOLONOMIC), (0.3, 0.3, 0.0)))

    drive(sim, -0.3, -0.3, 0.0, seconds=2.0)

    contacts = sim.touching(0)
    assert {sim.geometry().names[contact.owner] for contact in contacts} == {"walls"}
    assert sorted(contact.bearing for contact in contacts) == pytest.approx(
        [-math.pi, -math.pi / 2.0], abs=0.05
    ) or sorted(contact.bearing for contact in contacts) == pytest.approx(
        [-math.pi / 2.0, math.pi], abs=0.05
    )


def test_what_nobody_touches_sleeps_and_wakes_when_it_is_pushed() -> None:
    crate = thing("crate", box(0.2, 0.2), (2.0, 1.5, 0.0))
    sim = simulated(world([crate]), (body(), (1.0, 1.5, 0.0)))

    drive(sim, 0.0, 0.0, seconds=1.0)
    assert sim._space.bodies[0].is_sleeping

    drive(sim, 0.3, 0.0, seconds=4.0)
    assert not sim._space.bodies[0].is_sleeping
    assert sim.poses()[0, 0] > 2.1


def test_coarse_steps_are_cut_into_finer_ones_of_the_physics() -> None:
    coarse = simulated(world(), (body(), (1.0, 1.0, 0.0)), step=0.05)
    fine = simulated(world(), (body(), (1.0, 1.0, 0.0)))

    for sim in (coarse, fine):
        drive(sim, 0.3, 1.0, seconds=2.0)

    assert coarse.poses() == pytest.approx(fine.poses(), abs=2e-3)


def test_a_step_costs_little_python_beside_the_physics() -> None:
    """In an empty world; measured about 10 µs where the processor is free."""

    def seconds(step: Callable[[], object]) -> float:
        began = time.process_time()
        for _ in range(2000):
            step()
        return (time.process_time() - began) / 2000

    sim = simulated(world(), (body(), (2.0, 1.5, 0.0)))
    drive(sim, 0.1, 1.0, seconds=0.5)
    physics = min(seconds(lambda: sim._space.space.step(1.0 / 240.0)) for _ in range(5))
    all_ = min(seconds(sim.advance) for _ in range(5))

    assert all_ - physics < 60e-6  # others that use the machine make it several times slower
