"""Integrators against closed forms, scipy's DOP853 and the laws of batches."""

import itertools
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from runtime.flow import Flow, Source, flow_of
from runtime.integrators import Trajectories, adaptive, fixed_steps, rk4
from runtime.kernels.tape import LANES
from runtime.program import Kind, Program, Role
from runtime.rollout import Ending
from runtime.table import Method
from tests.runtime.behaviors import (
    control,
    formula_program,
    state,
    tabulated_van_der_pol,
    van_der_pol,
)

PERIOD = 6.66328686
"""Of van der Pol's oscillator at mu = 1, to 9 digits."""
NO_COLUMNS = np.zeros(0, dtype=np.int64)
NO_INPUTS = np.zeros((1, 1, 0))
ONE = np.ones(1)
WIDE = 1e6


def focus() -> Program:
    """x' = -a x - w y, y' = w x - a y: the matrix exponential is a shrinking rotation."""
    return formula_program(
        (state("x", -WIDE, WIDE), state("y", -WIDE, WIDE)),
        {"x": "a x mul neg w y mul sub", "y": "w x mul a y mul sub"},
        controls=(control("a", -5.0, 5.0, 0.3), control("w", -50.0, 50.0, 2.0)),
    )


def focus_at(x0: Array, t: Array, a: float, w: float) -> Array:
    z = (x0[..., 0] + 1j * x0[..., 1])[..., np.newaxis] * np.exp((-a + 1j * w) * t)
    return np.stack([z.real, z.imag], axis=-1)


def steps(flow: Flow, x0: Array, times: Array) -> Array:
    return rk4(flow, x0, times, NO_INPUTS, NO_COLUMNS)


def starts(count: int, reach: float = 2.0, seed: int = 0) -> Array:
    return np.random.default_rng(seed).uniform(-reach, reach, (count, 2))


def bits(ran: Trajectories) -> tuple[bytes, ...]:
    return (
        np.ascontiguousarray(ran.states).tobytes(),
        ran.endings.tobytes(),
        ran.ended_at.tobytes(),
        np.ascontiguousarray(ran.ended_in).tobytes(),
    )


# --- fixed steps ------------------------------------------------------------------------------


def test_fixed_steps_are_of_order_four() -> None:
    flow, x0 = flow_of(focus()), starts(5)
    errors = []
    for count in (50, 100, 200):
        end = steps(flow, x0, np.linspace(0.0, 5.0, count + 1))[:, -1]
        errors.append(np.abs(end - focus_at(x0, np.array([5.0]), 0.3, 2.0)[:, 0]).max())

    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert ((orders > 3.9) & (orders < 4.2)).all(), orders


