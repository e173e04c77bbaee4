"""Footprints have the area moments of textbooks; feet hold both pure motions as a surface does."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from runtime.world.floor import feet_of
from runtime.world.footprint import bounds, contains, in_world, points_of, scaled, spread
from runtime.world.heights import bands
from runtime.world.model import Disc, Polygon, Pose, Shape
from tests.runtime.world.worlds import box, round_, simulated, thing, world

LENGTHS = st.floats(0.05, 1.0)
HEIGHTS = st.tuples(st.integers(0, 12), st.integers(1, 6)).map(lambda x: (x[0], x[0] + x[1]))
SEEDS = st.integers(0, 2**32 - 1)


def random_polygon(seed: int) -> Shape:
    random = np.random.default_rng(seed)
    points = random.normal(size=(random.integers(3, 9), 2)) * (0.2, 0.1) + random.normal(size=2)
    corners = points[ConvexHull(points).vertices].tolist()
    return Shape((), (Polygon(tuple((x, y) for x, y in corners)),))


@given(LENGTHS, LENGTHS)
def test_a_box_has_the_moment_of_inertia_of_a_box(length: float, width: float) -> None:
    found = spread(box(length, width))

    assert (found.x, found.y) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert found.gyration == pytest.approx((length**2 + width**2) / 12.0)


@settings(max_examples=15)
@given(SEEDS)
def test_a_polygon_has_the_moments_of_many_points_within_it(seed: int) -> None:
    shape = random_polygon(seed)
    random = np.random.default_rng(seed)
    low, high = bounds(shape)
    points = random.uniform(low, high, (50_000, 2))
    points = points[contains(shape, points)]
    assume(len(points) > 2000)

    found = spread(shape)

    middle = points.mean(axis=0)
    away = np.hypot(*(points - middle).T)
    size = float(away.max())
    assert (found.x, found.y) == pytest.approx(tuple(middle), abs=0.02 * size)
    assert found.gyration == pytest.approx(float((away**2).mean()), rel=0.05)
    assert found.arm == pytest.approx(float(away.mean()), rel=0.05)


def test_a_circle_has_the_moment_and_the_mean_distance_of_a_circle() -> None:
    found = spread(Shape((Disc(0.1, -0.2, 0.3),), ()))

    assert (found.x, found.y, found.gyration, found.arm) == (0.1, -0.2, 0.045, pytest.approx(0.2))


def test_parts_that_overlap_count_once() -> None:
    (part,) = box(0.2, 0.1).polygons
    shifted = Polygon(tuple((x + 0.05, y) for x, y in part.vertices))

    whole = spread(Shape((), (part, shifted)))

    one = spread(box(0.25, 0.1))
    assert whole.x == pytest.approx(0.025, abs=2e-3)
    assert whole.gyration == pytest.approx(one.gyration, rel=0.02)


@given(SEEDS, st.floats(0.5, 2.0), st.floats(-4.0, 4.0))
def test_a_footprint_in_the_world_is_scaled_turned_and_moved(
    seed: int, factor: float, heading: float
) -> None:
    shape = random_polygon(seed)

    edges, _ = in_world(scaled(shape, factor), Pose(1.0, 2.0, heading))

    cosine, sine = math.cos(heading), math.sin(heading)
    turn = np.array([[cosine, -sine], [sine, cosine]])
    wanted = factor * np.array(shape.polygons[0].vertices) @ turn.T + (1.0, 2.0)
    assert edges[:, :2] == pytest.approx(wanted)
    assert edges[:, 2:] == pytest.approx(np.roll(wanted, -1, axis=0))


def held(shape: Shape, velocity: np.ndarray, turn: float) -> tuple[np.ndarray, float]:
    """Force and torque of feet by the law of dry friction, for a weight of one newton."""
    lies = spread(shape)
    feet = feet_of(shape, lies)
    force, torque = np.zeros(2), 0.0
    for place, share in zip(feet.places - (lies.x, lies.y), feet.shares, strict=True):
        across = np.array([-place[1], place[0]])
        slides = velocity + turn * across
        one = -share * slides / np.linalg.norm(slides)
        force += one
        torque += float(across @ one)
    return force, torque


@settings(max_examples=15)
@given(SEEDS)
def test_feet_hold_a_turn_with_the_mean_distance_of_the_surface(seed: int) -> None:
    shape = random_polygon(seed)

    _, torque = held(shape, np.zeros(2), 1.0)

    assert -torque == pytest.approx(spread(shape).arm, rel=1e-6)


@settings(max_examples=6)
@given(SEEDS)
def test_the_physics_slows_what_slides_by_dry_friction_at_its_feet(seed: int) -> None:
    shape, random = random_polygon(seed), np.random.default_rng(seed)
    lies, step = spread(shape), 1e-4
    velocity, turn = random.normal(size=2), random.normal() / math.sqrt(lies.gyration)
    sim = simulated(
        world([thing("crate", shape, (9.0, 9.0, 0.0), mass=2.0, floor=0.4)], size=(18.0, 18.0))
    )
    (solid,) = sim._space.bodies
    solid.velocity, solid.angular_velocity = tuple(velocity.tolist()), turn

    sim._space.step(step)

    force, torque = held(shape, velocity, turn)
    slowing = 0.4 * 9.81 * step
    assert np.array(solid.velocity) - velocity == pytest.approx(slowing * force, abs=0.02 * slowing)
    arm = math.sqrt(lies.gyration)
    turned = (solid.angular_velocity - turn) * arm
    assert turned == pytest.approx(slowing * torque / arm, abs=0.02 * slowing)


@pytest.mark.parametrize("shape", [box(0.2, 0.12), round_(0.1), box(0.2, 0.2)])
def test_feet_of_symmetric_footprints_are_symmetric(shape: Shape) -> None:
    feet = feet_of(shape, spread(shape))

    assert np.ptp(feet.shares) == pytest.approx(0.0, abs=1e-12)
    for mirror in ((1.0, -1.0), (-1.0, 1.0)):
        mirrored = feet.places * mirror
        assert sorted(mirrored.round(9).tolist()) == sorted(feet.places.round(9).tolist())


def test_points_cover_a_thin_footprint_too() -> None:
    points = points_of(box(1.0, 0.001))

    assert len(points) >= 12
    assert points.mean(axis=0) == pytest.approx((0.0, 0.0), abs=1e-12)


@given(st.lists(HEIGHTS, min_size=1, max_size=12))
def test_masks_have_a_bit_in_common_exactly_where_heights_overlap(
    heights: list[tuple[int, int]],
) -> None:
    masks = bands([(float(low), float(high)) for low, high in heights])

    for one, (low, high) in zip(masks, heights, strict=True):
        for other, (other_low, other_high) in zip(masks, heights, strict=True):
            assert bool(one & other) is (low < other_high and other_low < high)


def test_too_many_ranges_of_height_are_refused_with_a_way_out() -> None:
    with pytest.raises(ValueError, match="begin or end at the same height"):
        bands([(float(k), k + 0.5) for k in range(33)])
