"""Cycles through modes: period laws, closed forms, an independent return map, chattering."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compiler.compile_file import compile_file
from runtime.arrays import Array
from runtime.program import Program
from tests.verifier.hybrid_scenes import (
    bouncing_ball,
    carousel,
    crank,
    docking,
    relay,
    slanted,
    spinning,
    switching,
    thermostat,
    toggled,
)
from tests.verifier.topology_scenes import state
from verifier.topology.features import Cycle, PointKind, Stability
from verifier.topology.hybrid.cycles import find_hybrid_cycles
from verifier.topology.hybrid.flow import Hybrid, hybrid_of, leaves_at
from verifier.topology.portrait import Detail, portrait
from verifier.topology.slices import cut

SPECS = Path(__file__).parents[2] / "specs"
PERIOD = 1e-6  # relative; what the issue asks for, and far above the integration's error


def compiled(name: str) -> Program:
    return compile_file(SPECS / f"{name}.yaml", lambda _what, _done, _of: None).program


PATROL = compiled("patrol")
TURNING = compiled("patrol_turning")


def hybrid(program: Program, held: dict[str, float] | None = None) -> Hybrid:
    found = hybrid_of(cut(program, None, held or {}))
    assert found is not None
    return found


def cycles(program: Program, held: dict[str, float] | None = None) -> tuple[Cycle, ...]:
    return find_hybrid_cycles(hybrid(program, held))[0]


def controls(program: Program) -> st.SearchStrategy[dict[str, float]]:
    """Values of all controls, anywhere in their domains."""
    return st.fixed_dictionaries({c.name: st.floats(c.low, c.high) for c in program.controls})


@settings(max_examples=15, deadline=None)
@given(controls(PATROL))
def test_the_patrol_takes_its_two_ways_at_their_speeds(u: dict[str, float]) -> None:
    [cycle] = cycles(PATROL, u)

    way = u["x1"] - u["x2"]
    assert cycle.period == pytest.approx(way / u["v1"] + way / u["v2"], rel=PERIOD)
    assert cycle.stability is Stability.STABLE
    assert not cycle.doubtful


@settings(max_examples=15, deadline=None)
@given(controls(TURNING))
def test_turning_at_constant_acceleration_takes_what_theory_says(u: dict[str, float]) -> None:
    [cycle] = cycles(TURNING, u)

    way, sum_ = u["x1"] - u["x2"], u["v1"] + u["v2"]
    turns = sum_**3 / (2.0 * u["a"] * u["v1"] * u["v2"])
    assert cycle.period == pytest.approx(way / u["v1"] + way / u["v2"] + turns, rel=PERIOD)
    # It stops after v1²/(2 a), and the picture's points pass within a sample of that place.
    farthest = u["x1"] + u["v1"] ** 2 / (2.0 * u["a"])
    assert cycle.points[:, 0].max() == pytest.approx(farthest, abs=0.02)
    assert set(cycle.modes) == {0, 1, 2, 3}


def test_the_patrol_of_the_thesis_is_a_rectangle() -> None:
    [cycle] = cycles(PATROL, {"x1": 1.0, "x2": -1.2, "v1": 0.6, "v2": 0.3})

    jumps = np.flatnonzero(np.diff(cycle.times) == 0.0)
    corners = {tuple(np.round(cycle.points[i + side], 9)) for i in jumps for side in (0, 1)}
    assert corners == {(1.0, 0.6), (1.0, -0.3), (-1.2, -0.3), (-1.2, 0.6)}
    np.testing.assert_array_equal(cycle.points[0], cycle.points[-1])


@given(st.floats(0.1, 0.8), st.floats(0.0, 1.0), st.floats(-0.6, 0.6))
@settings(max_examples=10, deadline=None)
def test_a_multiplier_is_that_of_the_return_map(keep: float, settle: float, lift: float) -> None:
    [cycle] = cycles(carousel(f"{keep!r} y mul {lift!r} add", settle))

    factor = keep * math.exp(-2.0 * settle)
    assert cycle.period == pytest.approx(2.0, rel=1e-9)
    assert cycle.multipliers[0] == pytest.approx(factor, abs=1e-6)
    assert cycle.cross_checked[0] == pytest.approx(factor, abs=1e-6)
    starts = cycle.points[np.isclose(cycle.points[:, 0], -1.0), 1]
    np.testing.assert_allclose(starts, lift / (1.0 - factor), atol=1e-7)


def test_a_cycle_that_repels_is_found_between_its_neighbours() -> None:
    [cycle] = cycles(carousel("2 y mul 0.5 sub"))

    assert cycle.stability is Stability.UNSTABLE
    assert cycle.multipliers[0] == pytest.approx(2.0, abs=1e-5)
    np.testing.assert_allclose(cycle.points[:, 1], 0.5, atol=1e-7)


def test_a_round_may_take_two_turns() -> None:
    """y jumps by the logistic map with r = 3.2: its fixed point repels, its 2-cycle attracts."""
    r = 3.2
    once, twice = cycles(carousel(f"{r} y mul 1 y sub mul"))[-2:]

    root = math.sqrt((r + 1.0) * (r - 3.0))
    pair = [(r + 1.0 - root) / (2.0 * r), (r + 1.0 + root) / (2.0 * r)]
    assert (once.period, twice.period) == pytest.approx((2.0, 4.0))
    assert (once.stability, twice.stability) == (Stability.UNSTABLE, Stability.STABLE)
    assert sorted(set(np.round(twice.points[:, 1], 7))) == pytest.approx(pair, abs=1e-6)
    assert twice.multipliers[0] == pytest.approx(4.0 + 2.0 * r - r * r, abs=1e-4)


@pytest.mark.parametrize(("keep", "lift"), [(0.9, 0.5), (-1.5, 1.0), (4.0, -1.0)])
def test_a_slanted_guard_against_an_independent_return_map(keep: float, lift: float) -> None:
    def leaves(y: float) -> float:
        """The time at which -1 + t + y exp(-t/2)/4 reaches 1."""
        return float(brentq(lambda t: t - 2.0 + 0.25 * y * math.exp(-0.5 * t), 0.0, 9.0))

    def again(y: float) -> float:
        return keep * y * math.exp(-0.5 * leaves(y)) + lift

    y = float(brentq(lambda y: again(y) - y, -3.0, 3.0))
    slope = (again(y + 1e-5) - again(y - 1e-5)) / 2e-5

    [cycle] = cycles(slanted(keep, lift))

    assert cycle.period == pytest.approx(1.5 * leaves(y), rel=1e-9)
    assert cycle.multipliers[0] == pytest.approx(slope, abs=1e-6)
    assert cycle.cross_checked[0] == pytest.approx(slope, abs=1e-6)
    assert not cycle.doubtful


def test_a_cycle_round_a_periodic_axis_against_an_independent_integration() -> None:
    def until(speed: float, start: Array, sign: float) -> tuple[float, Array]:
        """When sign * sin(angle) rises to 0.5, and the state there."""

        def field(_t: float, y: Array) -> Array:
            return np.array([y[1], speed - y[1]])

        def crossed(_t: float, y: Array) -> float:
            return sign * math.sin(y[0]) - 0.5

        crossed.direction = 1.0  # type: ignore[attr-defined]  # as scipy asks
        ran = solve_ivp(field, (0.0, 9.0), start, "DOP853", events=crossed, rtol=1e-11, atol=1e-12)
        assert ran.t_events is not None
        assert ran.y_events is not None
        return float(ran.t_events[0][0]), np.array(ran.y_events[0][0])

    state, turn = np.array([0.0, 2.0]), 0.0
    for _ in range(12):
        first, state = until(1.0, state, 1.0)
        second, state = until(3.0, state, -1.0)
        turn = first + second

    [cycle] = cycles(crank())

    assert cycle.period == pytest.approx(turn, rel=1e-9)
    assert cycle.turns == (1, 0)
    assert cycle.points[-1, 0] - cycle.points[0, 0] == pytest.approx(2.0 * math.pi)
    assert not cycle.doubtful


def half_turn(rate: float, goal: float) -> tuple[float, float]:
    """How long half a turn takes while rate' = goal - rate, and the rate then; closed form."""

    def angle(t: float) -> float:
        return goal * t + (rate - goal) * (1.0 - math.exp(-t))

    time = brentq(lambda t: angle(t) - math.pi, 0.0, 10.0, xtol=1e-14)
    return time, goal + (rate - goal) * math.exp(-time)


