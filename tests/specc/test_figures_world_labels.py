"""Words on posters: whatever a run was, no words meet a robot, a light, or other words."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from runtime.arrays import Array
from runtime.world.model import Shape
from specc.figures.footprints import outline, placed
from specc.figures.labels import Box, dense, is_within, meets_polygon
from specc.figures.moments import stops_of
from specc.figures.names import named_things
from specc.figures.palettes import PALETTES
from specc.figures.scene import Item
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.trails import fresh_since
from specc.figures.world import draw_world
from tests.specc.world_scenes import SQUARE, a_run, scene, trails

PLACES = st.floats(0.0, 10.0)
BOXES = st.builds(
    lambda x, y, w, h: Box(x, y, x + w, y + h), PLACES, PLACES, st.floats(0.1, 5), st.floats(0.1, 5)
)


def boxes_of(figure: Figure, style: Style = Style.SCREEN) -> dict[str, list[Array]]:
    """Where words on the floor are drawn: low and high corners, in pixels, by the words."""
    with look(PALETTES[style]):
        return _boxes_of(figure, FigureCanvasAgg(figure))


def _boxes_of(figure: Figure, canvas: FigureCanvasAgg) -> dict[str, list[Array]]:
    canvas.draw()
    found: dict[str, list[Array]] = {}
    for text in figure.axes[0].texts:
        if text.get_text():
            patch = text.get_bbox_patch()
            box = (patch or text).get_window_extent(canvas.get_renderer())
            found.setdefault(text.get_text(), []).append(np.array([box.min, box.max]))
    return found


def on_paper(figure: Figure, shape: Shape, pose: Array) -> list[Array]:
    axes = figure.axes[0]
    return [axes.transData.transform(placed(part, pose)) for part in outline(shape)]


@given(BOXES, BOXES)
def test_a_box_meets_another_where_it_meets_the_polygon_of_its_corners(one: Box, two: Box) -> None:
    assert one.meets(two) == meets_polygon(one, two.corners)


@given(BOXES, st.integers(3, 9), st.floats(0.5, 4.0), PLACES, PLACES)
def test_a_box_within_a_polygon_has_its_corners_there_and_meets_it(
    box: Box, count: int, radius: float, x: float, y: float
) -> None:
    turns = np.arange(count) * 2.0 * np.pi / count
    corners = np.array([x, y]) + radius * np.column_stack([np.cos(turns), np.sin(turns)])

    if is_within(box, corners):
        assert meets_polygon(box, corners)
        assert np.hypot(*(box.corners - (x, y)).T).max() <= radius + 1e-9
    if not meets_polygon(box, corners):
        shares = np.random.default_rng(count).dirichlet(np.ones(count), 200)
        assert not box.holds(shares @ corners).any()


@given(st.lists(st.tuples(PLACES, PLACES), min_size=2, max_size=8), st.floats(0.1, 3.0))
def test_a_dense_line_has_no_gaps(corners: list[tuple[float, float]], step: float) -> None:
    found = dense(np.array(corners), step)

    assert np.hypot(*np.diff(found, axis=0).T).max() <= step + 1e-9
    np.testing.assert_allclose(found[[0, -1]], np.array(corners)[[0, -1]])


@settings(max_examples=3, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.integers(0, 9))
def test_no_words_meet_a_robot_or_other_words(seed: int, robots: int, things: int) -> None:
    drawn, run = a_run(seed, robots, things)

    style = list(Style)[seed % 3]
    figure = draw_world(drawn, run, style)

    boxes = [box for same in boxes_of(figure, style).values() for box in same]
    for index, (low, high) in enumerate(boxes):
        box = Box(*low.tolist(), *high.tolist())
        for other_low, other_high in boxes[:index]:
            assert not box.meets(Box(*other_low.tolist(), *other_high.tolist()))
        for row in (0, -1):
            for item, pose in zip(drawn.robots, run.robots[row], strict=True):
                for corners in on_paper(figure, item.shape, pose):
                    assert not meets_polygon(box, corners)


def test_robots_lights_things_and_times_are_all_named() -> None:
    told = boxes_of(draw_world(scene(), trails()))

    assert {"r", "bulb", "torch", "desk", "crate"} <= set(told)
    assert {f"{t} s" for t in (2, 4, 6, 8, 10)} <= set(told)
    assert "stuck for 2 s" in told


def test_times_at_one_place_are_told_together() -> None:
    run = trails()
    still = np.where(run.times[:, None] < 5.0, 0.0, 1.0)
    poses = run.robots.copy()
    poses[:, 0, :2] = 0.5 + still
    stays = replace(run, robots=poses)

    step, stops = stops_of(stays, 0, 0.1)

    assert [stop.text(step) for stop in stops] == ["2 s to 4 s", "6 s to 10 s"]


@pytest.mark.parametrize("pushed", [0, 3, 40])
def test_of_many_things_only_those_have_names_that_are_spoken_of_or_were_pushed_farthest(
    pushed: int,
) -> None:
    things = tuple(Item(f"box_{i}", SQUARE) for i in range(80))
    poses = np.zeros((len(trails().times), 80, 3))
    poses[-1, 40 : 40 + pushed, 0] = 0.1 + 0.01 * np.arange(pushed)
    drawn = replace(scene(), things=things, spoken=frozenset({"box_7"}))

    named = named_things(drawn, replace(trails(), things=poses))

    most = min(pushed, 11)
    assert named == [7, *range(40 + pushed - most, 40 + pushed)]


@given(st.floats(1.0, 1e4), st.floats(0.05, 1.0))
def test_only_a_run_that_fills_the_floor_is_drawn_faint_in_its_first_part(
    seconds: float, speed: float
) -> None:
    times = np.linspace(0.0, seconds, 50)
    robots = np.zeros((50, 1, 3))
    robots[:, 0, 0] = speed * times
    run = replace(trails(), times=times, robots=robots)
    inked = speed * seconds * 2.2 / 100.0 / 8.0  # metres, by the line's width, of 8 m2

    since = fresh_since(scene(), run, 100.0)

    assert (since == 0.0) == (inked <= 0.22)
    assert (
        since == 0.0
        or speed * (seconds - since) * 2.2 / 100.0 / 8.0 <= 0.1 + 1e-9
        or (seconds - since == pytest.approx(0.5))
    )
