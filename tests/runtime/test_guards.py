"""Modes that switch: closed forms, scipy's events, and the laws of batches."""

import json
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from compiler.dump import dump
from runtime.arrays import Array
from runtime.artifact import ArtifactError, from_bytes, to_bytes
from runtime.claim import Claim, Place, Span
from runtime.code import Code
from runtime.flow import flow_of, in_one_mode
from runtime.integrators import adaptive
from runtime.kernels.tape import LANES
from runtime.program import Program
from runtime.recording.behavior import recorded
from runtime.rollout import Ending
from runtime.simulate import FixedSteps, simulate
from runtime.table import Axis, Method
from tests.runtime.behaviors import (
    NOWHERE,
    formula_program,
    state,
    tabulated,
    van_der_pol,
)
from tests.runtime.hybrids import (
    GRAVITY,
    bouncing_ball,
    guard,
    patrol,
    relay,
    thermostat,
    with_modes,
)


def falls(height: float, e: float, count: int) -> Array:
    """The times of the first bounces of a ball dropped from `height`."""
    fall = math.sqrt(2.0 * height / GRAVITY)
    return fall * np.cumsum([1.0, *(2.0 * e**k for k in range(1, count))])


# --- closed forms -----------------------------------------------------------------------------


@given(st.floats(0.05, 0.95), st.floats(0.5, 19.0))
@settings(max_examples=25, deadline=None)
def test_a_ball_bounces_when_it_should_and_comes_to_rest_in_finite_time(
    e: float, height: float
) -> None:
    run = simulate(bouncing_ball(), {"x": height, "v": 0.0}, 200.0, {"e": e}, 50.0)
    fall = math.sqrt(2.0 * height / GRAVITY)

    np.testing.assert_allclose(run.switches.times[:8], falls(height, e, 8), rtol=1e-9)
    assert run.ending is Ending.CHATTERING
    assert "from flight to itself" in run.detail
    # The last quick bounces take 1e-9 of the time and 1e-12 of the run, and no more.
    zeno = fall * (1.0 + e) / (1.0 - e)
    assert float(run.ended_at) == pytest.approx(zeno, rel=3e-9, abs=3e-10)


@given(st.floats(0.01, 10.0))
@settings(max_examples=25, deadline=None)
def test_the_period_of_a_thermostat_is_that_of_two_exponentials(k: float) -> None:
    run = simulate(thermostat(), {"T": 15.0}, 2.0 / k, {"k": k})

    heating, cooling = math.log(20.0 / 18.0) / k, math.log(12.0 / 10.0) / k
    lasted = np.diff(run.switches.times)
    np.testing.assert_allclose(lasted[::2], cooling, rtol=1e-8)
    np.testing.assert_allclose(lasted[1::2], heating, rtol=1e-8)
    assert run.switches.entered.tolist() == [1, 0] * (len(run.switches) // 2) + [1] * (
        len(run.switches) % 2
    )


@given(st.floats(0.5, 5.0), st.floats(-5.0, -0.5), st.floats(0.1, 1.0), st.floats(0.1, 1.0))
@settings(max_examples=25, deadline=None)
def test_the_period_of_a_patrol_is_the_sum_of_its_ways(
    x1: float, x2: float, v1: float, v2: float
) -> None:
    controls = {"x1": x1, "x2": x2, "v1": v1, "v2": v2}
    period = (x1 - x2) / v1 + (x1 - x2) / v2

    run = simulate(patrol(), {"x": 0.0, "v": v1}, 3.0 * period, controls)

    times = run.switches.times
    assert run.ending is Ending.COMPLETED
    assert times[0] == pytest.approx(x1 / v1, rel=1e-12)
    np.testing.assert_allclose(times[2:] - times[:-2], period, rtol=1e-11)
    np.testing.assert_allclose(run.switches.before[::2, 0], x1, rtol=1e-14)
    np.testing.assert_allclose(run.switches.after[::2, 1], -v2, rtol=0.0)


