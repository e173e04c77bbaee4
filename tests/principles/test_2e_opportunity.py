"""Principle 2e: how often a behavior can act follows from its times, not from its world's cost."""

import time
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from runtime.run import Run, run
from tests.principles.scenes import halt, robot, scenario

PERIODS = (10, 20, 50, 100)
"""Milliseconds, of a behavior that answers as late as its period is long."""
LAMPS = "".join(
    f"  l{k}: {{at: [{4.6 + 0.06 * k:.2f}, 2.5], power: 1 cd, height: 50 cm}}\n" for k in range(70)
)
SCREENED = """
arena: {box: [9 m, 3 m]}
things:
  screen: {shape: {box: [0.1, 2.8]}, at: [4, 1.5], fixed: true, height: [0, 2 m]}
"""
CHEAP = SCREENED + "lights: {l0: {at: [5, 2.5], power: 1 cd, height: 50 cm}}\n"
COSTLY = f"""{SCREENED}
scatter:
  box: {{shape: {{box: [10 cm, 8 cm]}}, count: 60, mass: 0.3 kg, gap: 2 cm,
        area: [[4.1, 0.2], [8.8, 2.8]]}}
lights:
{LAMPS}"""


@cache
def runs() -> tuple[Run, Run, float]:
    """The same robot before a screen: an empty room behind it, or a crowded one with 70 lamps.

    A second robot, behind the screen, ploughs through what is there, and the light on the floor is
    worked out ten times a second. And how much longer it took.
    """
    found, took = [], []
    for world in (CHEAP, COSTLY):
        made = scenario(
            robot("[1.5 m, 1.5 m]", halt=halt("50 ms", near="1.5 m")),
            robot("[4.6 m, 1.5 m]", halt=halt(near="0 m")),
            world=world,
            duration="3 s",
        )
        run(
            replace(made, duration=0.1), light_every=0.1
        )  # what is compiled or loaded once does not count
        begun = time.process_time()
        found.append(run(made, light_every=0.1))
        took.append(time.process_time() - begun)
    return found[0], found[1], took[1] / took[0]


def test_an_environment_that_costs_more_gives_a_behavior_no_fewer_opportunities() -> None:
    """2e: it samples and acts at the same instants, and meets the same world there."""
    cheap, costly, longer = runs()
    one, same = cheap.robots[0], costly.robots[0]

    assert longer > 1.5
    assert np.array_equal(one.nodes[0].times, same.nodes[0].times)
    assert np.array_equal(one.nodes[0].register[:, 0], same.nodes[0].register[:, 0])
    assert np.array_equal(one.channels.times, same.channels.times)
    assert np.array_equal(one.channels.set_points, same.channels.set_points)


@cache
def opportunities() -> dict[int, int]:
    """By period and response time in ms: how often a behavior acted anew in 2 s."""
    found = {}
    for period in PERIODS:
        node = halt(f"{period} ms", near="0 m", period=f"{period} ms")
        made = run(scenario(robot("[1.5 m, 1.5 m]", halt=node), duration="2 s"))
        track = made.robots[0].nodes[0]
        acted = track.times[track.acts] + period / 1e3
        found[period] = int((acted <= 2.0 + 1e-9).sum())
    return found


@pytest.mark.parametrize("period", PERIODS)
def test_a_behavior_twice_as_quick_has_twice_the_opportunities(period: int) -> None:
    """2e: one act for each of its own periods, and nothing else counts."""
    assert opportunities()[period] == 2000 // period
