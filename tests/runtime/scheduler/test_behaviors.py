"""What a behavior does at a tick: own states, modes, commands, wires, noise."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime import chance
from runtime.architecture import Input, Outside
from runtime.code import Code
from runtime.interpolation import lookup
from runtime.program import Kind, Noise, Output, Program, Role
from runtime.scheduler.inputs import Inputs, domain_of
from runtime.scheduler.observer import What
from runtime.scheduler.scheduler import Scheduler
from runtime.simulate import simulate
from runtime.table import Axis, Method
from tests.runtime.behaviors import (
    NOWHERE,
    ONE,
    control,
    formula_program,
    state,
    tabulated,
    van_der_pol,
)
from tests.runtime.hybrids import guard, with_modes
from tests.runtime.scheduler.plane import STEP, N, Noted, Plain, Plane, architecture, scenario

PERIOD = 0.1
EVERY = 10
"""Steps in a period."""


def own(program: Program) -> Program:
    """The program with states that it only drives: they are its own."""
    return replace(program, states=tuple(replace(s, role=Role.DRIVEN) for s in program.states))


def run(
    node: N, instants: int, begin: dict[str, float] | None = None, seed: int = 0, **signals: float
) -> tuple[Scheduler, Noted]:
    """One node that reads signals that do not change, named `pos.x` and `pos.y`."""
    said = (signals.get("x", 0.0), signals.get("y", 0.0))
    plane = Plane(outside=lambda *_: said)
    noted = Noted()
    beginnings = {f"r.{node.name}.{name}": value for name, value in (begin or {}).items()}
    whole = scenario(architecture([node]), beginnings=beginnings, seed=seed)
    scheduler = Scheduler(whole, plane, Plain(plane), observer=noted)
    scheduler.run(instants)
    return scheduler, noted


def test_own_states_go_the_way_that_the_behavior_goes_alone() -> None:
    _, noted = run(N("swing", own(van_der_pol()), PERIOD), 10 * EVERY, {"x": 1.0})

    alone = simulate(van_der_pol(), {"x": 1.0}, 1.0, every=PERIOD)
    ticks = np.array([tick.register[:2] for _, tick in noted.ticks])
    np.testing.assert_allclose(ticks, alone.states[:10], atol=1e-8)  # 8 steps of order 4 a period


def bent_van_der_pol(method: Method) -> Program:
    """Its table with values that no formula of the program gives, over two axes with a control."""
    axes = (*(Axis(name, -4.0, 4.0, 17, periodic=False) for name in ("x", "v")),)
    return tabulated(
        van_der_pol(4.0),
        lambda x, v: np.stack([np.sin(v), np.cos(x) - np.abs(v)], axis=-1),
        axes,
        method,
        coefficient="mu 2 mul",
    )


@pytest.mark.parametrize("method", [Method.LINEAR, Method.CUBIC])
def test_a_behavior_with_tables_goes_their_way_and_not_its_formula_s(method: Method) -> None:
    program = bent_van_der_pol(method)
    _, noted = run(N("swing", own(program), PERIOD), 10 * EVERY, {"x": 1.0, "v": 0.3})

    alone = simulate(program, {"x": 1.0, "v": 0.3}, 1.0, every=PERIOD)
    ticks = np.array([tick.register[:2] for _, tick in noted.ticks])
    # Tables bend at their cells, so that 8 steps a period lose some digits there.
    np.testing.assert_allclose(ticks, alone.states[:10], atol=1e-4)
    by_formula = simulate(van_der_pol(4.0), {"x": 1.0, "v": 0.3}, 1.0, every=PERIOD)
    assert np.max(np.abs(ticks - by_formula.states[:10])) > 0.1


@pytest.mark.parametrize("method", [Method.LINEAR, Method.CUBIC])
@given(x=st.floats(-4.0, 4.0), v=st.floats(-4.0, 4.0))
def test_a_command_of_tables_is_what_looking_up_gives(method: Method, x: float, v: float) -> None:
    program = bent_van_der_pol(method)
    node = N("swing", program, PERIOD, 0.0, {"x": "pos.x", "v": "pos.y"}, {"x": ("v", "rate", 1.0)})

    _, noted = run(node, 1, x=x, y=v)

    (looked_up,) = lookup(program.field.tables[0], np.array([[x, v]]))
    assert noted.ticks[0][1].commands[0] == pytest.approx(2.0 * looked_up[1], abs=1e-12)


@pytest.mark.parametrize("mode", ["rate", "set-point", "acceleration"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_command_is_the_rate_now_or_the_value_one_period_on(mode: str, sign: float) -> None:
    decay = formula_program((state("v", -5.0, 5.0),), {"v": "v -2 mul"})
    node = N("slow", decay, PERIOD, 0.0, {"v": "pos.x"}, {"x": ("v", mode, sign)})

    _, noted = run(node, 1, x=1.5)

    wanted = 1.5 * math.exp(-0.2) if mode == "set-point" else -3.0
    assert noted.ticks[0][1].commands[0] == pytest.approx(sign * wanted, rel=1e-8)


def test_outputs_and_controls_command_as_they_are_at_the_sample() -> None:
    decay = formula_program(
        (state("v", -5.0, 5.0),),
        {"v": "v -2 mul"},
        (control("u", 0.0, 9.0, 4.0),),
        {"o": "v 3 mul"},
    )
    commands = {"x": ("o", "set-point"), "y": ("u", "set-point", -1.0)}

    _, noted = run(N("a", decay, PERIOD, 0.0, {"v": "pos.x"}, commands), 1, x=1.5)

    np.testing.assert_array_equal(noted.channels[0][2], [4.5, -4.0])


def timer() -> Program:
    """Waits for 0.25 s, goes for 0.4 s, and so on: a clock of its own decides."""
    return with_modes(
        own(formula_program((state("t", 0.0, 9.0),), {"t": "1"}, (), {"going": "mode 1 eq"})),
        ("wait", "go"),
        guard(0, 1, "t 0.25 sub", t="0"),
        guard(1, 0, "t 0.4 sub", t="0"),
    )


def test_a_timer_switches_at_its_time_and_not_at_a_tick() -> None:
    program = timer()

    _, noted = run(N("timer", program, PERIOD), 100 * EVERY, {"t": 0.0})

    for instant, tick in noted.ticks:
        phase = instant * STEP % 0.65
        near = min(phase, abs(phase - 0.25), 0.65 - phase)
        if near > 1e-6:  # else both are right
            assert tick.outputs[0] == (phase >= 0.25)
            since = phase if phase < 0.25 else phase - 0.25
            assert tick.register[0] == pytest.approx(since, abs=1e-9)


def test_a_guard_over_what_is_sensed_is_taken_at_the_sample() -> None:
    program = with_modes(
        formula_program((state("x", -9.0, 9.0),), {"x": "mode 0 eq 1 -1 where"}),
        ("forth", "back"),
        guard(0, 1, "x 1 sub"),
        guard(1, 0, "-1 x sub"),
    )
    node = N("patrol", program, PERIOD, 0.0, {"x": "pos.x"}, {"x": ("x", "rate")})

    _, noted = run(node, 1, x=1.2)

    assert noted.ticks[0][1].register.tolist() == [1.2, 1.0]
    assert noted.ticks[0][1].commands[0] == -1.0


def test_a_mode_that_switches_without_end_is_told_and_left_alone() -> None:
    program = with_modes(
        own(formula_program((state("t", 0.0, 9.0),), {"t": "1"})),
        ("a", "b"),
        guard(0, 1, "t 1 sub"),
        guard(1, 0, "t 1 sub"),
    )

    _, noted = run(N("odd", program, PERIOD), 20 * EVERY, {"t": 0.0})

    assert {event.what for _, event in noted.events} >= {What.CHATTERING}
    assert noted.ticks[-1][1].register[0] == pytest.approx(1.9)


def test_an_own_state_stays_at_the_edge_of_its_domain_and_an_angle_wraps() -> None:
    angle = replace(state("a", -math.pi, math.pi), kind=Kind.PERIODIC, role=Role.DRIVEN)
    program = own(formula_program((state("s", 0.0, 1.0), angle), {"s": "2", "a": "2"}))
    node = N("both", program, PERIOD)

    _, noted = run(node, 31 * EVERY, {"s": 0.0, "a": 0.0})

    s, a = noted.ticks[30][1].register[:2]
    assert s == 1.0
    assert a == pytest.approx(6.0 - 2.0 * math.pi, abs=1e-9)
    assert [event.what for _, event in noted.events] == [What.AT_THE_EDGE]


def test_a_wire_scales_and_clips() -> None:
    node = N("a", go(), PERIOD, 0.0, {"x": ("pos.x", -2.0, Outside.CLIP)}, {"x": ("x", "rate")})

    _, noted = run(node, 1, x=0.25)
    assert noted.ticks[0][1].register[0] == -0.5
    _, noted = run(node, 1, x=3.0)
    assert noted.ticks[0][1].register[0] == -1.0
    assert noted.ticks[0][1].acts


def go() -> Program:
    """x' = -x, within [-1, 1]."""
    return formula_program((state("x", -1.0, 1.0),), {"x": "x neg"})


