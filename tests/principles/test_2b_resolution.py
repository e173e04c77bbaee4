"""Principle 2b: time is continuous, or so finely cut that nothing of interest falls between."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from compiler.world.scenario import compile_scenario
from runtime.scenario import Scenario
from runtime.world.world import LONGEST
from spec_schema.diagnostics import SpecError
from tests.principles.scenes import GO, PROBE, SPIN, Started, halt, robot, scenario, way

SCENARIOS = Path(__file__).parents[2] / "specs" / "scenarios"
TURNED = 0.5 * 6.0 - 0.5 * 0.5**2 / 20.0
"""Radians after 6 s at 0.5 rad/s, reached with 20 rad/s^2."""


@cache
def errors_of_turn() -> tuple[float, ...]:
    """Radians by which a turn of 3 rad ends off, with steps of 5, 2.5 and 1.25 ms."""
    made = [
        scenario(robot("[2 m, 1.5 m]", spin=SPIN), duration="6 s", step=step)
        for step in ("5 ms", "2.5 ms", "1.25 ms")
    ]
    return tuple(abs(float(way(one)[-1, 0, 2]) - TURNED) for one in made)


def test_a_step_half_as_long_comes_twice_as_near_to_the_true_time() -> None:
    """2b: how fine time is cut is for the user to say."""
    coarse, finer, finest = errors_of_turn()

    assert coarse < 0.5 * 0.005  # the turn of half a step
    assert coarse / finer == pytest.approx(2.0, rel=0.05)
    assert finer / finest == pytest.approx(2.0, rel=0.05)


def shortest(made: Scenario) -> float:
    """Seconds: the shortest period, response time, rate or latency that a scenario speaks of."""
    times = []
    for one in made.robots:
        times += [time for s in one.body.sensors for time in (s.every, s.latency)]
        times += [t for n in one.architecture.nodes for t in (n.period, n.response_time)]
    return min(time for time in times if time > 0.0)


@pytest.mark.parametrize("name", ["first_light", "random_walker", "light_subsumption"])
def test_steps_are_small_beside_every_time_that_a_scenario_speaks_of(name: str) -> None:
    """2b: at most a tenth of them, and never more than 5 ms for what moves."""
    made = compile_scenario(SCENARIOS / f"{name}.yaml", lambda _what, _done, _of: None).scenario

    assert made.step <= 0.1 * shortest(made) + 1e-12
    assert made.step <= LONGEST + 1e-12


def test_whatever_its_scenario_says_physics_takes_no_step_over_5_ms() -> None:
    """2b: a scenario whose times need no short step gets them cut: the way is the same."""
    coarse, fine = (
        way(scenario(robot("[2 m, 1.5 m]", go=GO, spin=SPIN), duration="2 s", step=step))
        for step in ("10 ms", "5 ms")
    )

    assert np.array_equal(coarse, fine[::2])


@cache
def told_apart() -> float:
    """Milliseconds between response times of 100 and 101 ms, as told by where a robot stops."""
    quick = PROBE.replace("reach: 3 m, every: 10 ms", "reach: 3 m, every: 1 ms")
    ends = []
    for late in ("100 ms", "101 ms"):
        node = halt(late, near="2 m", period="1 ms")
        made = scenario(robot("[1.5 m, 1.5 m]", body=quick, halt=node), duration="2 s", step="1 ms")
        ends.append(float(Started(made).finish()[0, 0]))
    return (ends[1] - ends[0]) / 0.4 * 1e3


def test_a_millisecond_more_of_response_time_is_a_millisecond_more_of_way() -> None:
    """2b: no time is rounded to some tick."""
    assert told_apart() == pytest.approx(1.0, abs=1e-3)


def test_times_that_no_step_divides_are_refused() -> None:
    """2b: rather than bent until they fit."""
    with pytest.raises(SpecError, match="S352"):
        scenario(robot("[1 m, 1 m]", halt=halt(response="33.33 ms")))
