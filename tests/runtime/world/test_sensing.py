"""What sensors of each kind say in small worlds."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from runtime.program import Kind, Unit
from runtime.world.model import Body, DriveKind, Light, Pose, Reading, Sensor, SensorKind, Thing
from runtime.world.sensing import Senses, senses_of
from runtime.world.world import Inhabitant, SimulatedWorld
from tests.runtime.world.worlds import STEP, body, box, drive, round_, thing, world

READINGS = {
    SensorKind.BUMP: ("hit",),
    SensorKind.RANGE: ("range",),
    SensorKind.LIGHT: ("light",),
    SensorKind.SIGHT: ("seen", "bearing", "distance"),
    SensorKind.ODOMETRY: ("x", "y", "heading", "speed", "turn"),
    SensorKind.GYRO: ("turn",),
    SensorKind.POSE: ("x", "y", "heading", "speed", "turn"),
}


def sensor(
    kind: SensorKind,
    *,
    at: tuple[float, float, float] = (0.0, 0.0, 0.0),
    width: float = math.tau,
    reach: float = 3.0,
    rays: int = 1,
    height: float = 0.05,
    of: tuple[str, ...] = (),
    slip: float = 0.0,
) -> Sensor:
    readings = tuple(
        Reading(name, Unit("1", 1.0), -1e6, 1e6, Kind.CONTINUOUS, 0.0, 0.0)
        for name in READINGS[kind]
    )
    return Sensor(
        *("sensor", kind, Pose(*at), width, reach, rays, height, of, slip, 0.05, 0.0, readings, "")
    )


def placed(
    fitted: Sensor,
    at: tuple[float, float, float],
    things: Sequence[Thing] = (),
    lights: tuple[Light, ...] = (),
    *,
    part: Body | None = None,
    others: Sequence[tuple[float, float, float]] = (),
    ambient: float = 0.0,
    seed: int = 1,
) -> SimulatedWorld:
    """A world of 4 m by 3 m with one robot that has the sensor, and others that have none."""
    model = replace(world(things), lights=lights, ambient=ambient)
    parts = [replace(part or body(), sensors=(fitted,)), *(body() for _ in others)]
    channels = ("base.speed", "base.turn")
    if parts[0].drive.kind is DriveKind.HOLONOMIC:
        channels = ("base.forward", "base.left", "base.turn")
    robots = [
        Inhabitant(f"r{k}", each, Pose(*pose), channels)
        for k, (each, pose) in enumerate(zip(parts, (at, *others), strict=True))
    ]
    return SimulatedWorld(model, robots, STEP, seed, senses=senses_of)


def said(sim: SimulatedWorld) -> list[float]:
    readings: list[float] = sim.sample(0, 0).tolist()
    return readings


def lamp(x: float, y: float, height: float = 0.17, power: float = 10.0) -> Light:
    return Light("lamp", "", Pose(x, y, 0.0), height, power, math.tau, "")


def test_a_range_sensor_sees_past_its_own_body_to_the_nearest_of_its_rays() -> None:
    crate = thing("crate", box(0.2, 0.2), (2.0, 1.3, 0.0))
    one = sensor(SensorKind.RANGE, width=0.0)
    many = sensor(SensorKind.RANGE, width=math.radians(60), rays=9)

    assert said(placed(one, (1.0, 1.0, 0.0), [crate])) == pytest.approx([3.0])  # wall
    assert said(placed(many, (1.0, 1.0, 0.0), [crate]))[0] == pytest.approx(
        0.9 / math.cos(math.radians(15))
    )


def test_a_range_sensor_looks_from_where_it_is_mounted() -> None:
    left = sensor(SensorKind.RANGE, at=(0.1, 0.05, 0.5 * math.pi), width=0.0)

    assert said(placed(left, (1.0, 1.0, 0.0))) == pytest.approx([1.95])
    assert said(placed(left, (1.0, 1.0, 0.5 * math.pi))) == pytest.approx([0.95])


def test_a_range_that_hits_nothing_says_its_reach() -> None:
    assert said(placed(sensor(SensorKind.RANGE, reach=0.7), (2.0, 1.5, 0.0))) == [0.7]


def test_a_range_sensor_sees_another_robot() -> None:
    fitted = sensor(SensorKind.RANGE, width=0.0)

    assert said(placed(fitted, (1.0, 1.0, 0.0), others=[(2.0, 1.0, 0.0)])) == pytest.approx([0.88])


def test_a_meter_says_lambert_and_ambient_light() -> None:
    sim = placed(sensor(SensorKind.LIGHT), (1.0, 1.0, 0.3), lights=(lamp(1.5, 1.0),), ambient=2.0)

    square = 0.5**2 + 0.12**2
    assert said(sim) == pytest.approx([2.0 + 10.0 * 0.12 / square**1.5])
    senses = sim._senses
    assert isinstance(senses, Senses)
    assert senses.light(0) == pytest.approx(said(sim)[0])


def test_a_meter_with_an_angle_sees_lights_and_ambient_light_within_it() -> None:
    narrow = sensor(SensorKind.LIGHT, width=0.5 * math.pi)
    ahead, behind = lamp(1.5, 1.1), lamp(0.5, 1.0)

    full = said(placed(sensor(SensorKind.LIGHT), (1.0, 1.0, 0.0), lights=(ahead,)))
    both = placed(narrow, (1.0, 1.0, 0.0), lights=(ahead, behind), ambient=2.0)

    assert said(both) == pytest.approx([full[0] + 0.5])
    assert said(placed(narrow, (1.0, 1.0, 0.0), lights=(behind,))) == [0.0]


def test_a_robot_does_not_stand_in_its_own_light_but_another_does() -> None:
    lights = (lamp(2.0, 1.0, height=0.11),)
    lower = sensor(SensorKind.LIGHT, height=0.02)
    alone = placed(lower, (1.0, 1.0, 0.0), lights=lights)
    shaded = placed(lower, (1.0, 1.0, 0.0), lights=lights, others=[(1.3, 1.0, 0.0)])

    assert said(alone)[0] > 0.0
    assert said(shaded) == [0.0]


def test_sight_says_bearing_and_distance_of_the_nearest_that_is_not_hidden() -> None:
    near = thing("clutter_1", round_(0.1), (2.0, 1.0, 0.0))
    hidden = thing("clutter_2", round_(0.1), (1.0, 1.5, 0.0))
    screen = thing("screen", box(0.4, 0.05), (1.0, 1.25, 0.0))
    fitted = sensor(SensorKind.SIGHT, of=("clutter_*",))

    sim = placed(fitted, (1.0, 1.0, 0.5), [near, hidden])
    assert said(sim) == pytest.approx([1.0, 0.5 * math.pi - 0.5, 0.5])
    sim = placed(fitted, (1.0, 1.0, 0.5), [near, hidden, screen])
    assert said(sim) == pytest.approx([1.0, -0.5, 1.0])


def test_sight_that_sees_nothing_has_nothing_new_to_say() -> None:
    fitted = sensor(SensorKind.SIGHT, of=("light",), width=1.0)

    seen, *rest = said(placed(fitted, (1.0, 1.0, 0.0), lights=(lamp(0.5, 1.0),)))

    assert seen == 0.0
    assert np.isnan(rest).all()


def test_sight_of_a_light_goes_over_what_is_low_enough() -> None:
    low = thing("low", box(0.1, 1.0), (1.5, 1.0, 0.0), heights=(0.0, 0.08))
    high = thing("high", box(0.1, 1.0), (1.5, 1.0, 0.0), heights=(0.0, 0.16))
    fitted = sensor(SensorKind.SIGHT, of=("light",), height=0.05)

    lights = (lamp(2.0, 1.0),)
    assert said(placed(fitted, (1.0, 1.0, 0.0), [low], lights))[0] == 1.0
    assert said(placed(fitted, (1.0, 1.0, 0.0), [high], lights))[0] == 0.0


def test_sight_finds_lights_and_robots_by_name_and_never_itself() -> None:
    other = sensor(SensorKind.SIGHT, of=("r1", "r0"))
    named = sensor(SensorKind.SIGHT, of=("lamp",))

    at = (1.0, 1.0, 0.0)
    assert said(placed(other, at, others=[(2.0, 1.0, 0.0)])) == pytest.approx([1.0, 0.0, 1.0])
    assert said(placed(named, at, lights=(lamp(1.0, 2.0),)))[2] == pytest.approx(1.0)


@pytest.mark.parametrize(("looks", "hit"), [(0.0, 1.0), (0.5 * math.pi, 0.0), (math.pi, 0.0)])
def test_a_bumper_feels_contacts_within_its_width(looks: float, hit: float) -> None:
    fitted = sensor(SensorKind.BUMP, at=(0.0, 0.0, looks), width=math.radians(100))
    sim = placed(fitted, (3.5, 1.5, 0.0))
    assert said(sim) == [0.0]

    drive(sim, 0.3, 0.0, seconds=2.0)

    assert said(sim) == [hit]


def test_a_pose_sensor_says_where_the_robot_is_and_how_it_moves() -> None:
    sim = placed(sensor(SensorKind.POSE), (1.0, 1.5, 0.0))

    drive(sim, 0.3, 0.5, seconds=2.0)

    x, y, heading, speed, turn = said(sim)
    assert (x, y) == tuple(sim.poses()[0, :2].tolist())
    assert heading == math.remainder(float(sim.poses()[0, 2]), math.tau)
    assert (speed, turn) == pytest.approx((0.3, 0.5), rel=0.02)


def test_a_gyro_adds_up_to_the_heading_of_the_body() -> None:
    """In a step a body first turns as fast as it did, and then changes that."""
    sim = placed(sensor(SensorKind.GYRO), (2.0, 1.5, 0.3))
    chance, turned = np.random.default_rng(1), 0.0
    for _ in range(20):
        speed, turn = chance.uniform((-0.2, -2.0), (0.2, 2.0))
        for _ in range(24):
            turned += said(sim)[0] * STEP
            drive(sim, speed, turn, seconds=STEP)

    assert sim.poses()[0, 2] - 0.3 == pytest.approx(turned, abs=1e-9)


def test_a_gyro_tells_that_it_is_pushed_where_wheels_tell_nothing() -> None:
    def turns(kind: SensorKind) -> list[float]:
        long = body(shape=box(0.6, 0.2), mass=1.0)
        sim = placed(sensor(kind), (2.0, 1.5, 0.5 * math.pi), part=long, others=[(1.7, 1.75, 0.0)])
        found = []
        for _ in range(100):  # the other one drives into its side, ahead of its middle
            drive(sim, 0.3, 0.0, seconds=STEP, robot=1)
            found.append(said(sim)[-1])
        return found

    assert max(map(abs, turns(SensorKind.ODOMETRY))) == 0.0
    assert min(turns(SensorKind.GYRO)) < -0.1


def test_a_gyro_is_right_where_wheels_are_not_as_large_as_they_are_said_to_be() -> None:
    gyro = placed(sensor(SensorKind.GYRO), (1.0, 1.5, 0.0))
    odometry = placed(sensor(SensorKind.ODOMETRY, slip=0.05), (1.0, 1.5, 0.0))
    for sim in (gyro, odometry):
        drive(sim, 0.4, 0.0, seconds=1.0)

    assert said(gyro)[0] == pytest.approx(0.0, abs=1e-9)
    assert abs(said(odometry)[-1]) > 0.01


def test_odometry_without_slip_is_where_the_robot_is_seen_from_its_start() -> None:
    """On a circle, in the frame of the start: turned by its heading, and from there."""
    sim = placed(sensor(SensorKind.ODOMETRY), (2.0, 1.0, 0.8))

    drive(sim, 0.3, 0.6, seconds=4.0)

    x, y, heading, *_ = said(sim)
    true_x, true_y, true_heading = sim.poses()[0].tolist()
    assert 2.0 + x * math.cos(0.8) - y * math.sin(0.8) == pytest.approx(true_x, abs=1e-5)
    assert 1.0 + x * math.sin(0.8) + y * math.cos(0.8) == pytest.approx(true_y, abs=1e-5)
    assert heading == pytest.approx(math.remainder(true_heading - 0.8, math.tau), abs=1e-5)


def test_wheels_that_slip_are_believed() -> None:
    sim = placed(sensor(SensorKind.ODOMETRY), (3.5, 1.5, 0.0))

    drive(sim, 0.3, 0.0, seconds=4.0)  # against the wall after a second and a half

    assert said(sim)[0] == pytest.approx(4.0 * 0.3, abs=0.05)
    assert sim.poses()[0, 0] < 3.9


def test_scales_of_wheels_are_drawn_once_for_a_seed_and_spread_as_declared() -> None:
    def gained(seed: int) -> float:
        sim = placed(sensor(SensorKind.ODOMETRY, slip=0.02), (1.0, 1.5, 0.0), seed=seed)
        drive(sim, 0.5, 0.0, seconds=0.5)
        return said(sim)[3] / 0.5

    assert gained(3) == gained(3)
    # The speed is the mean of two wheels: its scale spreads by 0.02 / sqrt(2).
    spread = np.std([gained(seed) for seed in range(60)]) * math.sqrt(2.0)
    assert 0.015 < spread < 0.025


def test_a_holonomic_body_counts_its_steps_in_all_directions() -> None:
    part = body(DriveKind.HOLONOMIC)
    sim = placed(sensor(SensorKind.ODOMETRY), (1.0, 1.0, 0.3), part=part)

    drive(sim, 0.1, 0.2, 0.4, seconds=2.0)

    x, y, heading, speed, turn = said(sim)
    true = sim.poses()[0]
    assert (speed, turn) == pytest.approx((math.hypot(0.1, 0.2), 0.4))
    assert math.hypot(x, y) == pytest.approx(math.hypot(*(true[:2] - 1.0)), abs=1e-4)
    assert heading == pytest.approx(true[2] - 0.3, abs=1e-4)


def test_asking_changes_nothing() -> None:
    asked, left = (placed(sensor(SensorKind.ODOMETRY), (1.0, 1.0, 0.3)) for _ in range(2))
    for _ in range(30):
        for sim in (asked, left):
            drive(sim, 0.2, 0.5, seconds=STEP)
        said(asked)

    assert asked.state_hash() == left.state_hash()


def test_the_light_map_of_a_world_covers_its_arena() -> None:
    sim = placed(sensor(SensorKind.LIGHT), (1.0, 1.0, 0.0), lights=(lamp(2.0, 2.0),), ambient=1.0)
    senses = sim._senses
    assert isinstance(senses, Senses)

    found = senses.light_map((40, 30))

    assert (found.xs[0], found.xs[-1], found.ys[-1]) == pytest.approx((0.05, 3.95, 2.95))
    assert found.lux.min() >= 1.0
    assert np.unravel_index(found.lux.argmax(), found.lux.shape) in {
        (i, j) for i in (19, 20) for j in (19, 20)
    }
