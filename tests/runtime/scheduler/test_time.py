"""Rates, response times and latencies against difference equations solved by hand."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.program import Program, Role
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.behaviors import control, formula_program, state
from tests.runtime.scheduler.plane import (
    STEP,
    N,
    Noted,
    Plain,
    Plane,
    architecture,
    positions,
    scenario,
)


def go_home() -> Program:
    """x' = -gain * x: proportional control."""
    return formula_program(
        (state("x", -50.0, 50.0),), {"x": "gain neg x mul"}, (control("gain", 0.0, 50.0, 2.0),)
    )


def homing(period: int, response: int, every: int = 1, latency: int = 0) -> tuple[Scheduler, Plane]:
    plane = Plane([(1.0, 0.0)])
    node = N(
        "home", go_home(), period * STEP, response * STEP, {"x": "pos.x"}, {"x": ("x", "rate")}
    )
    wired = architecture([node])
    return Scheduler(scenario(wired), plane, Plain(plane, [(every, latency)])), plane


@pytest.mark.parametrize(
    ("period", "response", "every", "latency"),
    [
        (1, 0, 1, 0),
        (5, 0, 1, 0),
        (5, 5, 1, 0),
        (5, 12, 1, 0),
        (4, 3, 6, 0),
        (3, 7, 4, 9),
        (1, 1, 1, 1),
    ],
)
def test_sample_hold_act_is_the_exact_delay_difference_equation(
    period: int, response: int, every: int, latency: int
) -> None:
    scheduler, plane = homing(period, response, every, latency)
    steps = 400

    path = positions(scheduler, plane, steps)[:, 0]

    # x[k+1] = x[k] - h * gain * x[s], where s is the instant of the sensor's sample that the tick
    # had seen whose command is in effect.
    x = np.empty(steps + 1)
    x[0] = 1.0
    for k in range(steps):
        tick = (k - response) // period * period
        if tick < 0:
            x[k + 1] = x[k]
            continue
        sample = max(0, (tick - latency) // every * every)
        x[k + 1] = x[k] - STEP * 2.0 * x[sample]
    np.testing.assert_array_almost_equal_nulp(path, x, nulp=4)


def echo(scale: str = "1") -> Program:
    """Says `y`, a multiple of what it senses as `x`."""
    sensed = replace(state("x", -1e6, 1e6), role=Role.SENSED)
    own = replace(state("idle", 0.0, 1.0), role=Role.DRIVEN, hold=0.0)
    return formula_program((sensed, own), {"idle": "0"}, outputs={"y": f"x {scale} mul"})


def clockwork(*nodes: N, order: tuple[int, ...] | None = None) -> tuple[Scheduler, Noted]:
    """Nodes over a sensor that says the time, in instants."""
    plane = Plane(outside=lambda _robot, _sensor, time: (time / STEP, 0.0))
    noted = Noted()
    wired = architecture(nodes)
    if order is not None:
        wired = replace(wired, order=order)
    return Scheduler(scenario(wired), plane, Plain(plane), observer=noted), noted


def said(noted: Noted, node: int) -> list[tuple[int, float]]:
    """Of each tick of a node its instant and its first output."""
    return [(instant, float(tick.outputs[0])) for instant, tick in noted.of(node)]


def test_nodes_with_no_response_time_are_passed_through_at_once() -> None:
    scheduler, noted = clockwork(
        N("first", echo("2"), inputs={"x": "pos.x"}),
        N("second", echo("10"), inputs={"x": "first.y"}),
        N("third", echo("1"), inputs={"x": "second.y"}),
    )

    scheduler.run(5)

    assert said(noted, 2) == [(k, 20.0 * k) for k in range(5)]


def test_in_another_order_a_node_reads_what_was_said_the_instant_before() -> None:
    nodes = (
        N("first", echo("2"), inputs={"x": "pos.x"}),
        N("second", echo(), inputs={"x": "first.y"}),
    )

    scheduler, noted = clockwork(*nodes, order=(1, 0))
    scheduler.run(5)

    assert said(noted, 1) == [(0, 0.0), (1, 0.0), (2, 2.0), (3, 4.0), (4, 6.0)]


def test_those_with_response_times_see_the_board_as_it_was_for_all() -> None:
    swap = (
        N("a", echo(), response=STEP, inputs={"x": "b.y"}),
        N("b", echo(), response=STEP, inputs={"x": "pos.x"}),
    )
    for order in ((0, 1), (1, 0)):
        scheduler, noted = clockwork(*swap, order=order)
        scheduler.run(4)

        assert said(noted, 0) == [(0, 0.0), (1, 0.0), (2, 1.0), (3, 2.0)]


def test_what_takes_effect_at_an_instant_is_seen_by_ticks_at_that_instant() -> None:
    scheduler, noted = clockwork(
        N("slow", echo(), 4 * STEP, 4 * STEP, {"x": "pos.x"}),
        N("quick", echo(), inputs={"x": "slow.y"}),
    )

    scheduler.run(10)

    # What is sampled at 4 is said at 8.
    assert [value for _, value in said(noted, 1)] == [0.0] * 8 + [4.0, 4.0]


def test_ticks_are_at_multiples_of_periods_however_long_the_response() -> None:
    scheduler, noted = clockwork(
        N("a", echo(), 3 * STEP, 7 * STEP, {"x": "pos.x"}),
        N("b", echo(), 5 * STEP, 0.0, {"x": "a.y"}),
    )

    scheduler.run(31)

    assert [instant for instant, _ in noted.of(0)] == list(range(0, 31, 3))
    # b at 5 k sees what a sampled at the last multiple of 3 that is 7 instants old.
    expected = [(k, float(max(0, (k - 7) // 3 * 3))) for k in range(0, 31, 5)]
    assert said(noted, 1) == expected


def test_a_period_that_is_no_multiple_of_the_step_is_refused() -> None:
    with pytest.raises(ValueError, match="multiple of the step"):
        clockwork(N("a", echo(), 2.5 * STEP, inputs={"x": "pos.x"}))


def test_an_accelerated_channel_changes_at_every_step_between_ticks() -> None:
    push = formula_program((replace(state("v", -9.0, 9.0), role=Role.DRIVEN),), {"v": "3"})
    plane = Plane()
    node = N("push", push, 10 * STEP, 0.0, {}, {"x": ("v", "acceleration")})
    scheduler = Scheduler(scenario(architecture([node])), plane, Plain(plane))

    scheduler.run(25)

    speeds = [command[2][0] for command in plane.commands]
    np.testing.assert_allclose(speeds, 3.0 * STEP * np.arange(1, 26), rtol=1e-12)