@pytest.mark.parametrize("reading", [3.0, -1.0001, math.nan])
def test_a_reading_outside_may_keep_its_node_from_acting(reading: float) -> None:
    node = N("a", go(), PERIOD, 0.0, {"x": ("pos.x", 1.0, Outside.INHIBIT)}, {"x": ("x", "rate")})

    _, noted = run(node, 1, x=reading)

    assert not noted.ticks[0][1].acts
    assert noted.channels[0][2][0] == 0.0
    assert [event.what for _, event in noted.events] == [What.OUTSIDE]


@pytest.mark.parametrize("reading", [-0.25 * math.tau, 1.5, 5 * math.tau + 0.5, -1e-18, 1e300])
@pytest.mark.parametrize("outside", [Outside.CLIP, Outside.INHIBIT])
def test_an_angle_from_elsewhere_is_turned_into_its_own_range(
    reading: float, outside: Outside
) -> None:
    turning = replace(state("x", 0.0, math.tau), kind=Kind.PERIODIC)
    told = Output("seen", ONE, Code("x"), "", NOWHERE)
    program = replace(formula_program((turning,), {"x": "0"}), outputs=(told,))

    _, noted = run(N("a", program, PERIOD, 0.0, {"x": ("pos.x", 1.0, outside)}), 1, x=reading)

    tick = noted.ticks[0][1]
    assert 0.0 <= tick.outputs[0] == tick.register[0] <= math.tau
    assert tick.acts
    if abs(reading) < 1e3:
        assert math.sin(tick.outputs[0]) == pytest.approx(math.sin(reading), abs=1e-12)
        assert math.cos(tick.outputs[0]) == pytest.approx(math.cos(reading), abs=1e-12)


