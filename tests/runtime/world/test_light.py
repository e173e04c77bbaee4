"""Light at a place and on the floor, against plain answers and closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from runtime.world.geometry import Geometry, Plan
from runtime.world.light import LightMap, Sources, light_at
from runtime.world.model import Disc, Light, Polygon, Pose, Shape
from runtime.world.rays import NOBODY, View, half_cosine, parts_of
from tests.runtime.world.scenes import (
    box,
    lamp,
    outline,
    plain_lux,
    plain_parts,
    plan_of,
    pose,
    random_lights,
    random_plan,
    sources_of,
)

SEEDS = st.integers(0, 2**32)
SMALL = (13, 11)


def lux(geometry: Geometry, light: Light, x: float, y: float, height: float = 0.0) -> float:
    return light_at(parts_of(geometry), sources_of(geometry, light), (x, y, height))


def map_of(plan: Plan, *lights: Light, cells: tuple[int, int] = SMALL) -> LightMap:
    geometry = plan.geometry
    sources = Sources(lights, geometry)
    return LightMap(parts_of(geometry), sources, (0.0, 0.0, 4.0, 4.0), cells, 0.0)


@given(SEEDS, st.integers(0, 10))
@settings(max_examples=30, deadline=None)
def test_a_meter_says_what_plain_geometry_says(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    geometry = random_plan(rng, count).geometry
    rows = sources_of(geometry, *random_lights(rng, 3, count))
    x, y, height = rng.uniform(0.0, (4.0, 4.0, 0.2)).tolist()
    heading, width, skip = float(rng.uniform(-4, 4)), float(rng.uniform(0.5, 6)), count
    view = View(math.cos(heading), math.sin(heading), half_cosine(width), 0.0)

    found = light_at(parts_of(geometry), rows, (x, y, height), skip=skip)
    ahead = light_at(parts_of(geometry), rows, (x, y, height), view=view, skip=skip)

    plain = plain_parts(geometry)
    assert found == pytest.approx(
        plain_lux(plain, rows, np.array([x, y, height]), skip, None), rel=1e-9, abs=1e-12
    )
    expected = plain_lux(plain, rows, np.array([x, y, height]), skip, (heading, width))
    assert ahead == pytest.approx(expected, rel=1e-9, abs=1e-12)


@given(SEEDS, st.integers(0, 10))
@settings(max_examples=40, deadline=None)
def test_the_map_says_what_a_meter_on_the_floor_says(seed: int, count: int) -> None:
    """Half-planes of shadows against what stands in the way of each cell's own ray."""
    rng = np.random.default_rng(seed)
    plan = random_plan(rng, count)
    lights = random_lights(rng, 3, count)

    found = map_of(plan, *lights)

    parts, rows = parts_of(plan.geometry), sources_of(plan.geometry, *lights)
    expected = [
        [light_at(parts, rows, (x, y, 0.0)) for x in found.xs.tolist()] for y in found.ys.tolist()
    ]
    assert found.lux == pytest.approx(np.array(expected), rel=1e-9, abs=1e-12)


def test_light_falls_with_the_square_of_the_distance_and_the_cosine() -> None:
    empty = plan_of().geometry

    below = [lux(empty, lamp(2.0, 2.0, height, 10.0), 2.0, 2.0) for height in (0.5, 1.0, 2.0)]
    beside = lux(empty, lamp(1.0, 1.0, 0.3, 10.0), 1.4, 1.0)

    assert below == pytest.approx([40.0, 10.0, 2.5])
    assert beside == pytest.approx(10.0 * (0.3 / 0.5) / 0.5**2)


def test_a_meter_as_high_as_a_light_or_higher_sees_none_of_it() -> None:
    empty = plan_of().geometry

    heights = (0.2, 0.3, 0.4)
    assert [lux(empty, lamp(1, 1, 0.3, 9.0), 1.4, 1.0, z) > 0.0 for z in heights] == [1, 0, 0]


