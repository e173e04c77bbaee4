"""Running a behavior by names: what is asked for, what comes out, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from runtime.code import Code
from runtime.flow import Source
from runtime.program import Kind, Program, Role, Unit
from runtime.rollout import Ending
from runtime.simulate import Adaptive, FixedSteps, simulate
from tests.runtime.behaviors import (
    control,
    formula_program,
    state,
    tabulated_van_der_pol,
    van_der_pol,
)


def decay() -> Program:
    """x' = -rate x, in centimetres."""
    x = replace(state("x", 0.0, 2.0), unit=Unit("cm", 0.01), hold=1.5)
    return formula_program(
        (x,),
        {"x": "rate x mul neg"},
        controls=(control("rate", -1.0, 3.0, 1.0),),
        outputs={"double": "2 x mul", "constant": "7"},
    )


def logistic() -> Program:
    return formula_program(
        (state("x", 0.0, 1.0),),
        {"x": "r x mul 1 x sub mul"},
        controls=(control("r", 0.0, 5.0, 3.9),),
        every=0.1,
    )


@pytest.mark.parametrize("method", [Adaptive(), FixedSteps(0.01)])
def test_a_run_is_sampled_from_the_start_to_the_very_end(method: Adaptive | FixedSteps) -> None:
    run = simulate(decay(), {"x": 2.0}, 1.0, every=0.3, method=method)

    np.testing.assert_allclose(run.times, [0.0, 0.3, 0.6, 0.9, 1.0], rtol=1e-15)
    np.testing.assert_allclose(run.states[:, 0], 2.0 * np.exp(-run.times), rtol=1e-8)
    np.testing.assert_allclose(run.outputs[:, 0], 2.0 * run.states[:, 0], rtol=1e-15)
    np.testing.assert_array_equal(run.outputs[:, 1], 7.0)
    assert (run.ending, run.detail, float(run.ended_at)) == (Ending.COMPLETED, "", 1.0)
    assert run.program == "behavior"
    assert not run.states.flags.writeable


def test_without_a_rate_of_samples_there_are_a_thousand_intervals() -> None:
    run = simulate(decay(), {}, 3.0)

    assert run.times.size == 1001
    assert run.times[-1] == 3.0
    assert run.states[0, 0] == 1.5, "a state that is not named begins at its hold"


def test_arrays_broadcast_to_a_batch() -> None:
    x, rate = np.array([[0.5], [1.0]]), np.array([0.5, 1.0, 2.0])
    run = simulate(decay(), {"x": x}, 1.0, {"rate": rate}, every=0.5)

    assert run.states.shape == (2, 3, 3, 1)
    assert run.controls.shape == (2, 3, 1)
    assert run.outputs.shape == (2, 3, 3, 2)
    assert run.ended_at.shape == (2, 3)
    assert len(run.endings) == len(run.details) == 6
    np.testing.assert_allclose(run.states[..., -1, 0], x * np.exp(-rate), rtol=1e-8)


def test_fixed_and_adaptive_steps_agree() -> None:
    fixed = simulate(van_der_pol(), {"x": 1.0}, 5.0, every=0.1, method=FixedSteps(0.001))
    adaptive = simulate(van_der_pol(), {"x": 1.0}, 5.0, every=0.1)

    np.testing.assert_allclose(fixed.states, adaptive.states, atol=1e-8)


def test_tables_and_formula_can_both_be_run() -> None:
    program = tabulated_van_der_pol()
    runs = [simulate(program, {"x": 2.0, "v": 0.0}, 8.0, source=source) for source in Source]

    np.testing.assert_allclose(runs[0].states, runs[1].states, atol=1e-7)


def test_leaving_the_domain_is_told_in_the_units_of_the_spec() -> None:
    run = simulate(decay(), {"x": np.array([1.0, 1.5])}, 4.0, {"rate": np.array([-1.0, 1.0])}, 0.25)

    assert run.endings == (Ending.LEFT_DOMAIN, Ending.COMPLETED)
    assert run.details == ("x went above 200 cm at t = 0.693147 s", "")
    assert (run.ending, run.detail) == (Ending.LEFT_DOMAIN, run.details[0])
    assert run.ended_at[0] == pytest.approx(math.log(2.0), abs=1e-9)
    assert run.ended_in[0, 0] == pytest.approx(2.0, rel=1e-12)
    assert np.isnan(run.states[0, 3:]).all()
    assert np.isnan(run.outputs[0, 3:]).all()
    assert np.isfinite(run.outputs[0, :3]).all()