def test_a_cycle_beside_a_continuum_of_closed_ways_is_found() -> None:
    """Below 1/2 the jump leaves y as it is, above it leads towards 1."""
    jump = "y 0.5 gt y 1 sub 0.3 mul 1 add y where"

    [cycle], [note], _ = find_hybrid_cycles(hybrid(carousel(jump)))

    assert cycle.points[:, 1] == pytest.approx(1.0, abs=1e-6)
    assert cycle.multipliers[0].real == pytest.approx(0.3)
    assert "close wherever they begin" in note


def test_orbits_of_three_turns_have_the_multipliers_of_their_map() -> None:
    a = 3.83
    found = cycles(carousel(f"{a} y mul 1 y sub mul"))

    thrice = [cycle for cycle in found if cycle.period == pytest.approx(6.0)]
    assert thrice
    for cycle in thrice:
        ys = np.interp([0.9, 2.9, 4.9], cycle.times, cycle.points[:, 1])
        value = np.prod(a * (1.0 - 2.0 * ys))
        assert cycle.multipliers[0].real == pytest.approx(value, rel=1e-3)
        assert not cycle.doubtful


@pytest.mark.parametrize("turned", [0.3, 0.0, math.pi, math.pi - 1e-9])
def test_modes_without_a_gap_between_them_have_one_cycle_also_on_the_seam(turned: float) -> None:
    def turn(rate: float) -> tuple[float, float]:
        fast, middle = half_turn(rate, 3.0)
        slow, last = half_turn(middle, 1.0)
        return fast + slow, last

    rate = brentq(lambda r: turn(r)[1] - r, 0.5, 3.5, xtol=1e-14)

    [cycle] = cycles(toggled(turned))

    assert cycle.period == pytest.approx(turn(rate)[0], rel=1e-9)
    slope = (turn(rate + 1e-5)[1] - turn(rate - 1e-5)[1]) / 2e-5
    for [value] in (cycle.multipliers, cycle.cross_checked):
        assert value == pytest.approx(slope, rel=1e-5)
    assert (cycle.turns, cycle.doubtful) == ((1, 0), False)


