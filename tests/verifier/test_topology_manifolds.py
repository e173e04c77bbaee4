"""Separatrices against eigenvectors, energies and an independent integration."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from runtime.program import Kind, Program
from tests.verifier.topology_scenes import (
    behavior,
    henon,
    linear,
    pendulum,
    plane,
    state,
    tabulated,
)
from verifier.topology.features import Portrait, Reaches, Separatrix
from verifier.topology.portrait import Detail, portrait

NO_PATHS = Detail(plane=65, trajectories=0)


def shown(program: Program) -> Portrait:
    return portrait(program, detail=NO_PATHS)


def separatrices(program: Program) -> tuple[Separatrix, ...]:
    return shown(program).separatrices


def duffing(friction: float) -> Program:
    return behavior(
        "duffing",
        (state("x", -2.0, 2.0), state("v", -2.0, 2.0)),
        ("v", f"x x x mul x mul sub {friction!r} v mul sub"),
    )


def pendulum_on_a_plane(friction: float) -> Program:
    """The same pendulum over an angle that is counted on: two saddles."""
    program = pendulum(friction, kind=Kind.CONTINUOUS)
    angle, rate = program.states
    return replace(program, states=(replace(angle, low=-4.0, high=4.0), rate))


def test_the_manifolds_of_a_linear_saddle_are_its_eigenvectors() -> None:
    found = separatrices(linear(1.0, 0.5, 0.2, -1.0))
    root = math.sqrt(1.1)

    assert [s.stable for s in found] == [False, False, True, True]
    for s in found:
        slope = (-root - 1.0) / 0.5 if s.stable else (root - 1.0) / 0.5
        assert s.points[:, 1] == pytest.approx(slope * s.points[:, 0], abs=1e-8)
        outer = s.points[0] if s.stable else s.points[-1]
        assert np.abs(outer).max() == pytest.approx(2.0, abs=1e-6)
        assert s.reaches is Reaches.EDGE
        assert s.to == -1
        assert np.all(np.diff(s.times) > 0.0)


def test_a_bent_manifold_is_followed_along_its_closed_form() -> None:
    # x' = x, y' = -y + x²: the unstable manifold of the origin is y = x² / 3.
    for s in separatrices(plane("x", "x x mul y sub")):
        x, y = s.points.T
        if s.stable:
            assert x == pytest.approx(np.zeros(len(x)), abs=1e-8)
        else:
            assert y == pytest.approx(x * x / 3.0, abs=1e-8)
            # Two orders are all there is here, so the branch begins as far out as it may.
            assert abs(x[0]) == pytest.approx(0.08, rel=0.01)


def test_a_manifold_of_third_order_is_begun_close_enough_to_lie_on_it() -> None:
    # x' = x, y' = -y + x³: y = x³ / 4.
    for s in separatrices(plane("x", "x x mul x mul y sub")):
        if not s.stable:
            x, y = s.points.T
            assert y == pytest.approx(x**3 / 4.0, abs=1e-8)


def test_the_separatrix_of_a_frictionless_pendulum_has_the_energy_of_its_saddle() -> None:
    for program in (pendulum(0.0), pendulum_on_a_plane(0.0)):
        for s in separatrices(program):
            angle, rate = s.points.T
            energy = 0.5 * rate**2 - np.cos(angle)
            assert energy == pytest.approx(np.ones(len(energy)), abs=1e-7)


def test_a_frictionless_pendulum_has_heteroclinic_branches_between_its_two_saddles() -> None:
    found = shown(pendulum_on_a_plane(0.0))

    between = [s for s in found.separatrices if s.reaches is Reaches.POINT]
    assert {(s.saddle, s.to) for s in between} == {(0, 2), (2, 0)}
    assert len(between) == 4
    assert len(found.separatrices) == 8
    assert all(s.reaches is Reaches.EDGE for s in found.separatrices if s not in between)


def test_on_a_cylinder_the_same_branches_are_homoclinic() -> None:
    found = separatrices(pendulum(0.0))

    assert len(found) == 4
    for s in found:
        assert s.reaches is Reaches.ITSELF
        assert s.to == s.saddle
        assert abs(s.points[-1, 0] - s.points[0, 0]) == pytest.approx(2.0 * math.pi, abs=0.01)


def test_a_little_friction_breaks_the_connection() -> None:
    for friction in (1e-4, -1e-4):
        ways = {s.reaches for s in separatrices(replace_friction(friction))}
        assert Reaches.ITSELF not in ways


def replace_friction(friction: float) -> Program:
    program = pendulum(friction)
    (control,) = program.controls
    return replace(program, controls=(replace(control, low=-1.0),))


def test_the_stable_manifold_near_zero_friction_follows_the_energy_balance() -> None:
    # dE/dt = -friction rate². To first order the loss from the angle a to the saddle at pi is the
    # integral of the rate 2 cos(angle/2) over the angle: 4 (1 - sin(a/2)).
    friction = 1e-3
    within = [
        s
        for s in separatrices(pendulum_on_a_plane(friction))
        if s.stable and np.abs(s.points[0, 0] - s.points[-1, 0]) > math.pi
    ]
    assert len(within) == 2
    for s in within:
        # Beyond, near the other saddle, the first order is not enough.
        angle, rate = s.points[np.abs(s.points[:, 0]) < 2.0].T
        ahead = np.sign(rate[0]) * angle
        lost = friction * 4.0 * (1.0 - np.sin(0.5 * ahead))
        excess = 0.5 * rate**2 - np.cos(angle) - 1.0
        assert excess == pytest.approx(lost, rel=5e-3)


def test_duffings_saddle_without_friction_is_homoclinic_on_both_sides() -> None:
    found = separatrices(duffing(0.0))

    assert [s.reaches for s in found] == [Reaches.ITSELF] * 4
    for s in found:
        x, v = s.points.T
        assert 0.5 * v * v - 0.5 * x * x + 0.25 * x**4 == pytest.approx(np.zeros(len(x)), abs=1e-8)
        assert np.abs(x).max() == pytest.approx(math.sqrt(2.0), abs=1e-4)


def test_duffings_unstable_branches_go_to_one_well_each() -> None:
    found = shown(duffing(0.2))

    unstable = [s for s in found.separatrices if not s.stable]
    assert [s.reaches for s in unstable] == [Reaches.POINT, Reaches.POINT]
    for s in unstable:
        goal = found.fixed_points[s.to].at
        assert np.sign(goal[0]) == np.sign(s.points[0, 0])
        assert s.points[-1] == pytest.approx(goal, abs=0.02)


def test_separatrices_agree_with_an_independent_integration() -> None:
    def field(_: float, z: Array) -> Array:
        return np.array([z[1], -math.sin(z[0]) - 0.3 * z[1]])

    for s in separatrices(pendulum(0.3)):
        # The stable branch is compared backward in time: that is the way in which it attracts.
        order = slice(None, None, -1) if s.stable else slice(None)
        times, points = s.times[order], s.points[order]
        exact = solve_ivp(
            field,
            (times[0], times[-1]),
            points[0],
            method="DOP853",
            t_eval=times[::20],
            rtol=1e-11,
            atol=1e-12,
        )
        assert points[::20] == pytest.approx(exact.y.T, abs=1e-6)


def test_a_separatrix_through_a_table_lies_on_the_formulas() -> None:
    exact, table = (separatrices(p) for p in (pendulum(0.3), tabulated(pendulum(0.3), 129, 1e-7)))

    assert [(s.reaches, s.to) for s in table] == [(s.reaches, s.to) for s in exact]
    for one, other in zip(exact, table, strict=True):
        assert len(other.times) > 100
        last = -1 if not one.stable else 0
        assert other.points[last] == pytest.approx(one.points[last], abs=0.02)


def test_a_field_without_saddles_has_no_separatrices() -> None:
    assert separatrices(linear(-1.0, 0.5, -0.5, -1.0)) == ()


def test_a_saddle_on_the_border_has_the_branches_that_lie_within() -> None:
    # x' = x + 2, y' = -y over [-2, 2]²: the saddle is at (-2, 0).
    found = separatrices(plane("x 2 add", "y neg"))

    unstable = [s for s in found if not s.stable]
    assert len(unstable) == 1
    assert unstable[0].points[-1] == pytest.approx([2.0, 0.0], abs=1e-6)


def driven_pendulum(direction: str) -> Program:
    """With a constant torque it can keep running; backward in time for direction -1."""
    return behavior(
        "driven",
        (state("angle", -math.pi, math.pi, kind=Kind.PERIODIC), state("rate", -4.0, 4.0)),
        (f"{direction} rate mul", f"{direction} 0.5 angle sin sub 0.2 rate mul sub mul"),
    )


def test_a_driven_pendulums_saddle_separates_hanging_from_running() -> None:
    found = shown(driven_pendulum("1"))

    ways = {s.reaches for s in found.separatrices if not s.stable}
    assert ways == {Reaches.POINT, Reaches.CYCLE}
    (running,) = found.cycles
    for s in found.separatrices:
        if s.reaches is Reaches.CYCLE:
            assert found.cycles[s.to] is running
            highest = running.points[:, 1].max()
            assert running.points[:, 1].min() < s.points[-1, 1] + 0.05 < highest + 0.1


def test_backward_in_time_the_same_branches_come_from_there() -> None:
    found = shown(driven_pendulum("-1"))

    ways = {s.reaches for s in found.separatrices if s.stable}
    assert ways == {Reaches.POINT, Reaches.CYCLE}
    for s in found.separatrices:
        assert np.all(np.diff(s.times) > 0.0)
        if s.stable and s.reaches is Reaches.POINT:
            assert s.points[0] == pytest.approx(found.fixed_points[s.to].at, abs=0.05)


def lorenz(r: float) -> Program:
    return behavior(
        "lorenz",
        (state("x", -30.0, 30.0), state("y", -40.0, 40.0), state("z", -10.0, 60.0)),
        ("10 y x sub mul", f"x {r!r} z sub mul y sub", "x y mul 8 3 div z mul sub"),
    )


@pytest.mark.parametrize(("r", "crosses"), [(13.8, False), (14.05, True)])
def test_lorenz_unstable_branches_change_sides_at_the_homoclinic_value(
    r: float, *, crosses: bool
) -> None:
    # r = 13.926: Sparrow 1982; Strogatz 2015, section 9.5.
    detail = Detail(solid=9, trajectories=0, cycles=False)
    found = portrait(lorenz(r), ("x", "y", "z"), detail=detail)

    assert len(found.separatrices) == 2
    for s in found.separatrices:
        assert s.reaches is Reaches.POINT
        side = np.sign(s.points[0, 0])
        goal = np.sign(found.fixed_points[s.to].at[0])
        assert goal == (-side if crosses else side)


def test_a_maps_unstable_manifold_follows_its_closed_form() -> None:
    # x -> 2 x, y -> y/2 + x²: y = 2/7 x² is carried into itself.
    program = behavior(
        "map",
        (state("x", -2.0, 2.0), state("y", -2.0, 2.0)),
        ("2 x mul", "0.5 y mul x x mul add"),
        every=1.0,
    )
    found = separatrices(program)

    assert len(found) == 4
    for s in found:
        x, y = s.points.T
        assert s.reaches is Reaches.EDGE
        assert np.all(np.diff(s.times) > 0.0)
        if s.stable:
            assert x == pytest.approx(np.zeros(len(x)), abs=1e-8)
            assert abs(y[0]) == pytest.approx(2.0, abs=1e-2)
        else:
            assert y == pytest.approx(2.0 / 7.0 * x * x, abs=1e-8)
            assert abs(x[0]) == pytest.approx(0.04, rel=0.01)
            assert abs(x[-1]) == pytest.approx(2.0, abs=1e-2)


def test_henons_attractor_lies_on_the_unstable_manifold_of_its_saddle() -> None:
    # Benedicks and Carleson 1991: it is the manifold's closure.
    found = portrait(henon(), detail=Detail(plane=65, trajectories=0, cycles=False))
    inner = max(range(len(found.fixed_points)), key=lambda i: found.fixed_points[i].at[0])
    manifold = np.concatenate(
        [s.points for s in found.separatrices if s.saddle == inner and not s.stable]
    )

    x, y = 0.1, 0.1
    gaps = []
    for step in range(400):
        x, y = 1.0 - 1.4 * x * x + y, 0.3 * x
        if step > 50:
            gaps.append(float(np.hypot(*(manifold - [x, y]).T).min()))
    assert np.quantile(gaps, 0.95) < 0.05


def test_what_starts_on_henons_stable_manifold_comes_to_its_saddle() -> None:
    found = portrait(henon(), detail=Detail(plane=65, trajectories=0, cycles=False))

    stable = [s for s in found.separatrices if s.stable]
    assert len(stable) == 4
    for s in stable:
        nearest = []
        for start in s.points[:: max(len(s.points) // 10, 1)]:
            path = [start]
            for _ in range(6):
                x, y = path[-1]
                path.append(np.array([1.0 - 1.4 * x * x + y, 0.3 * x]))
            gap = np.hypot(*(np.array(path) - found.fixed_points[s.saddle].at).T)
            nearest.append(float(gap.min()))
        assert max(nearest) < 1e-3


def test_unstable_branches_of_a_map_go_to_its_stable_points() -> None:
    program = behavior(
        "cubic",
        (state("x", -2.0, 2.0), state("y", -2.0, 2.0)),
        ("1.5 x mul 0.5 x x mul x mul mul sub", "0.5 y mul 0.1 x mul add"),
        every=1.0,
    )
    found = shown(program)

    unstable = [s for s in found.separatrices if not s.stable]
    assert len(unstable) == 2
    for s in unstable:
        assert s.reaches is Reaches.POINT
        assert s.points[-1] == pytest.approx(found.fixed_points[s.to].at, abs=0.05)