def test_switches_agree_with_events_of_another_integrator() -> None:
    """Van der Pol with another mu on each side of x = 0.3, and a jump on one way."""
    program = with_modes(
        formula_program(
            (state("x", -9.0, 9.0), state("v", -30.0, 30.0)),
            {"x": "v", "v": "mode 0 eq 3 0.5 where 1 x 2 pow sub mul v mul x sub"},
        ),
        ("right", "left"),
        guard(0, 1, "0.3 x sub", v="v 0.2 sub"),
        guard(1, 0, "x 0.3 sub"),
    )
    x0, t, mode = np.array([2.0, 0.0]), 0.0, 0
    expected = []
    while len(expected) < 9:
        mu = (3.0, 0.5)[mode]

        def rates(_: float, x: Array, mu: float = mu) -> list[float]:
            return [x[1], mu * (1.0 - x[0] ** 2) * x[1] - x[0]]

        def event(_: float, x: Array, side: float = (1.0, -1.0)[mode]) -> float:
            return float(side * (0.3 - x[0]))

        event.terminal, event.direction = True, 1.0  # type: ignore[attr-defined]  # scipy's way
        part = solve_ivp(rates, (t, t + 50.0), x0, "DOP853", events=event, rtol=1e-12, atol=1e-13)
        t, x0 = part.t[-1], part.y[:, -1]
        expected.append(t)
        x0, mode = x0 - [0.0, 0.2 if mode == 0 else 0.0], 1 - mode

    run = simulate(program, {"x": 2.0, "v": 0.0}, expected[-1] + 0.1)

    np.testing.assert_allclose(run.switches.times, expected, rtol=1e-8)


# --- what a guard does ------------------------------------------------------------------------


def test_samples_are_of_the_mode_that_holds_and_at_the_times_asked_for() -> None:
    run = simulate(patrol(), {"x": 0.0, "v": 0.5}, 8.0, every=0.25)

    np.testing.assert_array_equal(run.times, 0.25 * np.arange(33))
    phase = (run.times + 2.0) % 8.0
    np.testing.assert_allclose(
        run.states[:, 0], np.where(phase < 4.0, 0.5 * phase - 1.0, 3.0 - 0.5 * phase), atol=1e-12
    )
    # At 2 s and 6 s the sample is of the mode before.
    np.testing.assert_array_equal(run.states[:, 2], ((run.times > 2.0) & (run.times <= 6.0)))


def test_all_resets_are_worked_out_before_any_state_jumps() -> None:
    program = with_modes(
        formula_program(
            (state("x", -9.0, 9.0), state("y", -9.0, 9.0), state("t", 0.0, 5.0)),
            {"x": "0", "y": "0", "t": "1"},
        ),
        ("before", "after"),
        guard(0, 1, "t 1 sub", x="y", y="x mode 1 add add"),
    )

    run = simulate(program, {"x": 1.0, "y": 5.0, "t": 0.0}, 2.0)

    np.testing.assert_array_equal(run.ended_in[[0, 1, 3]], [5.0, 2.0, 1.0])
    np.testing.assert_allclose(run.switches.times, [1.0], rtol=1e-12)
    assert run.ended_in[2] == pytest.approx(2.0, rel=1e-12)


def test_a_guard_that_is_open_at_the_start_is_taken_there_and_several_in_a_row() -> None:
    program = with_modes(
        formula_program((state("x", -9.0, 9.0),), {"x": "mode"}),
        ("a", "b", "c"),
        guard(0, 1, "x 1 sub"),
        guard(1, 2, "x 2 sub", x="x 1 add"),
    )

    run = simulate(program, {"x": np.array([0.0, 1.0, 2.0])}, 1.5, every=1.5)

    assert run.switches.of(0).times.size == 0
    assert run.switches.of(1).times.tolist()[0] == 0.0
    assert run.switches.of(1).entered.tolist() == [1, 2]
    assert run.switches.of(2).times.tolist() == [0.0, 0.0]
    np.testing.assert_allclose(run.states[:, 1, 0], [0.0, 4.0, 6.0], rtol=1e-11)