@given(st.floats(0.3, 1.2), st.floats(1.4, 2.7))
@settings(max_examples=10, deadline=None)
def test_a_thermostat_swings_between_its_limits(low: float, high: float) -> None:
    [cycle] = cycles(thermostat(low, high))

    warming = math.log((3.0 - low) / (3.0 - high))
    assert cycle.period == pytest.approx(math.log(high / low) + warming, rel=1e-9)
    assert (cycle.points.min(), cycle.points.max()) == pytest.approx((low, high))
    assert cycle.multipliers == ()
    assert cycle.stability is Stability.STABLE


def test_switching_without_end_is_said_with_its_place() -> None:
    found, [note], _ = find_hybrid_cycles(hybrid(thermostat(1.5, 1.5)))

    assert found == ()
    assert "chattering: 100 %" in note
    assert "between 'off' and 'on' (T = 1.5)" in note


def test_a_bouncing_ball_comes_to_rest_by_chattering() -> None:
    found, notes, rests = find_hybrid_cycles(hybrid(bouncing_ball(0.6)))

    assert found == ()
    assert any("switch without end of 'flight' (h = " in note for note in notes)
    assert any("leave the domain" in note for note in notes)
    [place] = rests
    assert place == pytest.approx([0.0, 0.0], abs=1e-6)


def test_a_cycle_jumps_only_where_a_mode_is_left_and_closes_after_the_jump() -> None:
    [cycle] = portrait(PATROL, held={"x1": 1.0}).cycles
    steps = np.abs(np.diff(cycle.points, axis=0)) / [4.0, 2.0]
    jumps = np.flatnonzero(steps.max(axis=-1) > 0.1)

    assert len(jumps) == 2
    assert np.diff(cycle.times)[jumps] == pytest.approx(0.0, abs=1e-9)
    assert [cycle.modes[k] != cycle.modes[k + 1] for k in jumps] == [True, True]
    assert sum(a != b for a, b in pairwise(cycle.modes)) == 2
    np.testing.assert_allclose(cycle.points[-1], cycle.points[0], atol=1e-9)


