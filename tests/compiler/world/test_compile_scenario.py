"""Worlds and scenarios from their files: geometry, time, starts, requirements."""

import math
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compiler.architecture.times import common, exact, short_step
from compiler.check import check
from compiler.world.overlap import overlap, overlap_floor, within
from compiler.world.scenario import CompiledScenario, compile_scenario
from compiler.world.windows import reach_of
from runtime.progress import in_silence
from runtime.world.model import Disc, Polygon, Pose, Shape

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"


@pytest.fixture(scope="module")
def first_light() -> CompiledScenario:
    return compile_scenario(PARTS / "first_light.yaml", in_silence, seed=3)


def scenario(tmp_path: Path, robots: str, more: str = "") -> Path:
    path = tmp_path / "tried.yaml"
    path.write_text(
        f"specc: 1\nkind: scenario\nname: tried\nworld: {PARTS}/office.yaml\n"
        f"robots: {robots}\nduration: 5 s\n{more}\n",
        encoding="utf-8",
    )
    return path


def codes(path: Path) -> list[str]:
    return [found.code for found in check(path)]


LOOKS = """
specc: 1
kind: body
name: looker
shape: {circle: 10 cm}
mass: 3 kg
drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}
sensors:
  ahead: {senses: range, reach: 2 m}
  eye: {senses: sight, of: [NAME], reach: 3 m}
"""
POLES = """
specc: 1
kind: world
name: poles
arena: {box: [4, 3]}
things:
  post_west: {shape: {circle: 5 cm}, at: [1, 2], fixed: true}
  post_east: {shape: {circle: 5 cm}, at: [3, 2], fixed: true}
scatter: {poles: {count: 2, shape: {circle: 5 cm}}}
"""


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("pole", "did you mean 'poles_*'?"),
        ("post", "did you mean 'post_west' or 'post_east'?"),
        ("post_wast", "did you mean 'post_west'?"),
        ("crate", "there are light, post_west, post_east, poles_*, r"),
    ],
)
def test_what_a_sensor_looks_for_in_vain_is_told_with_its_place_and_what_was_meant(
    tmp_path: Path, name: str, remedy: str
) -> None:
    (tmp_path / "looker.yaml").write_text(LOOKS.replace("NAME", name), encoding="utf-8")
    (tmp_path / "poles.yaml").write_text(POLES, encoding="utf-8")
    (tmp_path / "looks.yaml").write_text(
        "specc: 1\nkind: architecture\nname: looks\nbody: looker.yaml\nnodes:\n"
        f"  avoid: {{behavior: {PARTS}/avoid.yaml, period: 50 ms, "
        "sense: {clearance: {from: ahead.range, outside: clip}}}\n",
        encoding="utf-8",
    )
    path = scenario(tmp_path, "{r: {architecture: looks.yaml, at: [2, 1]}}")
    path.write_text(path.read_text("utf-8").replace(f"{PARTS}/office", "poles"), "utf-8")

    [found] = [one for one in check(path) if one.code == "S322"]
    assert found.help == remedy
    assert f"looks for '{name}' (`of` in looker.yaml:10)" in found.message


def test_the_step_is_the_longest_that_divides_every_time(first_light: CompiledScenario) -> None:
    """Periods 50 and 100 ms, sensors 50 and 20 ms: 10 ms is shared, and 1/240 s the limit."""
    found = first_light.scenario

    assert found.step == pytest.approx(1 / 300)
    for time in (0.05, 0.1, 0.02):
        assert time / found.step == pytest.approx(round(time / found.step), abs=1e-9)
    assert found.seed == 3


@given(st.lists(st.tuples(st.integers(1, 2000), st.integers(1, 1000)), min_size=1, max_size=5))
def test_what_times_share_divides_each_and_nothing_longer_does(
    ratios: list[tuple[int, int]],
) -> None:
    times = [Fraction(*ratio) for ratio in ratios]
    shared = common(times)
    counts = [time / shared for time in times]

    assert all(count.denominator == 1 for count in counts)
    assert math.gcd(*(int(count) for count in counts)) == 1


