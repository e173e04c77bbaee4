"""Principle 1h: all that a behavior works on is an abstraction of its world, got by its sensors."""

import re
from functools import cache

import numpy as np
import pytest

from runtime.run import Run, run
from spec_schema.diagnostics import SpecError
from tests.principles.scenes import (
    GO,
    PROBE,
    SPIN,
    WATCH,
    Started,
    compiled,
    halt,
    robot,
    scenario,
)
from tests.runtime.scheduler.test_same import reachable

SCREENED = """
arena: {{box: [6 m, 3 m]}}
things:
  screen: {{shape: {{box: [0.1, 1.4]}}, at: [3, 1.5], fixed: true, height: [0, 30 cm]}}
  behind: {{shape: {{box: [0.3, 0.3]}}, at: {at}, mass: {mass}, height: [0, 20 cm]}}
lights: {{lamp: {{at: [1, 2.5], power: 10 cd, height: 60 cm}}}}
"""


def test_from_a_node_no_part_of_the_world_can_be_reached() -> None:
    """1h: there is no way round the sensors: every object that a node holds on to is followed."""
    started = Started(scenario(robot("[1 m, 1.5 m]", go=GO, eye=WATCH.format(20))))
    for _ in started.steps(0.2):
        pass

    for node in started.scheduler.agents[0].nodes:
        homes = {type(thing).__module__ for thing in reachable(node)}
        assert not {home for home in homes if re.match(r"runtime\.world|pymunk|_cffi", home)}
    homes = {type(thing).__module__ for thing in reachable(started.scheduler)}
    assert {home for home in homes if home.startswith("runtime.world")}


@cache
def screened() -> tuple[Run, Run]:
    """The same robot before a screen; behind it something is here and light, or there and heavy."""
    here, there = (
        run(
            scenario(
                robot("[1 m, 1.5 m]", halt=halt(), eye=WATCH.format(20)),
                world=SCREENED.format(at=at, mass=mass),
                duration="4 s",
            )
        )
        for at, mass in (("[4, 1.5]", "1 kg"), ("[5.2, 1.2, 20 deg]", "7 kg"))
    )
    return here, there


def differing() -> int:
    """How many numbers differ in what the robot's behaviors sampled, told and commanded."""
    here, there = (made.robots[0].nodes for made in screened())
    return sum(
        int((getattr(one, what) != getattr(other, what)).sum())
        for one, other in zip(here, there, strict=True)
        for what in ("register", "outputs", "commands")
    )


def test_what_no_sensor_can_tell_makes_no_difference_to_any_behavior() -> None:
    """1h: a thing behind a screen is here or there: not one bit of a tick differs."""
    here, there = screened()

    assert here.digest != there.digest
    assert len(here.robots[0].nodes[0].times) == 400
    assert differing() == 0


@pytest.mark.parametrize("source", ["crate.x", "r0.clearance", "world.time"])
def test_a_wire_from_anything_but_a_sensor_or_a_node_is_refused(source: str) -> None:
    """1h: where things are is known to the world; a behavior cannot even ask."""
    with pytest.raises(SpecError, match="S33") as caught:
        scenario(robot("[1 m, 1.5 m]", go=GO.replace("ahead.range", source)))

    assert source in str(caught.value)


def test_what_a_behavior_gets_is_what_its_sensor_said_noise_and_all() -> None:
    """1h: an abstraction is all there is: nowhere behind it is the truth to be had."""
    noisy = PROBE.replace("every: 10 ms}", "every: 10 ms, noise: {range: 5 cm}}", 1)
    made = run(scenario(robot("[1.5 m, 1.5 m]", body=noisy, eye=WATCH.format(10)), duration="1 s"))
    told, sampled = made.signals["r0.ahead.range"], made.signals["r0.eye.ahead"]

    assert np.std(told.values) > 0.02
    assert np.array_equal(told.values, sampled.values)


def test_a_behavior_that_reads_nothing_sensed_is_told_to_be_an_imitation() -> None:
    """1h: following a way by heart is no behavior (thesis, section 2.3, caveat 1)."""
    made = compiled(robot("[1 m, 1.5 m]", halt=halt(), spin=SPIN))

    told = [warning.message for warning in made.warnings if warning.code == "S362"]
    assert told == ["spin reads nothing that is sensed: an imitation"]
