"""Principle 1e: an agent is situated: here and now decide, and it answers in time."""

from functools import cache

import numpy as np

from runtime.arrays import Array
from runtime.run import Run, run
from tests.principles.scenes import GO, PROBE, WATCH, halt, robot, scenario

RADIUS = 0.12
EVERY, PERIOD, RESPONSE = 0.01, 0.01, 0.1
"""Seconds: of the range sensor; of the behavior that halts; until it acts."""


@cache
def crossed() -> Run:
    """r0 looks along x and drives; r1 crosses its way; r2 goes away ahead of it. Four seconds."""
    return run(
        scenario(
            robot("[0.5 m, 1.5 m]", halt=halt(response="100 ms", near="0.8 m", pace="0.2 m/s")),
            robot("[1.6 m, 1 m, 90 deg]", go=GO),
            robot("[2.5 m, 1.5 m]", go=GO[:-1] + ", set: {speed: 0.1 m/s}}"),
            duration="4 s",
            step="5 ms",
        )
    )


def seen_along_x(me: Array, others: list[Array]) -> Array:
    """Metres from (x + 12 cm, y) along x to the nearest of discs of 12 cm, or to the wall at 4 m.

    me, others: (n, 2) places, one for each instant.
    """
    x, y = me[:, 0] + RADIUS, me[:, 1]
    nearest = np.minimum(4.0 - x, 3.0)
    for other in others:
        aside = other[:, 1] - y
        half = np.sqrt(np.clip(RADIUS**2 - aside**2, 0.0, None))
        ahead = other[:, 0] - half - x
        nearest = np.where((np.abs(aside) < RADIUS) & (ahead > 0.0), ahead, nearest).clip(
            max=nearest
        )
    return nearest


def truth() -> tuple[Array, Array]:
    """When all were looked at, and what r0 had to sense then, from where they were drawn."""
    poses = crossed().world.poses
    return crossed().world.times, seen_along_x(poses[:, 0, :2], [poses[:, 1, :2], poses[:, 2, :2]])


@cache
def staleness() -> float:
    """The largest difference (m) of what r0 was told and what there was at that very instant."""
    times, true = truth()
    told = crossed().signals["r0.ahead.range"]
    rows = np.rint(times / EVERY).astype(int)
    whole = np.abs(rows * EVERY - times) < 1e-9
    inside = whole & (rows < len(told.values))
    assert np.allclose(told.times[rows[inside]], times[inside])
    return float(np.abs(told.values[rows[inside]] - true[inside]).max())


def test_what_is_sensed_is_what_there_is_now() -> None:
    """1e: the world is its own best model, and always up to date, with all that moves."""
    _, true = truth()

    assert np.ptp(true) > 0.5  # it was crossed
    assert staleness() < 1e-9


@cache
def answered_after() -> float:
    """Seconds from the instant at which r1 came too near to the one at which r0 was braked."""
    times, true = truth()
    came = times[np.flatnonzero(true <= 0.8)[0]]
    channels = crossed().robots[0].channels
    braked = channels.times[np.flatnonzero(channels.set_points[:, 0] == 0.0)]
    return float(braked[braked > 0.15][0] - came)


def test_what_comes_in_its_way_is_answered_within_one_sample_one_period_and_its_response() -> None:
    """1e: a situated agent responds in a timely fashion, and not before there is anything."""
    look = 0.02  # the truth is looked at 50 times a second
    assert RESPONSE - look < answered_after() <= RESPONSE + PERIOD + EVERY


def test_a_thing_is_answered_only_once_it_can_be_seen() -> None:
    """1e: two worlds that differ beyond the reach of all sensors are one until they do not."""
    short = PROBE.replace("reach: 3 m", "reach: 1 m")
    near, far = (
        run(
            scenario(
                robot("[0.5 m, 1.5 m]", body=short, halt=halt(near="0.5 m"), eye=WATCH.format(10)),
                world="arena: {box: [6 m, 3 m]}\n"
                f"things: {{post: {{shape: {{box: [0.2, 0.2]}}, at: [{x}, 1.5], fixed: true}}}}",
                duration="5 s",
            )
        )
        for x in (2.2, 2.6)
    )
    one, other = near.robots[0].nodes, far.robots[0].nodes
    differ = np.flatnonzero((one[0].register != other[0].register).any(axis=1))
    came = np.flatnonzero(near.signals["r0.ahead.range"].values < 1.0)[0]

    assert differ[0] == came > 100
    assert np.array_equal(one[1].register[:came], other[1].register[:came])
    assert not np.array_equal(near.world.poses[-1, 1], far.world.poses[-1, 1])