def test_transmittances_along_the_way_are_multiplied_once_for_each_thing() -> None:
    panes = [
        outline("a", box(0.1, 1.0), Pose(1.5, 2.0, 0.0), (0.0, 2.0), 0.5),
        outline("b", box(0.1, 1.0), Pose(2.0, 2.0, 0.3), (0.0, 2.0), 0.3),
    ]
    halves = Shape(
        (),
        (
            Polygon(((-0.05, -0.5), (0.0, -0.5), (0.0, 0.5), (-0.05, 0.5))),
            Polygon(((0.0, -0.5), (0.05, -0.5), (0.05, 0.5), (0.0, 0.5))),
        ),
    )
    light = lamp(1.0, 2.0, 0.5, 10.0)
    clear = lux(plan_of().geometry, light, 3.0, 2.0)

    both = lux(plan_of(*panes).geometry, light, 3.0, 2.0)
    cut = plan_of(outline("a", halves, Pose(1.5, 2.0, 0.0), (0.0, 2.0), 0.5))

    assert both == pytest.approx(0.15 * clear)
    assert lux(cut.geometry, light, 3.0, 2.0) == pytest.approx(0.5 * clear)
    whole = map_of(plan_of(panes[0]), light, cells=(80, 80)).lux
    assert map_of(cut, light, cells=(80, 80)).lux == pytest.approx(whole)


@pytest.mark.parametrize("high", [0.1, 0.2, 0.35])
def test_the_shadow_of_a_box_is_as_long_as_similar_triangles_say(high: float) -> None:
    """From the edge at distance d the shadow ends at d h / (h - high)."""
    height, edge = 0.5, 0.7
    plan = plan_of(outline("box", box(0.2, 0.4), Pose(1.0 + edge - 0.1, 2.0, 0.0), (0.0, high)))
    end = 1.0 + edge * height / (height - high)

    def is_dark(x: float) -> bool:
        return lux(plan.geometry, lamp(1.0, 2.0, height, 10.0), x, 2.0) == 0.0

    assert is_dark(1.51)
    assert is_dark(end - 1e-6)
    assert not is_dark(end + 1e-6)
    assert not is_dark(1.49)
    row = map_of(plan, lamp(1.0, 2.0, height, 10.0), cells=(400, 401)).lux[200]
    dark = np.flatnonzero(row == 0.0) * 0.01 + 0.005
    assert (dark.min(), dark.max()) == pytest.approx((1.5, end), abs=0.01)  # the width of a cell


def test_below_what_hangs_a_shadow_begins_later() -> None:
    """A shelf from 0.2 m to 0.3 m, 0.4 m to 0.6 m away from a light 0.5 m high."""
    plan = plan_of(outline("shelf", box(0.2, 1.0), Pose(1.5, 2.0, 0.0), (0.2, 0.3)))

    def is_dark(x: float) -> bool:
        return lux(plan.geometry, lamp(1.0, 2.0, 0.5, 10.0), x, 2.0) == 0.0

    first, last = 1.0 + 0.4 / (1 - 0.2 / 0.5), 1.0 + 0.6 / (1 - 0.3 / 0.5)
    assert [is_dark(x) for x in (first - 1e-6, first + 1e-6, last - 1e-6, last + 1e-6)] == [
        0,
        1,
        1,
        0,
    ]


def test_a_cone_lights_what_is_within_half_its_width_of_its_direction() -> None:
    empty = plan_of().geometry
    light = lamp(2.0, 2.0, 0.5, 10.0, cone=1.0, heading=0.4)

    def is_lit(turn: float) -> bool:
        return lux(empty, light, 2.0 + math.cos(turn), 2.0 + math.sin(turn)) > 0.0

    assert [is_lit(turn) for turn in (-0.11, -0.09, 0.4, 0.89, 0.91, 3.5)] == [0, 1, 1, 1, 0, 0]
    assert lux(empty, light, 2.0, 2.0) > 0.0