def test_rates_that_are_not_finite_are_told_with_the_state() -> None:
    pole = formula_program((state("x", 0.0, 1.0),), {"x": "1 0.5 x sub div"})
    run = simulate(pole, {"x": 0.5}, 1.0)

    assert run.ending is Ending.DIVERGED
    assert run.detail == "the rates are not finite at t = 0 s, in x = 0.5"


def test_every_ending_has_a_sentence() -> None:
    assert len({ending.sentence for ending in Ending}) == len(Ending)


def test_a_map_steps_on_its_own_clock() -> None:
    run = simulate(logistic(), {"x": np.array([0.3, 0.6])}, 1.05)

    np.testing.assert_allclose(run.times, 0.1 * np.arange(11), rtol=1e-15)
    x = np.array([0.3, 0.6])
    for s in range(11):
        np.testing.assert_allclose(run.states[:, s, 0], x, rtol=1e-12)
        x = 3.9 * x * (1.0 - x)


def test_a_map_that_leaves_its_domain_says_when() -> None:
    run = simulate(logistic(), {"x": 0.5}, 1.0, {"r": 4.5})

    assert run.ending is Ending.LEFT_DOMAIN
    assert run.detail == "x went above 1 at t = 0.1 s"


def test_a_sensed_state_is_held_where_it_was_put_or_follows_its_closure() -> None:
    wall = replace(state("d", -5.0, 5.0), role=Role.SENSED)
    program = formula_program((state("x", -50.0, 50.0), wall), {"x": "d"})
    held = simulate(program, {"x": 0.0, "d": 2.0}, 3.0)
    np.testing.assert_allclose(held.states[-1], [6.0, 2.0], rtol=1e-12)

    closed = replace(program, states=(program.states[0], replace(wall, closure=Code("1"))))
    moving = simulate(closed, {"x": 0.0, "d": 0.0}, 3.0)
    np.testing.assert_allclose(moving.states[-1], [4.5, 3.0], rtol=1e-9)


def test_periodic_states_may_start_anywhere_and_discrete_ones_at_their_values() -> None:
    angle = replace(state("a", -math.pi, math.pi), kind=Kind.PERIODIC)
    mode = replace(state("m", 0.0, 1.0), kind=Kind.DISCRETE, values=("off", "on"), hold=0.0)
    program = formula_program((angle, mode), {"a": "m"})

    run = simulate(program, {"a": 10.0, "m": 1.0}, 2.0)

    np.testing.assert_allclose(run.states[-1], [12.0, 1.0], rtol=1e-12)
    with pytest.raises(ValueError, match=r"'m' is discrete: 0 \.\. 1 for off, on \(got 0.5\)"):
        simulate(program, {"m": 0.5}, 2.0)


@pytest.mark.parametrize(
    ("start", "controls", "duration", "every", "reason"),
    [
        ({"X": 1.0}, {}, 1.0, None, "no state is named 'X'; there are: x"),
        ({}, {"rat": 1.0}, 1.0, None, "no control is named 'rat'; did you mean 'rate'?"),
        ({"x": 3.0}, {}, 1.0, None, "x = 300 cm is outside its domain (0 cm to 200 cm)"),
        ({"x": np.nan}, {}, 1.0, None, "x = nan cm is outside its domain (0 cm to 200 cm)"),
        ({}, {"rate": [1.0, 9.0]}, 1.0, None, "rate = 9 is outside its domain (-1 to 3)"),
        ({}, {}, 0.0, None, "the duration must be positive (got 0.0 s)"),
        ({}, {}, np.inf, None, "the duration must be positive (got inf s)"),
        ({}, {}, 1.0, 0.0, "the time between samples must be positive (got 0.0 s)"),
        ({}, {}, 1.0, 1e-12, "1e+12 samples in 1.0 s are too many; sample less often"),
    ],
)
def test_what_makes_no_sense_is_refused_with_the_reason(
    start: dict[str, float], controls: dict[str, float], duration: float, every: float, reason: str
) -> None:
    with pytest.raises(ValueError) as caught:  # noqa: PT011  # the whole message is compared
        simulate(decay(), start, duration, controls, every)

    assert str(caught.value) == reason


def test_steps_and_clocks_that_make_no_sense_are_refused() -> None:
    with pytest.raises(ValueError, match="the step must be positive"):
        simulate(decay(), {}, 1.0, method=FixedSteps(0.0))
    with pytest.raises(ValueError, match="are too many"):
        simulate(decay(), {}, 1.0, method=FixedSteps(1e-12))
    with pytest.raises(ValueError, match=r"steps every 0\.1 s"):
        simulate(logistic(), {}, 1.0, every=0.05)
    with pytest.raises(ValueError, match="too many"):
        simulate(decay(), {"x": np.full(100_000, 1.0)}, 1.0)
