"""The portrait of an arbiter: its areas are where the arbiter itself decides so."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.path import Path

from runtime.arbiter import Paradigm, Rule
from runtime.arbitration.build import arbiter_of
from runtime.user_code import Callee
from tests.verifier.deciding.arbiter_scenes import NAMES, arbiter, rule, rule_lists
from verifier.deciding.plane import Plane, axis_of, plane_of

POINTS = st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=8, max_size=8)
HELD = {"ahead": 0.33, "left": 0.72, "used": 0.58, "lamp": 1.0}


def no_code(text: str) -> Callee:
    """Nothing that is tried here runs code."""
    raise AssertionError(text)


def planes(rules: list[Rule], x: str, y: str) -> Plane:
    made = arbiter(rules)
    parts = {read.name: axis_of(read) for read in made.reads}
    held = {name: value for name, value in HELD.items() if name not in {x, y}}
    return plane_of(made, [parts[x], parts[y]], held)


def choices_at(plane: Plane, at: tuple[float, float]) -> tuple[int, ...] | None:
    """What the area says in which a point lies; None within a hair of a boundary."""
    for area in plane.areas:
        edges = np.vstack([np.stack([ring[:-1], ring[1:]], axis=1) for ring in area.rings])
        if _distance(np.array(at), edges) < 1e-7:
            return None
    found = [
        plane.rulings[area.ruling].choices
        for area in plane.areas
        if Path.make_compound_path(*(Path(r, closed=True) for r in area.rings)).contains_point(at)
    ]
    assert len(found) == 1, "areas lie side by side, and leave nothing out"
    return found[0]


def _distance(at: np.ndarray, edges: np.ndarray) -> float:
    start, way = edges[:, 0], edges[:, 1] - edges[:, 0]
    length = np.maximum((way**2).sum(axis=1), 1e-300)
    share = np.clip(((at - start) * way).sum(axis=1) / length, 0.0, 1.0)
    return float(np.hypot(*(start + share[:, None] * way - at).T).min())


def decided(rules: list[Rule], reads: list[list[float]]) -> int:
    """What the runtime's own arbiter chooses after reading so one after the other; -1: nothing."""
    made = arbiter_of(arbiter(rules), "tried", 0.1, no_code)
    made.reset(0)
    for k, each in enumerate(reads):
        numbers = made.decide(np.array(each), 0.1 * k)
    return int(np.argmax(numbers)) if numbers.max() > 0.0 else -1


@settings(max_examples=60, deadline=None)
@given(rule_lists(), POINTS, st.sampled_from([("ahead", "left"), ("left", "used")]))
def test_an_area_is_where_the_arbiter_decides_so(
    rules: list[Rule], points: list[tuple[float, float]], axes: tuple[str, str]
) -> None:
    plane = planes(rules, *axes)

    assert plane.is_exact
    assert sum(area.share for area in plane.areas) == pytest.approx(1.0, abs=1e-9)
    for point in points:
        told = choices_at(plane, point)
        if told is not None:
            reads = HELD | dict(zip(axes, point, strict=True))
            assert told == (decided(rules, [[reads[n] for n in (*NAMES, "lamp")]]),)


@settings(max_examples=40, deadline=None)
@given(rule_lists(latching=True), POINTS)
def test_a_band_holds_what_the_arbiter_chooses_there_from_wherever_it_comes(
    rules: list[Rule], points: list[tuple[float, float]]
) -> None:
    """What was read before lies anywhere; `lasts` keeps a rule longer, so it is long ago."""
    still = [Rule(each.choice, each.when, each.until, 0.0, "") for each in rules]
    plane = planes(still, "ahead", "used")
    for before, point in pairwise(points):
        told = choices_at(plane, point)
        if told is None:
            continue
        path = [[p[0], HELD["left"], p[1], HELD["lamp"]] for p in (before, point)]
        fresh = decided(still, path[1:])
        assert fresh == told[-1]
        assert decided(still, path) in told


def test_a_discrete_read_is_drawn_in_bands() -> None:
    rules = [rule(0, "lamp 1 eq ahead 0.5 lt and"), rule(1, "lamp 2 eq"), rule(2)]
    plane = planes(rules, "ahead", "lamp")

    for lamp, ahead, choice in [(0, 0.2, 2), (1, 0.2, 0), (1, 0.8, 2), (2, 0.2, 1)]:
        assert choices_at(plane, (ahead, float(lamp))) == (choice,)


def test_the_edges_of_a_box_are_where_its_numbers_are() -> None:
    plane = planes([rule(0, "ahead 0.3 lt left 0.7 gt and"), rule(1)], "ahead", "left")

    (border,) = plane.borders
    corners = {tuple(point) for point in border.points.round(12).tolist()}
    assert corners == {(0.0, 0.7), (0.3, 0.7), (0.3, 1.0)}
    assert plane.share_of(0) == pytest.approx(0.3 * 0.3, rel=1e-12)


def test_a_boundary_that_is_no_line_is_followed() -> None:
    """A disc of radius 0.4 around a corner: a quarter of pi r squared."""
    plane = planes([rule(0, "ahead left hypot 0.4 lt"), rule(1)], "ahead", "left")

    assert not plane.is_exact
    assert plane.share_of(0) == pytest.approx(np.pi * 0.4**2 / 4.0, rel=1e-4)
    assert len(plane.areas) == 2
    (border,) = plane.borders
    assert np.hypot(*border.points.T) == pytest.approx(0.4, abs=1e-4)


def test_of_weights_the_greatest_is_drawn() -> None:
    made = arbiter([], Paradigm.WEIGHTS, ("1 ahead sub", "left", "0.2"))
    parts = {read.name: axis_of(read) for read in made.reads}
    plane = plane_of(made, [parts["ahead"], parts["left"]], {})

    assert plane.is_exact
    for point, choice in [((0.1, 0.3), 0), ((0.9, 0.6), 1), ((0.95, 0.1), 2)]:
        assert choices_at(plane, point) == (choice,)