def test_an_arbiter_reads_an_angle_in_its_own_range() -> None:
    wire = Input("x", 0, 0.0, -1.0, Outside.INHIBIT, "")
    inputs = Inputs([wire], {"x": domain_of(Kind.PERIODIC, 0.0, math.tau)})

    found, acts = inputs.read(np.array([1.0]))

    assert found[0] == pytest.approx(math.tau - 1.0)
    assert acts


def test_where_the_field_has_no_value_the_behavior_does_not_act_and_says_so() -> None:
    root = formula_program(
        (state("x", -1.0, 1.0), replace(state("w", -9.0, 9.0), role=Role.DRIVEN)),
        {"x": "x sqrt", "w": "x sqrt"},
    )
    node = N("a", root, PERIOD, 0.0, {"x": "pos.x"}, {"x": ("x", "rate")})

    scheduler, noted = run(node, 3 * EVERY, {"w": 0.5}, x=-0.5)

    assert [event.what for _, event in noted.events] == [What.BROKEN]
    assert not noted.ticks[0][1].acts
    assert scheduler.agents[0].set_points[0] == 0.0
    assert noted.ticks[-1][1].register[1] == 0.5


def test_a_step_map_makes_one_step_a_tick() -> None:
    program = own(formula_program((state("n", 0.0, 99.0),), {"n": "n 1 add"}, every=PERIOD))

    _, noted = run(N("count", program, PERIOD), 5 * EVERY, {"n": 3.0})

    assert [tick.register[0] for _, tick in noted.ticks] == [3.0, 4.0, 5.0, 6.0, 7.0]


