"""Rays and lines of sight, against plain answers and closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.world.kernels.parts import middle
from runtime.world.kernels.rays import cast, nearest_seen
from runtime.world.model import Disc, Pose, Shape
from runtime.world.rays import (
    NOBODY,
    View,
    first_hits,
    least_range,
    nearest_visible,
    parts_of,
    spread,
)
from tests.runtime.world.scenes import (
    ALL_ROUND,
    Part,
    box,
    fan,
    in_the_way,
    outline,
    plain_hit,
    plain_parts,
    plan_of,
    random_plan,
)

SEEDS = st.integers(0, 2**32)


@given(SEEDS, st.integers(0, 12))
@settings(max_examples=30, deadline=None)
def test_rays_hit_what_plain_geometry_says(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    geometry = random_plan(rng, count).geometry
    turns = rng.uniform(-4.0, 4.0, 8)
    rays = np.column_stack([rng.uniform(0.0, 4.0, (8, 2)), np.cos(turns), np.sin(turns)])
    height, skip = float(rng.uniform(0.0, 0.6)), int(rng.integers(-1, count + 1))
    plain = plain_parts(geometry)

    found = first_hits(parts_of(geometry), rays, reach=3.0, height=height, skip=skip)

    for ray, distance, owner in zip(rays, *found, strict=True):
        expected, whose = plain_hit(plain, ray, 3.0, height, skip)
        assert distance == pytest.approx(expected, abs=1e-9)
        if 0.0 < expected < 3.0:
            assert owner == whose


@given(SEEDS, st.integers(0, 10))
@settings(max_examples=30, deadline=None)
def test_the_nearest_that_nothing_hides_is_seen(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    geometry = random_plan(rng, count).geometry
    plain, robot = plain_parts(geometry), count
    targets, owners = rng.uniform(0.0, 4.0, (6, 3)), rng.integers(-1, count + 1, 6)
    targets[:, 2] *= 0.1
    eye, heading, width = rng.uniform(0.0, 3.0, 3) * [1, 1, 0.1], rng.uniform(-4, 4), 4.0
    view = View(math.cos(heading), math.sin(heading), math.cos(0.5 * width), 2.0)

    found, distance = nearest_visible(
        *(parts_of(geometry), tuple(eye.tolist()), view, targets, owners.astype(np.int64)),
        skip=robot,
    )

    seen = {
        row: float(np.hypot(*(target - eye)[:2]))
        for row, target in enumerate(targets)
        if abs(_bearing(eye, target, heading)) <= 0.5 * width
        and not any(
            in_the_way(part, eye, target)
            for part in plain
            if part.owner not in (robot, owners[row])
        )
    }
    near = {row: away for row, away in seen.items() if away <= 2.0}
    assert found == (min(near, key=near.__getitem__) if near else -1)
    assert distance == pytest.approx(min(near.values(), default=2.0))


def _bearing(eye: np.ndarray, target: np.ndarray, heading: float) -> float:
    dx, dy = (target - eye)[:2]
    return math.remainder(math.atan2(dy, dx) - heading, 2.0 * math.pi)


def test_distances_to_a_wall_and_a_circle_are_those_of_the_closed_form() -> None:
    round_ = Shape((Disc(0.0, 0.0, 0.5),), ())
    parts = parts_of(plan_of(outline("pillar", round_, Pose(3.0, 1.0, 0.0))).geometry)
    away = 1.0 / math.sqrt(0.5)

    straight, pillar = first_hits(
        parts, fan(1, 1, 0, spread(0, 1)), reach=9.0, height=0.1, skip=NOBODY
    )
    around, walls = first_hits(
        parts, fan(1, 1, 0, spread(ALL_ROUND, 4)), reach=9.0, height=0.1, skip=0
    )

    assert (straight[0], pillar[0]) == (1.5, 0)
    # The rays of a full circle lie to both sides of straight ahead.
    assert around == pytest.approx([away, away, 3 * away, away])
    assert set(walls.tolist()) == {1}


def test_a_fan_spreads_over_its_width_and_looks_straight_ahead_with_one_ray() -> None:
    turns = np.arctan2(*fan(0.0, 0.0, 0.5, spread(1.0, 5))[:, [3, 2]].T)

    assert turns == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    assert np.arctan2(*fan(0.0, 0.0, 0.5, spread(1.0, 1))[0, [3, 2]]) == pytest.approx(0.5)


def test_rays_pass_over_what_is_lower_and_below_what_hangs() -> None:
    low = outline("low", box(0.2, 2.0), Pose(2.0, 2.0, 0.0), (0.0, 0.1))
    hanging = outline("hanging", box(0.2, 2.0), Pose(3.0, 2.0, 0.0), (0.2, 0.5))
    parts = parts_of(plan_of(low, hanging).geometry)

    def reached(height: float) -> float:
        hit = first_hits(parts, fan(1, 2, 0, spread(0, 1)), reach=9.0, height=height, skip=NOBODY)
        return float(hit[0][0])

    assert reached(0.0) == pytest.approx(0.9)
    assert reached(0.1) == reached(0.2) == pytest.approx(3.0)  # what is just touched does not count
    assert reached(0.3) == pytest.approx(1.9)


def test_a_ray_that_begins_inside_something_has_no_way_to_go() -> None:
    parts = parts_of(plan_of(outline("crate", box(1.0, 1.0), Pose(2.0, 2.0, 0.4))).geometry)

    distances, owners = first_hits(
        parts, fan(2.1, 2.0, 0.0, spread(6.0, 7)), reach=2.0, height=0.1, skip=NOBODY
    )

    assert (distances == 0.0).all()
    assert (owners == 0).all()


def test_no_ray_leaves_through_a_corner_of_the_arena() -> None:
    parts = parts_of(plan_of().geometry)
    x, y = 1.234567, 3.210987
    corners = [math.atan2(b - y, a - x) for a in (0.0, 4.0) for b in (0.0, 4.0)]
    near = [np.nextafter(turn, turn + sign) for turn in corners for sign in (-1, 0, 1)]
    rays = np.array([(x, y, math.cos(turn), math.sin(turn)) for turn in near])

    distances, _ = first_hits(parts, rays, reach=100.0, height=0.1, skip=NOBODY)

    assert distances.max() < 6.0


def test_turning_and_moving_a_scene_with_its_rays_changes_no_distance() -> None:
    rng = np.random.default_rng(5)
    plan = random_plan(rng, 10)
    rays = fan(1.7, 1.9, 0.3, spread(ALL_ROUND, 40))
    parts = parts_of(plan.geometry)
    walls = plan.geometry.things + plan.geometry.robots
    before, _ = first_hits(parts, rays, reach=3.0, height=0.1, skip=walls)

    turn, dx, dy = 0.7, 5.0, -2.0
    matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    poses = plan.geometry.poses[:-1].copy()
    poses[:, :2] = poses[:, :2] @ matrix.T + (dx, dy)
    poses[:, 2] += turn
    plan.place(poses, 1)
    rays[:, :2] = rays[:, :2] @ matrix.T + (dx, dy)
    rays[:, 2:] = rays[:, 2:] @ matrix.T

    after, _ = first_hits(parts, rays, reach=3.0, height=0.1, skip=walls)
    assert after == pytest.approx(before, abs=1e-9)


def test_parts_stand_in_the_order_of_their_owners() -> None:
    geometry = random_plan(np.random.default_rng(8), 12).geometry
    parts = parts_of(geometry)

    assert (np.diff(parts.rows[:, 2]) >= 0).all()
    assert len(parts.rows) == len(set(geometry.part.tolist()))
    assert parts.rows[:, 1].sum() == len(geometry.segments)
    assert (parts.rows[:, 1] == 0).sum() == len(geometry.discs)


@given(SEEDS)
@settings(max_examples=20, deadline=None)
def test_circles_hold_their_parts_wherever_those_move(seed: int) -> None:
    rng = np.random.default_rng(seed)
    plan = random_plan(rng, 6)
    parts = parts_of(plan.geometry)
    plan.place(plan.geometry.poses[:-1] + rng.normal(0.0, 1.0, (7, 3)), 1)

    for (first, count, *_), radius, row in zip(parts.rows, parts.radius, range(99), strict=False):
        if count:
            edges = parts.segments[first : first + count]
            away = edges[:, :2] - middle.py_func(parts, row)  # type: ignore[attr-defined]
            assert np.hypot(*away.T).max() <= radius


def test_the_least_range_is_the_least_of_the_rays() -> None:
    geometry = random_plan(np.random.default_rng(8), 12).geometry
    parts, turns = parts_of(geometry), spread(2.0, 7)
    distances, _ = first_hits(parts, fan(1, 1, 0.4, turns), reach=3.0, height=0.1, skip=2)

    found = least_range(parts, (1.0, 1.0, 0.4), turns, reach=3.0, height=0.1, skip=2)

    assert found == pytest.approx(distances.min(), abs=1e-12)


def test_each_kernel_is_compiled_for_one_kind_of_arguments() -> None:
    geometry = random_plan(np.random.default_rng(8), 3).geometry
    first_hits(parts_of(geometry), fan(1, 1, 0, spread(1, 3)), reach=1.0, height=0.1, skip=0)

    assert [len(kernel.signatures) for kernel in (cast, nearest_seen)] == [1, 1]  # type: ignore[attr-defined]


def test_the_plain_answer_itself_knows_inside_from_outside() -> None:
    square = Part(
        0, np.array([(0, 0, 1, 0), (1, 0, 1, 1), (1, 1, 0, 1), (0, 1, 0, 0.0)]), None, 0, 1, 0
    )

    assert square.holds(np.array([0.5, 0.5]))
    assert not square.holds(np.array([1.5, 0.5]))
    assert list(square.pieces(np.array([-1.0, 0.5]), np.array([1.0, 0.5]))) == [(0.5, 1.0)]