def test_of_guards_that_open_together_the_first_one_is_taken() -> None:
    program = with_modes(
        formula_program((state("x", -9.0, 9.0),), {"x": "1"}),
        ("a", "b", "c"),
        guard(0, 2, "x 1 sub"),
        guard(0, 1, "x 2 mul 2 sub"),
    )
    assert simulate(program, {"x": 0.0}, 2.0).switches.entered.tolist() == [2]
    other = replace(program.field, guards=program.field.guards[::-1])
    assert simulate(replace(program, field=other), {"x": 0.0}, 2.0).ended_in[1] == 1.0


def test_a_guard_that_is_open_for_an_instant_within_a_long_step_is_not_missed() -> None:
    """The integrator crosses 40 units in one step; the guard is open for 2 of them."""
    program = with_modes(
        formula_program((state("x", -100.0, 100.0),), {"x": "1"}),
        ("a", "b"),
        guard(0, 1, "1 x 20 sub abs sub"),
    )
    run = simulate(program, {"x": -20.0}, 60.0, every=60.0)

    np.testing.assert_allclose(run.switches.times, [39.0], rtol=1e-12)


def test_a_relay_chatters_and_says_between_which_modes() -> None:
    run = simulate(relay(), {"x": np.array([-1.0, -2.5])}, 10.0)

    assert run.endings == (Ending.CHATTERING, Ending.CHATTERING)
    assert run.details[0] == "switches without end at t = 1 s, between up and down"
    np.testing.assert_allclose(run.ended_at, [1.0, 2.5], rtol=1e-9)
    np.testing.assert_allclose(run.ended_in[:, 0], 0.0, atol=1e-9)


def test_a_circle_of_open_guards_chatters_at_the_start() -> None:
    program = with_modes(
        formula_program((state("x", -5.0, 5.0),), {"x": "1"}),
        ("a", "b"),
        guard(0, 1, "1"),
        guard(1, 0, "1"),
    )
    run = simulate(program, {"x": 0.0}, 1.0)

    assert (run.ending, float(run.ended_at)) == (Ending.CHATTERING, 0.0)


def test_a_fast_but_finite_cycle_does_not_chatter() -> None:
    run = simulate(thermostat(), {"T": 20.5}, 200.0, {"k": 10.0}, 100.0)

    assert run.ending is Ending.COMPLETED
    assert len(run.switches) == pytest.approx(2.0 * 200.0 / 0.0287682, rel=1e-3)


@pytest.mark.parametrize("tables", [False, True])
def test_a_guard_at_the_edge_of_the_domain_opens_there(tables: bool) -> None:  # noqa: FBT001
    program = bouncing_ball(low=0.0)
    if tables:
        axes = (Axis("x", 0.0, 20.0, 5, periodic=False), Axis("v", -50.0, 50.0, 5, periodic=False))
        program = tabulated(
            program, lambda x, v: np.stack([v, 0 * x - GRAVITY], -1), axes, Method.CUBIC
        )

    run = simulate(program, {"x": 5.0, "v": 0.0}, 4.0, {"e": 0.8})

    assert run.ending is Ending.COMPLETED
    np.testing.assert_allclose(run.switches.times, falls(5.0, 0.8, 3), rtol=1e-7)


def test_a_jump_out_of_the_domain_ends_the_run_there() -> None:
    program = with_modes(
        formula_program((state("x", -9.0, 9.0),), {"x": "1"}),
        ("a", "b"),
        guard(0, 1, "x 1 sub", x="x 20 mul"),
        guard(1, 0, "x 5 sub", x="-1 sqrt"),
    )
    out = simulate(program, {"x": 0.0}, 5.0)
    lost = simulate(program, {"x": 4.0, "mode": 1.0}, 5.0)

    assert out.ending is Ending.LEFT_DOMAIN
    assert (out.detail, float(out.ended_at)) == ("x went above 9 at t = 1 s", pytest.approx(1.0))
    assert lost.ending is Ending.DIVERGED