def test_fixed_steps_are_those_of_a_plain_loop() -> None:
    flow, x = flow_of(van_der_pol()), np.array([2.0, 0.0])
    times = np.sort(np.random.default_rng(0).uniform(0.0, 3.0, 40))
    found = steps(flow, x[np.newaxis], times)[0]

    def f(x: Array) -> Array:
        return np.array([x[1], (1.0 - x[0] ** 2) * x[1] - x[0]])

    for s, h in enumerate(np.diff(times)):
        np.testing.assert_allclose(found[s], x, rtol=1e-13)
        k1 = f(x)
        k2 = f(x + h / 2 * k1)
        k3 = f(x + h / 2 * k2)
        k4 = f(x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    np.testing.assert_allclose(found[-1], x, rtol=1e-13)


def test_each_trajectory_has_its_own_times_and_runs_backwards_too() -> None:
    flow, x0 = flow_of(focus()), starts(3)
    spans = np.array([1.0, -2.0, 0.5])
    times = spans[:, np.newaxis] * np.linspace(0.0, 1.0, 401)

    found = steps(flow, x0, times)

    for b in range(3):
        exact = focus_at(x0[b], times[b], 0.3, 2.0)
        np.testing.assert_allclose(found[b], exact, atol=1e-9)


def test_inputs_are_held_during_each_step() -> None:
    flow, x0 = flow_of(focus()), starts(2)
    rng = np.random.default_rng(5)
    times = np.linspace(0.0, 2.0, 201)
    inputs = rng.uniform(-2.0, 2.0, (2, 200, 1))

    found = rk4(flow, x0, times, inputs, np.array([3]))

    for b in range(2):
        x = x0[b]
        for s, h in enumerate(np.diff(times)):
            x = focus_at(x, np.array([h]), 0.3, inputs[b, s, 0])[0]
            np.testing.assert_allclose(found[b, s + 1], x, atol=1e-8)


def test_inputs_for_all_steps_or_all_trajectories_are_those_spelled_out() -> None:
    flow, x0, times = flow_of(focus()), starts(3), np.linspace(0.0, 1.0, 11)
    column, value = np.array([3]), np.array([1.25])
    spelled = rk4(flow, x0, np.tile(times, (3, 1)), np.tile(value, (3, 10, 1)), column)

    for shape in [(1, 1), (3, 1), (1, 10)]:
        found = rk4(flow, x0, times, np.tile(value, (*shape, 1)), column)
        assert found.tobytes() == spelled.tobytes()


def test_a_measured_state_is_what_the_input_says_and_the_others_follow_it() -> None:
    sensed = replace(state("d", -5.0, 5.0), role=Role.SENSED)
    flow = flow_of(formula_program((state("x", -9.0, 9.0), sensed), {"x": "d"}))
    measured = np.array([[[1.0], [2.0], [-4.0]]])

    found = rk4(flow, np.zeros((1, 2)), np.array([0.0, 1.0, 2.0, 2.5]), measured, np.array([1]))

    np.testing.assert_allclose(found[0], [[0, 1], [1, 2], [3, -4], [1, -4]], atol=1e-15)


def test_steps_of_length_zero_change_nothing_and_look_at_no_input() -> None:
    flow, x0 = flow_of(focus()), starts(2)
    times = np.array([0.0, 0.5, 1.0])
    inputs = np.array([[[1.0], [2.0]]])
    plain = rk4(flow, x0, times, inputs, np.array([3]))

    padded_inputs = np.array([[[1.0], [np.nan], [2.0], [np.nan]]])
    padded = rk4(flow, x0, np.array([0.0, 0.5, 0.5, 1.0, 1.0]), padded_inputs, np.array([3]))

    assert padded[:, [0, 1, 3]].tobytes() == plain.tobytes()
    np.testing.assert_array_equal(padded[:, 2], padded[:, 1])
    np.testing.assert_array_equal(padded[:, 4], padded[:, 3])


def test_an_input_outside_its_domain_ends_the_trajectory_and_only_that_one() -> None:
    flow, x0 = flow_of(focus()), starts(2)
    inputs = np.array([[[1.0], [60.0], [1.0]], [[1.0], [1.0], [1.0]]])

    ran = fixed_steps(flow, x0, np.linspace(0.0, 3.0, 4), inputs, np.array([3]))

    assert [ran.ending(b) for b in range(2)] == [Ending.LEFT_DOMAIN, Ending.COMPLETED]
    assert (ran.variables[0], ran.sides[0], ran.ended_at[0]) == (3, 1, 1.0)
    assert np.isfinite(ran.states[0, 0]).all()
    assert np.isnan(ran.states[0, 1:]).all()
    assert np.isfinite(ran.states[1]).all()


def test_a_map_is_iterated() -> None:
    step = formula_program(
        (state("x", 0.0, 1.0),),
        {"x": "r x mul 1 x sub mul"},
        controls=(control("r", 0.0, 4.0, 3.9),),
        every=0.1,
    )
    found = rk4(flow_of(step), np.array([[0.3]]), np.arange(21.0), NO_INPUTS, NO_COLUMNS)[0, :, 0]

    x = 0.3
    for value in found:
        assert value == pytest.approx(x, rel=1e-9)
        x = 3.9 * x * (1.0 - x)


def test_a_map_that_leaves_its_domain_ends_at_that_step() -> None:
    double = formula_program((state("x", 0.0, 1.0),), {"x": "2 x mul"}, every=0.1)
    times = 0.1 * np.arange(6)

    ran = fixed_steps(flow_of(double), np.array([[0.3]]), times, NO_INPUTS, NO_COLUMNS)

    assert ran.ending(0) is Ending.LEFT_DOMAIN
    np.testing.assert_array_equal(ran.states[0, :, 0], [0.3, 0.6, *[np.nan] * 4])
    assert ran.ended_at[0] == pytest.approx(0.2)
    assert ran.ended_in[0, 0] == 1.2


# --- adaptive steps ---------------------------------------------------------------------------


def test_the_error_follows_the_tolerance() -> None:
    flow, x0, times = flow_of(focus()), starts(20), np.linspace(0.0, 10.0, 37)
    u, exact = np.array([0.1, 3.0]), focus_at(starts(20), times, 0.1, 3.0)
    errors = [
        np.abs(adaptive(flow, x0, u, times, 10.0**-k, 10.0**-k).states - exact).max()
        for k in (4, 6, 8, 10, 12)
    ]

    assert all(before > 5.0 * after for before, after in itertools.pairwise(errors)), errors
    assert errors[3] < 1e-8


def test_dense_output_is_as_good_as_the_steps_themselves() -> None:
    flow, x0 = flow_of(focus()), starts(4)
    u = np.array([0.0, 1.0])
    times = np.linspace(0.0, 6.0, 5001)

    found = adaptive(flow, x0, u, times, 1e-8, 1e-8).states

    np.testing.assert_allclose(found, focus_at(x0, times, 0.0, 1.0), atol=3e-7)


def test_samples_do_not_change_the_steps() -> None:
    flow, x0 = flow_of(van_der_pol()), starts(30)
    few = adaptive(flow, x0, ONE, np.array([0.0, 9.0]), 1e-7, 1e-7)
    many = adaptive(flow, x0, ONE, np.linspace(0.0, 9.0, 1000), 1e-7, 1e-7)

    assert few.states[:, -1].tobytes() == many.states[:, -1].tobytes()
    assert few.ended_in.tobytes() == many.ended_in.tobytes()


def test_backwards_undoes_forwards() -> None:
    flow, x0 = flow_of(van_der_pol()), starts(20, 1.5)
    ahead = adaptive(flow, x0, ONE, np.array([0.0, 2.0]), 1e-11, 1e-11).states[:, -1]
    back = adaptive(flow, ahead, ONE, np.array([2.0, 1.0, 0.0]), 1e-11, 1e-11)

    # Backwards the oscillator spreads errors: its divergence is positive there.
    np.testing.assert_allclose(back.states[:, -1], x0, atol=1e-7)


def test_the_logistic_curve_is_met() -> None:
    flow = flow_of(formula_program((state("x", -0.5, 1.5),), {"x": "x 1 x sub mul"}))
    times, x0 = np.linspace(0.0, 20.0, 101), np.array([[0.01], [0.5], [1.3]])

    found = adaptive(flow, x0, np.zeros(0), times, 1e-10, 1e-12).states[..., 0]

    exact = 1.0 / (1.0 + (1.0 / x0 - 1.0) * np.exp(-times))
    np.testing.assert_allclose(found, exact, atol=1e-8)


def pendulum() -> Program:
    angle = replace(state("a", -math.pi, math.pi), kind=Kind.PERIODIC)
    return formula_program((angle, state("w", -20.0, 20.0)), {"a": "w", "w": "a sin neg"})


def test_a_pendulum_keeps_its_energy_and_its_angle_is_not_wrapped() -> None:
    x0 = np.array([[0.5, 0.0], [3.1, 0.0], [0.0, 2.5]])
    times = np.linspace(0.0, 50.0, 501)

    a, w = np.moveaxis(
        adaptive(flow_of(pendulum()), x0, ONE[:0], times, 1e-11, 1e-11).states, -1, 0
    )

    energy = 0.5 * w**2 - np.cos(a)
    np.testing.assert_allclose(energy, np.repeat(energy[:, :1], 501, axis=1), atol=1e-8)
    assert a[2, -1] > 80.0, "2.5 is enough to go round and round"
    assert (np.diff(a[2]) > 0.0).all()


@pytest.mark.parametrize("source", Source)
def test_adaptive_agrees_with_dop853(source: Source) -> None:
    flow, times = flow_of(tabulated_van_der_pol(), source), np.linspace(0.0, 12.0, 49)
    x0 = starts(3)
    found = adaptive(flow, x0, ONE, times, 1e-10, 1e-10).states

    for b in range(3):
        reference = solve_ivp(
            lambda _, x: [x[1], (1 - x[0] ** 2) * x[1] - x[0]],
            (0.0, 12.0),
            x0[b],
            method="DOP853",
            t_eval=times,
            rtol=1e-12,
            atol=1e-12,
        )
        np.testing.assert_allclose(found[b], reference.y.T, atol=2e-8)


def period_of(flow: Flow, rtol: float) -> float:
    """The time between two upward crossings of v = 0 on the cycle.

    Crossings are found between samples, then refined by Newton's method on time: v' is known.
    """
    settled = adaptive(flow, np.array([[2.0, 0.0]]), ONE, np.array([0.0, 60.0]), rtol, rtol)
    times = np.linspace(0.0, 16.0, 1601)
    x = adaptive(flow, settled.states[:, -1], ONE, times, rtol, rtol).states[0]
    before = np.flatnonzero((x[:-1, 1] < 0.0) & (x[1:, 1] >= 0.0))[:2]
    crossings = []
    for s in before:
        point, time = x[s], times[s]
        for _ in range(6):
            shift = -point[1] / ((1 - point[0] ** 2) * point[1] - point[0])
            span = np.array([0.0, shift])
            point = adaptive(flow, point[np.newaxis], ONE, span, rtol, rtol).states[0, -1]
            time += shift
        crossings.append(time)
    return float(crossings[1] - crossings[0])


def test_van_der_pol_has_its_period_through_formula_and_cubic_table() -> None:
    program = tabulated_van_der_pol()

    for source in Source:
        assert period_of(flow_of(program, source), 1e-11) == pytest.approx(PERIOD, abs=1e-8)


def test_van_der_pol_has_its_period_to_a_thousandth_through_a_linear_table() -> None:
    program = tabulated_van_der_pol(Method.LINEAR, 257)

    assert period_of(flow_of(program), 1e-8) == pytest.approx(PERIOD, abs=1e-3)


# --- batches ----------------------------------------------------------------------------------


@pytest.mark.parametrize("program", [van_der_pol(4.0), tabulated_van_der_pol()])
def test_a_trajectory_does_not_depend_on_the_others(program: Program) -> None:
    flow = flow_of(program)
    x0 = starts(3 * LANES + 5, 3.9, seed=3)
    times = np.linspace(0.0, 8.0, 33)
    order = np.random.default_rng(4).permutation(len(x0))

    def run(x0: Array) -> tuple[Trajectories, Trajectories]:
        fixed = fixed_steps(flow, x0, times, NO_INPUTS, NO_COLUMNS)
        return adaptive(flow, x0, ONE, times, 1e-7, 1e-9), fixed

    for batch, shuffled, alone in zip(run(x0), run(x0[order]), run(x0[70:71]), strict=True):
        assert batch.states[order].tobytes() == shuffled.states.tobytes()
        assert batch.ended_at[order].tobytes() == shuffled.ended_at.tobytes()
        assert batch.endings[order].tobytes() == shuffled.endings.tobytes()
        assert batch.states[70:71].tobytes() == alone.states.tobytes()
    assert 0.02 < np.mean(batch.endings == 1) < 0.98, "some must leave, some stay"


def test_threads_do_not_change_trajectories() -> None:
    flow, times = flow_of(van_der_pol()), np.linspace(0.0, 5.0, 6)
    x0 = starts(400)
    with ThreadPoolExecutor(4) as pool:
        parts = pool.map(lambda x: bits(adaptive(flow, x, ONE, times, 1e-7, 1e-7)), np.split(x0, 8))
    joined = tuple(b"".join(pieces) for pieces in zip(*parts, strict=True))

    assert joined == bits(adaptive(flow, x0, ONE, times, 1e-7, 1e-7))


def test_empty_batches_and_single_times_are_fine() -> None:
    flow = flow_of(van_der_pol())

    assert adaptive(flow, np.zeros((0, 2)), ONE, np.arange(3.0), 1e-6, 1e-6).states.size == 0
    assert steps(flow, np.zeros((0, 2)), np.arange(3.0)).shape == (0, 3, 2)
    for times in (np.zeros(1), np.zeros(3)):
        once = adaptive(flow, starts(2), ONE, times, 1e-6, 1e-6)
        assert once.ending(1) is Ending.COMPLETED
        for sample in range(times.size):
            np.testing.assert_array_equal(once.states[:, sample], starts(2))
    np.testing.assert_array_equal(steps(flow, starts(2), np.zeros(1))[:, 0], starts(2))


# --- endings ----------------------------------------------------------------------------------


def drift(rate: str = "1") -> Flow:
    return flow_of(formula_program((state("x", 0.0, 1.0),), {"x": rate}))


def run_both(flow: Flow, x0: Array, times: Array) -> list[Trajectories]:
    return [
        adaptive(flow, x0, np.zeros(0), times, 1e-10, 1e-12),
        fixed_steps(flow, x0, times, NO_INPUTS, NO_COLUMNS),
    ]


def test_the_place_where_the_domain_is_left_is_located() -> None:
    x0, times = np.array([[0.0], [0.123], [0.999]]), np.linspace(0.0, 3.0, 31)

    for ran in run_both(drift(), x0, times):
        np.testing.assert_allclose(ran.ended_at, 1.0 - x0[:, 0], atol=3e-12)
        np.testing.assert_allclose(ran.ended_in[:, 0], 1.0, atol=1e-12)
        assert (ran.ended_in <= 1.0).all()
        assert ran.endings.tolist() == [1, 1, 1]
        assert ran.sides.tolist() == [1, 1, 1]
        known = times <= ran.ended_at[:, np.newaxis]
        assert (np.isfinite(ran.states[..., 0]) == known).all()


def test_a_curved_exit_is_located_to_the_order_of_the_method() -> None:
    # x = sin t leaves [-0.6, 0.8] upwards at asin(0.8), y = cos t stays in its domain.
    wave = formula_program((state("x", -0.6, 0.8), state("y", -2.0, 2.0)), {"x": "y", "y": "x neg"})
    x0 = np.array([[0.0, 1.0], [0.0, -1.0]])

    for ran in run_both(flow_of(wave), x0, np.linspace(0.0, 3.0, 301)):
        np.testing.assert_allclose(ran.ended_at, [math.asin(0.8), math.asin(0.6)], atol=1e-9)
        assert ran.variables.tolist() == [0, 0]
        assert ran.sides.tolist() == [1, -1]


def test_an_excursion_between_two_accepted_steps_is_seen() -> None:
    # A parabola is integrated exactly, so the steps are as long as the run: x = 1.6 t - t^2 is at
    # home at both ends and peaks at 0.64.
    throw = flow_of(
        formula_program((state("x", -9.0, 0.6), state("v", -9.0, 9.0)), {"x": "v", "v": "2 neg"})
    )
    ran = adaptive(throw, np.array([[0.0, 1.6]]), np.zeros(0), np.array([0.0, 3.0]), 1e-6, 1e-6)

    assert ran.ending(0) is Ending.LEFT_DOMAIN
    assert ran.ended_at[0] == pytest.approx(0.6, abs=1e-9)


def test_a_start_on_the_edge_is_inside_and_one_beyond_it_is_not() -> None:
    x0 = np.array([[1.0], [np.nextafter(1.0, 2.0)], [-0.1], [np.nan]])

    for ran in run_both(drift("x neg"), x0, np.linspace(0.0, 1.0, 11)):
        assert ran.endings.tolist() == [0, 1, 1, 1]
        assert ran.sides.tolist() == [0, 1, -1, 0]
        assert np.isnan(ran.states[1:]).all()
        assert (ran.ended_at[1:] == 0.0).all()


def test_an_edge_beyond_which_the_formula_has_no_value_is_left_all_the_same() -> None:
    ran = adaptive(
        drift("0.1 x sqrt add neg"), np.ones((1, 1)), np.zeros(0), np.array([0.0, 9.0]), 1e-9, 1e-9
    )

    # With s = sqrt(x): ds/dt = -(0.1 + s) / (2 s), so t = 2 (1 - 0.1 log(11)).
    assert ran.ending(0) is Ending.LEFT_DOMAIN
    assert ran.sides[0] == -1
    assert ran.ended_at[0] == pytest.approx(2.0 * (1.0 - 0.1 * math.log(11.0)), abs=1e-6)


def test_rates_that_are_not_finite_end_a_run_as_diverged() -> None:
    pole = drift("1 0.5 x sub div")
    wall = drift("0.3 x sub sqrt 1 x mul add")

    at_pole = adaptive(pole, np.array([[0.5]]), np.zeros(0), np.array([0.0, 1.0]), 1e-6, 1e-6)
    assert at_pole.ending(0) is Ending.DIVERGED
    assert at_pole.ended_at[0] == 0.0
    within = adaptive(wall, np.array([[0.1]]), np.zeros(0), np.array([0.0, 9.0]), 1e-6, 1e-6)
    assert within.ending(0) is Ending.DIVERGED
    assert within.ended_in[0, 0] == pytest.approx(0.3, abs=1e-6)
    fixed = fixed_steps(wall, np.array([[0.1]]), np.linspace(0, 9, 91), NO_INPUTS, NO_COLUMNS)
    assert fixed.ending(0) is Ending.DIVERGED
    assert np.isnan(fixed.states[0, -1, 0])


def test_the_number_of_steps_is_limited() -> None:
    flow = flow_of(pendulum())
    ran = adaptive(flow, starts(3), ONE[:0], np.array([0.0, 1e6]), 1e-9, 1e-9, most_steps=100)

    assert {ran.ending(b) for b in range(3)} == {Ending.TOO_MANY_STEPS}
    assert ((ran.ended_at > 1.0) & (ran.ended_at < 1e3)).all()
    assert np.isnan(ran.states[:, 1]).all()