def test_it_acts_only_when_it_says_so_and_its_own_states_stand_still_meanwhile() -> None:
    program = own(formula_program((state("t", 0.0, 9.0),), {"t": "1"}))
    sensed = replace(state("x", -9.0, 9.0), role=Role.SENSED)
    program = replace(program, states=(*program.states, sensed))
    node = N("a", program, PERIOD, 0.0, {"x": "pos.x"}, {"x": ("t", "rate")}, acts_when="x 0 gt")
    plane = Plane(outside=lambda _r, _s, time: (1.0 if 0.45 < time < 1.05 else -1.0, 0.0))
    noted = Noted()
    Scheduler(scenario(architecture([node])), plane, Plain(plane), observer=noted).run(200)

    begun = noted.ticks[0][1].register[0]
    times = [tick.register[0] - begun for _, tick in noted.ticks]
    assert [tick.acts for _, tick in noted.ticks] == [False] * 5 + [True] * 6 + [False] * 9
    np.testing.assert_allclose(times[:5], 0.0, atol=1e-12)
    np.testing.assert_allclose(times[5:11], 0.1 * np.arange(6), atol=1e-12)
    np.testing.assert_allclose(times[11:], 0.6, atol=1e-12)
    assert {tick.commands[0] for _, tick in noted.ticks} == {1.0}  # told, not taken
    driven = [(i, c[0]) for i, _, c, _ in noted.channels]
    assert driven == [(0, 0.0), *((i, 1.0) for i in range(50, 110, 10)), (110, 0.0)]


def restless(mode: str) -> N:
    program = own(formula_program((state("h", -99.0, 99.0),), {"h": "0.5"}))
    program = replace(program, noise=(Noise("h", Code("0.3"), NOWHERE),))
    return N("roam", program, PERIOD, 0.0, {}, {"x": ("h", mode)})


def test_noise_is_an_increment_of_euler_and_maruyama_at_each_tick() -> None:
    numbers = chance.generator(5, "node", "r.roam").standard_normal(40)

    _, noted = run(restless("rate"), 40 * EVERY, {"h": 0.0}, seed=5)

    steps = 0.5 * PERIOD + 0.3 * math.sqrt(PERIOD) * numbers
    registers = [tick.register[0] for _, tick in noted.ticks]
    np.testing.assert_allclose(registers, [0.0, *np.cumsum(steps)[:-1]], atol=1e-12)
    # Held for a period, the rate brings the channel's quantity just there.
    rates = [tick.commands[0] for _, tick in noted.ticks]
    np.testing.assert_allclose(np.array(rates) * PERIOD, steps, atol=1e-12)
    _, noted = run(restless("set-point"), 40 * EVERY, {"h": 0.0}, seed=5)
    values = [tick.commands[0] for _, tick in noted.ticks]
    np.testing.assert_allclose(values, np.cumsum(steps), atol=1e-12)


def test_only_states_of_its_own_have_a_beginning() -> None:
    with pytest.raises(ValueError, match="own"):
        run(N("a", go(), PERIOD, 0.0, {"x": "pos.x"}), 1, {"x": 0.0})