def test_a_condition_without_a_value_opens_nothing() -> None:
    program = with_modes(
        formula_program((state("x", -9.0, 9.0),), {"x": "1"}),
        ("a", "b"),
        guard(0, 1, "x 1 sub sqrt 0.5 sub"),
    )
    run = simulate(program, {"x": -1.0}, 5.0)

    np.testing.assert_allclose(run.switches.times, [2.25], rtol=1e-12)


def test_the_edge_is_left_before_a_guard_beyond_it_opens() -> None:
    program = with_modes(
        formula_program((state("x", -9.0, 9.0),), {"x": "1"}),
        ("a", "b"),
        guard(0, 1, "x 9.1 sub", x="0"),
    )
    assert simulate(program, {"x": 0.0}, 20.0).ending is Ending.LEFT_DOMAIN


# --- laws -------------------------------------------------------------------------------------


def test_a_trajectory_has_the_same_bits_and_switches_in_any_batch() -> None:
    program = patrol()
    rng = np.random.default_rng(3)
    count = 2 * LANES + 5
    x0 = np.stack(
        [rng.uniform(-0.5, 0.5, count), rng.uniform(0.1, 1.0, count), np.zeros(count)], axis=-1
    )
    lows = [part.low for part in program.controls]
    u = rng.uniform(lows, [part.high for part in program.controls], (count, 4))
    flow, times = flow_of(program), np.linspace(0.0, 60.0, 7)

    together = adaptive(flow, x0, u, times, 1e-9, 1e-12)

    for b in (0, 1, LANES, count - 1):
        alone = adaptive(flow, x0[b : b + 1], u[b : b + 1], times, 1e-9, 1e-12)
        assert alone.states[0].tobytes() == together.states[b].tobytes()
        mine = together.switches.of(b)
        assert len(mine) > 0
        for name in ("times", "left", "entered", "before", "after"):
            assert getattr(mine, name).tobytes() == getattr(alone.switches, name).tobytes()


def test_guards_that_never_open_change_no_bit() -> None:
    program = van_der_pol()
    quiet = with_modes(program, ("only",), guard(0, 0, "x 100 sub"))
    x0, times = np.array([[2.0, 0.0], [0.1, 0.2]]), np.linspace(0.0, 20.0, 33)
    plain = adaptive(flow_of(program), x0, np.ones(1), times, 1e-9, 1e-12)
    still = np.concatenate([x0, np.zeros((2, 1))], axis=1)

    watched = adaptive(flow_of(quiet), still, np.ones(1), times, 1e-9, 1e-12)

    assert watched.states[..., :2].tobytes() == plain.states.tobytes()


def test_many_switches_of_many_trajectories_are_all_noted() -> None:
    flow = flow_of(thermostat())
    count, times = 300, np.array([0.0, 15.0])
    x0 = np.stack([np.linspace(10.5, 21.9, count), np.zeros(count)], axis=-1)

    ran = adaptive(flow, x0, np.ones(1), times, 1e-8, 1e-8)

    numbers = np.bincount(ran.switches.trajectories, minlength=count)
    first = np.array([ran.switches.of(b).times[0] for b in range(count)])
    np.testing.assert_allclose(first, np.log((40.0 - x0[:, 0]) / 18.0), atol=1e-7)
    period = math.log(20.0 / 18.0) + math.log(12.0 / 10.0)
    np.testing.assert_allclose(numbers, 2.0 * (15.0 - first) / period, atol=2.0)
    assert (np.diff(ran.switches.trajectories) >= 0).all()


def test_backwards_and_in_one_mode_nothing_switches() -> None:
    flow, x0 = flow_of(patrol()), np.array([[0.0, 0.5, 0.0]])
    u = np.array([1.0, -1.0, 0.5, 0.5])

    back = adaptive(flow, x0, u, np.array([0.0, -4.0]), 1e-9, 1e-12)
    on = adaptive(in_one_mode(flow), x0, u, np.array([0.0, 4.0]), 1e-9, 1e-12)

    np.testing.assert_allclose(back.states[0, -1], [-2.0, 0.5, 0.0], rtol=1e-12)
    np.testing.assert_allclose(on.states[0, -1], [2.0, 0.5, 0.0], rtol=1e-12)
    assert len(back.switches) == len(on.switches) == 0


