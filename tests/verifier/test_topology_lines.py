"""Nullclines and trajectories against closed forms and conserved quantities."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from runtime.program import Program
from tests.verifier.topology_scenes import (
    HOPF,
    OSCILLATOR,
    behavior,
    henon,
    pendulum,
    plane,
    state,
    tabulated,
    van_der_pol,
)
from verifier.topology.features import Portrait
from verifier.topology.portrait import Detail, portrait

LINES_ONLY = Detail(trajectories=0)


def nullclines(program: Program, of: str) -> tuple[Array, ...]:
    found = portrait(program, detail=LINES_ONLY).nullclines
    return next(n.lines for n in found if n.of == of)


def test_the_nullclines_of_van_der_pol_are_its_axis_and_three_branches() -> None:
    (axis,) = nullclines(van_der_pol(1.0), "x")
    branches = nullclines(van_der_pol(1.0), "v")

    assert axis[:, 1] == pytest.approx(np.zeros(len(axis)), abs=1e-12)
    assert np.ptp(axis[:, 0]) == pytest.approx(8.0)
    assert len(branches) == 3
    for x, v in np.concatenate(branches):
        assert v * (1.0 - x * x) == pytest.approx(x, abs=1e-4)


def test_a_rate_that_touches_zero_has_a_nullcline() -> None:
    (touching,) = nullclines(plane("x y y mul sub 2 pow", "y neg"), "x")

    assert touching[:, 0] == pytest.approx(touching[:, 1] ** 2, abs=1e-3)
    assert np.ptp(touching[:, 1]) > 2.5  # from y = -sqrt(2) to sqrt(2)


def test_a_rate_that_comes_near_zero_has_none() -> None:
    assert nullclines(plane("x x mul 1e-4 add", "y neg"), "x") == ()


def test_a_jump_across_zero_is_no_nullcline() -> None:
    assert nullclines(plane("x 0.1 add sign", "y neg"), "x") == ()


def test_an_oscillators_trajectories_keep_their_energy_and_close() -> None:
    for path in portrait(OSCILLATOR).trajectories:
        energy = np.sum(path.points**2, axis=1)
        assert energy == pytest.approx(np.full(len(energy), energy[0]), rel=1e-6)
        # Followed in both directions of time until each has closed: two turns of 2 pi seconds.
        assert path.times[-1] - path.times[0] < 4.0 * math.pi + 0.1


def test_trajectories_agree_with_an_independent_integration() -> None:
    def field(_: float, z: Array) -> Array:
        return np.array([z[1], (1.0 - z[0] ** 2) * z[1] - z[0]])

    for path in portrait(van_der_pol(1.0)).trajectories:
        span = (path.times[0], path.times[-1])
        exact = solve_ivp(
            field, span, path.points[0], t_eval=path.times[::20], rtol=1e-10, atol=1e-12
        )
        # 1e-8 a step, grown by the stretch along the path before it settles on the cycle
        assert path.points[::20] == pytest.approx(exact.y.T, abs=2e-3)


def test_trajectories_run_in_the_direction_of_time() -> None:
    for program in (HOPF, pendulum(), van_der_pol()):
        for path in portrait(program).trajectories:
            assert np.all(np.diff(path.times) > 0.0)


def test_all_paths_of_the_hopf_field_end_on_its_cycle_or_leave_backward() -> None:
    paths = portrait(HOPF).trajectories

    assert len(paths) >= 3
    for path in paths:
        assert math.hypot(*path.points[-1]) == pytest.approx(1.0, abs=1e-3)


def test_a_path_over_the_seam_of_an_angle_is_continuous() -> None:
    for path in portrait(pendulum()).trajectories:
        assert np.abs(np.diff(path.points[:, 0])).max() < 0.5


def test_a_portrait_through_a_table_shows_the_same_lines() -> None:
    def longest(found: Portrait) -> Array:
        return max((line for n in found.nullclines for line in n.lines), key=len)

    exact = longest(portrait(pendulum(), detail=LINES_ONLY))
    table = longest(portrait(tabulated(pendulum(), 65, 1e-6), detail=LINES_ONLY))

    assert table == pytest.approx(exact, abs=1e-4)


def test_chattering_along_a_jump_ends() -> None:
    found = portrait(plane("x 0.1 add sign neg", "y neg"))

    assert all(len(path.times) < 10_000 for path in found.trajectories)


def test_the_orbits_of_a_map_are_its_iterates() -> None:
    found = portrait(henon())

    for path in found.trajectories:
        x, y = path.points[:-1].T
        assert path.points[1:, 0] == pytest.approx(1.0 - 1.4 * x * x + y, abs=1e-12)
        assert path.points[1:, 1] == pytest.approx(0.3 * x, abs=1e-12)
        assert path.times == pytest.approx(0.1 * np.arange(len(path.times)))


def test_the_field_of_a_map_is_its_displacement() -> None:
    doubling = behavior("double", (state("x", -1.0, 1.0),), ("x 0.5 mul",), every=1.0)

    field = portrait(doubling).field

    assert field.rates[:, 0] == pytest.approx(-0.5 * field.nodes[0])