@given(st.integers(1, 2000), st.integers(1, 2000))
def test_a_time_is_read_as_the_fraction_that_was_meant(over: int, under: int) -> None:
    assert exact(over / under) == Fraction(over, under)


def test_the_world_is_in_si_with_walls_counter_clockwise(first_light: CompiledScenario) -> None:
    world = first_light.scenario.world
    desk, crate = world.things

    assert world.arena == ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0))
    assert desk.pose == Pose(1.0, 2.0, pytest.approx(math.radians(30)))
    assert desk.is_fixed
    assert crate.mass == 1.0
    assert world.lights[1].on == "crate"
    assert world.lights[1].cone == pytest.approx(math.radians(60))
    assert world.scattered[0].fixed == 0.25


SQUARE = Shape((), (Polygon(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))),))
ROUND = Shape((Disc(0.0, 0.0, 0.5),), ())
place = st.floats(-2, 2, allow_nan=False)


@given(place, place, st.floats(-4, 4))
def test_squares_overlap_where_a_fine_grid_finds_a_common_point(
    x: float, y: float, turn: float
) -> None:
    """A second way: points of a grid in one square that lie in the other, with its own margin."""
    side = np.linspace(-0.5, 0.5, 201)
    a, b = np.meshgrid(side - x, side - y, indexing="ij")
    u, v = np.cos(turn) * a + np.sin(turn) * b, np.cos(turn) * b - np.sin(turn) * a
    depth = float(np.max(0.5 - np.maximum(np.abs(u), np.abs(v))))
    found = overlap(SQUARE, Pose(0.0, 0.0, 0.0), SQUARE, Pose(x, y, turn))

    if depth > 1e-5:
        assert found
    elif depth < -0.01:
        assert not found


@given(place, place)
def test_discs_overlap_where_their_middles_are_near(x: float, y: float) -> None:
    apart = math.hypot(x, y)
    if abs(apart - 1.0) > 1e-5:
        assert overlap(ROUND, Pose(0, 0, 0), ROUND, Pose(x, y, 0)) == (apart < 1.0)


@given(place, place)
def test_a_disc_overlaps_a_square_by_its_distance(x: float, y: float) -> None:
    distance = math.hypot(max(abs(x) - 0.5, 0.0), max(abs(y) - 0.5, 0.0))
    if abs(distance - 0.5) > 1e-5:
        assert overlap(SQUARE, Pose(0, 0, 0), ROUND, Pose(x, y, 0)) == (distance < 0.5)


def test_within_means_clear_of_every_wall_of_a_room_with_a_corner() -> None:
    room = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 4.0), (2.0, 2.0), (0.0, 2.0))

    assert within(ROUND, Pose(1.0, 1.0, 0.0), room)
    assert within(ROUND, Pose(3.0, 3.0, 0.0), room)
    assert not within(ROUND, Pose(1.8, 1.8, 0.0), room)
    assert not within(ROUND, Pose(1.0, 3.0, 0.0), room)
    assert not within(ROUND, Pose(0.4, 1.0, 0.0), room)
    assert not within(SQUARE, Pose(2.4, 3.0, 0.0), room)


@given(place, place, st.floats(-4, 4))
def test_a_footprint_has_floor_where_a_fine_grid_finds_a_point_of_it_there(
    x: float, y: float, turn: float
) -> None:
    """A second way: the room is a square with a corner cut out, and points are on its floor."""
    room = ((-1.0, -1.0), (1.0, -1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 1.0), (-1.0, 1.0))
    side = np.linspace(-0.5, 0.5, 101)
    a, b = np.meshgrid(side, side, indexing="ij")
    u, v = x + np.cos(turn) * a - np.sin(turn) * b, y + np.sin(turn) * a + np.cos(turn) * b
    inner = 1.0 - np.maximum(np.abs(u), np.abs(v))
    depth = float(np.max(np.minimum(inner, np.maximum(-u, -v))))
    found = overlap_floor(SQUARE, Pose(x, y, turn), room)

    if depth > 1e-5:
        assert found
    elif depth < -0.01:
        assert not found