def test_a_light_is_carried_along_and_its_carrier_does_not_shade_it() -> None:
    crate = outline("crate", box(0.4, 0.4), Pose(1.0, 1.0, 0.0), (0.0, 0.3))
    plan = plan_of(crate)
    torch = Light("torch", "crate", Pose(0.2, 0.0, 0.0), 0.2, 10.0, 2.0, "")
    sources = Sources([torch], plan.geometry)

    plan.place(np.array([[2.0, 2.0, 0.5 * math.pi]]), 1)
    sources.place()

    assert sources.rows[0, :2] == pytest.approx([2.0, 2.2])
    parts = parts_of(plan.geometry)
    assert light_at(parts, sources.rows, (2.0, 3.0, 0.0)) > 0.0
    assert light_at(parts, sources.rows, (2.0, 1.0, 0.0)) == 0.0


def test_a_wall_of_a_bent_arena_keeps_the_light_out() -> None:
    arena = np.array([(0, 0), (4, 0), (4, 4), (2.5, 4), (2.5, 2.5), (0, 2.5)], dtype=np.float64)
    plan = Plan((), (), arena)
    light = lamp(1.0, 2.0, 5.0, 10.0)

    assert lux(plan.geometry, light, 3.5, 3.9) == 0.0
    assert lux(plan.geometry, light, 2.9, 2.6) > 0.0


def test_a_round_thing_without_a_top_throws_a_shadow_without_end() -> None:
    pillar = outline("pillar", Shape((Disc(0.0, 0.0, 0.2),), ()), Pose(1.0, 1.0, 0.0), (0.0, 9.0))
    light = lamp(0.5, 1.0, 0.5, 10.0)
    half = math.asin(0.2 / 0.5)

    found = map_of(plan_of(pillar), light, cells=(100, 100))

    turns = np.arctan2(found.ys[:, None] - 1.0, found.xs[None, :] - 0.5)
    beyond = np.hypot(found.ys[:, None] - 1.0, found.xs[None, :] - 0.5) > 0.7
    dark = found.lux == 0.0
    assert dark[beyond & (np.abs(turns) < half)].all()
    assert not dark[np.abs(turns) > half].any()


@pytest.mark.parametrize("seed", range(4))
def test_a_map_brought_up_to_date_is_the_map_made_anew_bit_for_bit(seed: int) -> None:
    """50 random moves for each seed: of one thing or several, near and far, with their lights."""
    rng = np.random.default_rng(seed)
    plan = random_plan(rng, 14)
    lights = random_lights(rng, 4, 14)
    cells = (40, 30)
    kept = map_of(plan, *lights, cells=cells)
    less = 0
    for step in range(1, 51):
        poses = plan.geometry.poses[:-1].copy()
        for owner in rng.choice(len(poses), int(rng.integers(0, 4)), replace=False):
            if rng.integers(2):
                poses[owner] += rng.normal(0.0, 0.02, 3)
            else:
                at = pose(rng)
                poses[owner] = at.x, at.y, at.heading
        plan.place(poses, step)
        kept.update()

        made = map_of(plan, *lights, cells=cells)
        assert kept.lux.tobytes() == made.lux.tobytes()
        less += kept.worked < made.worked
    assert less > 40


def test_the_map_is_left_alone_where_nothing_moved() -> None:
    rng = np.random.default_rng(1)
    kept = map_of(random_plan(rng, 6), *random_lights(rng, 3, 0))
    assert kept.worked == 3 * SMALL[0] * SMALL[1]

    kept.update()

    assert kept.worked == 0


def test_light_meets_no_end_where_there_are_no_lights() -> None:
    geometry = plan_of().geometry
    dark = LightMap(parts_of(geometry), Sources((), geometry), (0.0, 0.0, 4.0, 4.0), SMALL, 3.0)

    assert (dark.lux == 3.0).all()
    nothing: Array = np.zeros((0, 8))
    assert light_at(parts_of(geometry), nothing, (0.0, 0.0, 0.0), skip=NOBODY) == 0.0
