"""Principle 1f: the same laws for all agents, however much work one is to the computer."""

from functools import cache

import numpy as np

from runtime.arrays import Array
from runtime.run import run
from tests.principles.scenes import GO, PROBE, SPIN, WATCH, Started, robot, scenario, way

CELLS = 4
WIDE = 2.0


def cells(laden: int | None = None) -> Array:
    """(steps, CELLS, 2, 3): crate and robot in each of some equal cells, as seen from its corner.

    laden: the robot that has 30 more behaviors to run than the others.
    """
    things = "".join(
        f"  crate{k}: {{shape: {{box: [0.3, 0.2]}}, at: [{WIDE * k + 1}, 1], mass: 1 kg}}\n"
        for k in range(CELLS)
    )
    walls = "".join(
        f"  wall{k}: {{shape: {{box: [0.1, 3]}}, at: [{WIDE * (k + 1)}, 1.5], fixed: true}}\n"
        for k in range(CELLS - 1)
    )
    robots = []
    for k in range(CELLS):
        more = {f"eye{n}": WATCH.format(10) for n in range(30)} if k == laden else {}
        robots.append(robot(f"[{WIDE * k + 0.5} m, 0.95 m]", go=GO, spin=SPIN, **more))
    found = way(
        scenario(
            *robots,
            world=f"arena: {{box: [{WIDE * CELLS}, 3]}}\nthings:\n{things}{walls}",
            duration="3 s",
        )
    )
    both = np.stack([found[:, :CELLS], found[:, -CELLS:]], axis=2)
    both[..., 0] -= WIDE * np.arange(CELLS)[:, None]
    return both


@cache
def differences() -> float:
    """The largest difference (m, rad) of what goes on in the cells."""
    found = cells()
    return float(np.ptp(found, axis=1).max())


def test_the_same_goes_on_in_equal_cells_whichever_robot_is_named_first() -> None:
    """1f: each pushes its crate as every other does, up to roundings of where its cell is."""
    found = cells()

    assert found[-1, 0, 0, 0] > found[0, 0, 0, 0] + 0.1  # the crate was pushed
    assert differences() < 1e-6


def test_a_robot_with_thirty_more_behaviors_to_run_is_no_slower_and_no_faster() -> None:
    """1f: regardless of the processing load that an agent is: not one bit differs."""
    assert np.array_equal(cells(), cells(laden=CELLS - 1))


@cache
def advantage() -> float:
    """Metres by which the middle of two equal robots that push one another is off, after 4 s."""
    made = scenario(
        robot("[1 m, 1.5 m]", go=GO), robot("[3 m, 1.5 m, 180 deg]", go=GO), duration="4 s"
    )
    end = Started(made).finish()[:, 0]
    assert abs(end[1] - end[0] - 0.24) < 1e-3
    return abs(float(end.mean()) - 2.0)


def test_neither_of_two_equal_robots_that_push_one_another_wins() -> None:
    """1f: who is first in the scenario has no more force."""
    assert advantage() < 1e-4


def test_no_command_is_a_way_round_the_limits_of_a_drive() -> None:
    """1f: a body moves as its motors can: 2 m/s^2 up to 0.5 m/s, whatever it is told."""
    made = run(
        scenario(
            robot("[1 m, 1.5 m]", body=PROBE, go=GO[:-1] + ", set: {speed: 2 m/s}}"),
            robot("[1 m, 0.5 m]", body=PROBE, go=GO[:-1] + ", set: {speed: 0.5 m/s}}"),
            duration="1 s",
        )
    )
    fast, slow = (made.signals[f"r{k}.speed"] for k in (0, 1))

    assert np.array_equal(fast.values, slow.values)
    assert fast.values.max() <= 0.5 + 1e-9
    assert (fast.values <= 2.0 * fast.times + 1e-9).all()