def test_a_footprint_as_large_as_the_room_has_floor_and_one_behind_its_wall_has_none() -> None:
    room = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))

    assert overlap_floor(SQUARE, Pose(0.0, 0.0, 0.0), room)
    assert not overlap_floor(SQUARE, Pose(1.0, 0.0, 0.0), room)


@pytest.mark.parametrize(
    ("at", "wrong"),
    [("[3, 1]", []), ("[1, 2]", ["S327"]), ("[0.05, 1]", ["S327"]), ("random", [])],
)
def test_a_start_is_free(tmp_path: Path, at: str, wrong: list[str]) -> None:
    robots = f"{{r: {{architecture: {PARTS}/find_light.yaml, at: {at}}}}}"

    assert codes(scenario(tmp_path, robots)) == wrong


def test_a_step_below_a_tenth_of_a_millisecond_is_refused(tmp_path: Path) -> None:
    robots = f"{{r: {{architecture: {PARTS}/find_light.yaml}}}}"

    assert codes(scenario(tmp_path, robots, "step: 0.01 ms")) == ["S352"]
    assert codes(scenario(tmp_path, robots, "step: 1 ms")) == []


BARE = """specc: 1
kind: body
name: bare
shape: {circle: 12 cm}
mass: 3 kg
drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}
"""
ALONE = """specc: 1
kind: architecture
name: {name}
body: bare.yaml
nodes: {{avoid: {{behavior: {parts}/avoid.yaml, period: {period}, sense: {{clearance: 1 m}}}}}}
"""


def robots_with(folder: Path, *periods: str) -> str:
    """Robots whose only node has one of the periods."""
    (folder / "bare.yaml").write_text(BARE)
    for place, period in enumerate(periods):
        text = ALONE.format(name=f"a{place}", parts=PARTS, period=period)
        (folder / f"a{place}.yaml").write_text(text)
    named = [f"r{place}: {{architecture: a{place}.yaml}}" for place in range(len(periods))]
    return f"{{{', '.join(named)}}}"


@pytest.mark.parametrize(
    ("periods", "steps"),
    [
        (("50 ms",), 0),
        (("33.3 ms",), 0),  # the step is a ninth of it
        (("33.3 ms", "50 ms"), 1),
        (("20.4 ms", "25.5 ms"), 0),  # 5.1 ms
        (("20.4 ms", "25.6 ms"), 1),  # 0.4 ms, of both together
    ],
)
def test_a_short_step_is_told_of_once_for_what_forces_it(
    tmp_path: Path, periods: tuple[str, ...], steps: int
) -> None:
    path = scenario(tmp_path, robots_with(tmp_path, *periods))

    assert codes(path).count("S355") == steps


def test_times_that_are_proposed_instead_leave_a_step_that_is_not_short() -> None:
    sensors = [Fraction(1, 10), Fraction(1, 50)]
    told = short_step([*sensors, Fraction(333, 10_000)])[1]
    proposed = [Fraction(text) / 1000 for text in re.findall(r"(\d+) ms \(a step", told)]

    assert proposed
    assert all(common([*sensors, time]) >= Fraction(1, 2000) for time in proposed)


@pytest.mark.parametrize(
    ("sentence", "reach"),
    [
        ("eventually within 5 s r.clearance > 1 m", 5.0),
        ("always r.clearance > 1 m", 0.0),
        ("always within 3 s (eventually from 1 s to 2 s r.clearance > 1 m)", 5.0),
        ("always (r.x > 1 m and eventually within 6 s r.x < 1 m)", 6.0),
        ("r.x < 1 m until within 7 s r.x > 1 m", 7.0),
        ("eventually after 8 s r.x < 1 m", 8.0),
    ],
)
def test_how_far_a_requirement_looks_ahead_is_the_sum_of_windows_in_one_another(
    tmp_path: Path, sentence: str, reach: float
) -> None:
    robots = f"{{r: {{architecture: {PARTS}/find_light.yaml, at: [3, 1]}}}}"
    path = scenario(tmp_path, robots, f"require:\n  - {sentence}\n")

    made = compile_scenario(path, in_silence)

    assert reach_of(made.scenario.requirements[0]) == pytest.approx(reach)
    assert [found.code for found in made.warnings].count("S375") == (reach > 5.0)