def test_fixed_steps_are_refused_with_what_to_use() -> None:
    with pytest.raises(ValueError, match=r"modes that switch.*adaptive"):
        simulate(patrol(), {}, 1.0, method=FixedSteps(0.1))


# --- storage ----------------------------------------------------------------------------------


def claim() -> Claim:
    return Claim(
        text="one stable cycle",
        feature="stable cycle",
        least=1,
        most=1,
        other=False,
        places=(Place("x", Code("x1 2 div"), 0.1),),
        reaches=(),
        period=Code("x1 x2 sub"),
        period_within=0.01,
        share=None,
        goes_to="",
        called="",
        over=(Span("v1", 0.2, 0.5),),
        settings=(("v2", 0.3),),
        sketched=False,
        origin=NOWHERE,
    )


def test_modes_guards_and_claims_are_stored_and_dumped() -> None:
    program = replace(patrol(), claims=(claim(),))
    found = from_bytes(to_bytes(program))

    assert found.field.guards == program.field.guards
    assert found.field.mode == "mode"
    assert found.claims == program.claims
    assert "    mode 0 -> 1  when x x1 sub >= 0 v := v2 neg  spec.yaml:1:1" in dump(found)
    assert found.driven == (0, 1)


def test_a_recording_names_the_modes() -> None:
    program = patrol()
    run = simulate(program, {"x": 0.0, "v": 0.5}, 4.0, every=1.0)

    data = recorded(run, program)

    assert data == recorded(run, program)
    assert json.dumps("forward").encode() in to_bytes(program)


def broken() -> Iterator[tuple[Program, str]]:
    program = patrol()
    field, states = program.field, program.states

    def guarded(**change: object) -> Program:
        odd = replace(field.guards[0], **change)  # type: ignore[arg-type]  # of any field
        return replace(program, field=replace(field, guards=(odd,)))

    def claimed(**change: object) -> Program:
        odd = replace(claim(), **change)  # type: ignore[arg-type]  # of any field
        return replace(program, claims=(odd,))

    yield guarded(mode=2), "mode that 'mode' does not have"
    yield guarded(target=-1), "mode that 'mode' does not have"
    yield guarded(condition=Code("x boom")), "condition of guard 0"
    yield guarded(resets=(("w", Code("1")),)), "resets what is no state"
    yield guarded(resets=(("mode", Code("1")),)), "resets what is no state"
    yield guarded(resets=(("x", Code("1")), ("x", Code("2")))), "or twice"
    yield guarded(resets=(("x", Code("y")),)), "reset of 'x'"
    yield replace(program, field=replace(field, mode="")), "guards or a mode"
    yield replace(program, field=replace(field, mode="x")), "not discrete"
    yield replace(program, field=replace(field, mode="w", guards=())), "guards or a mode"
    yield replace(program, field=replace(field, every=0.1)), "step map"
    sensed = replace(states[2], closure=Code("1"))
    yield replace(program, states=(*states[:2], sensed)), "cannot be the mode"
    yield claimed(places=(Place("w", Code("1"), 0.1),)), "no state"
    yield claimed(places=(Place("x", Code("v"), 0.1),)), "claim 0"
    yield claimed(over=(Span("x", 0.0, 1.0),)), "no control"
    yield claimed(settings=(("v1", 0.3),)), "twice"
    yield claimed(over=(Span("v1", 0.5, 0.2),)), "no value"
    yield claimed(most=0), "counts to less"
    yield claimed(share=1.5), "share"
    yield claimed(period=Code("x")), "claim 0"


@pytest.mark.parametrize(("program", "reason"), list(broken()))
def test_modes_and_claims_that_do_not_fit_are_refused(program: Program, reason: str) -> None:
    with pytest.raises(ArtifactError, match=reason):
        to_bytes(program)