def test_a_zero_of_a_mode_that_is_left_before_is_no_fixed_point() -> None:
    found = portrait(relay(), held={"mode": 0.0})

    assert found.fixed_points == ()
    assert any("although the field of 'up' is zero there" in note for note in found.notes)
    [cycle] = found.cycles
    assert cycle.period == pytest.approx(2.0 * math.log(3.0), rel=1e-9)


def test_a_portrait_shows_where_its_mode_is_left_and_paths_through_all_modes() -> None:
    found = portrait(PATROL, held={"x1": 1.0})

    [line] = found.switching
    assert (line.mode, line.target) == ("forward", "back")
    np.testing.assert_allclose(line.lines[0][:, 0], 1.0, atol=1e-9)
    [cycle] = found.cycles
    assert set(cycle.modes) == {0, 1}
    assert found.trajectories
    for path in found.trajectories:
        assert np.all(np.diff(path.times) >= 0.0)
        assert path.points[:, 0].max() <= 1.0 + 1e-9
    assert any("going = 'forward'" in note for note in found.notes)


def test_rest_in_a_later_mode_attracts_from_the_first() -> None:
    found = portrait(docking(), held={"mode": 0.0}, detail=Detail(basins=40))

    [point] = found.fixed_points
    assert point.kind is PointKind.STABLE_NODE
    np.testing.assert_allclose(point.at, [1.5, 0.0], atol=1e-9)
    assert any("the stable node at x = 1.5, y = 0 is one of 'dock'" in n for n in found.notes)
    assert found.basins is not None
    assert [attractor.share for attractor in found.basins.attractors] == [1.0]


def test_a_cycle_of_a_mode_that_is_not_left_is_one_of_the_behavior() -> None:
    found = portrait(spinning(), held={"mode": 0.0}, detail=Detail(basins=20))

    [cycle] = found.cycles
    assert cycle.period == pytest.approx(2.0 * math.pi, rel=1e-8)
    assert set(cycle.modes) == {1}
    # The zero of the first mode is left; that of the second repels.
    [point] = found.fixed_points
    assert point.kind is PointKind.UNSTABLE_FOCUS
    assert found.basins is not None
    assert found.basins.attractors[-1].share == 1.0


@pytest.mark.parametrize("program", [PATROL, TURNING])
def test_nearly_everything_comes_to_the_patrol(program: Program) -> None:
    basins = portrait(program, detail=Detail(basins=40)).basins

    assert basins is not None
    [attractor] = basins.attractors
    assert attractor.share > 0.97
    # What starts near the edge and goes fast towards it can't be stopped in time.
    assert attractor.share + basins.leaves == pytest.approx(1.0)


def test_cells_fill_the_domain_also_where_more_are_asked_for_than_are_made() -> None:
    program = switching(
        (state("x", 0.0, 3.0),),
        {"off": ("1 x sub",), "on": ("x neg",)},
        (("off", "on", "x 2 sub", {}),),
    )

    basins = portrait(program, detail=Detail(basins=10_000, cycles=False)).basins

    assert basins is not None
    [centres] = basins.centres
    assert centres[0] == pytest.approx(3.0 - centres[-1])
    [rests, decays] = basins.attractors
    assert (rests.share, decays.share) == pytest.approx((2.0 / 3.0, 1.0 / 3.0), abs=1e-3)


def test_no_modes_no_hybrid() -> None:
    view = cut(compiled("pendulum"), None, {})

    assert hybrid_of(view) is None


def test_a_mode_is_left_exactly_where_its_guard_is_open() -> None:
    found = hybrid(PATROL, {"x1": 1.0})
    points = np.array([[0.999, 0.3], [1.0, 0.3], [1.5, -0.9]])

    assert leaves_at(found, points, 0).tolist() == [False, True, True]
    assert leaves_at(found, points, 1).tolist() == [False, False, False]
