"""Rates, response times and latencies against difference equations solved by hand."""

import numpy as np
import pytest

from runtime.program import Program
from runtime.scheduler.scheduler import Scheduler
from tests.runtime.behaviors import control, formula_program, state
from tests.runtime.scheduler.plane import STEP, N, Plain, Plane, architecture, positions, scenario


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
