"""Principle 2d: any number of behaviors may be active at once, and nothing is distorted by it."""

import time
from functools import cache

import numpy as np

from runtime.run import Run, run
from tests.principles.scenes import WATCH, halt, robot, scenario

MANY = 100


@cache
def runs() -> tuple[Run, Run, float]:
    """A robot with one behavior, the same with a hundred more; and how much longer that took."""
    found, took = [], []
    for count in (0, MANY):
        more = {f"eye{n}": WATCH.format(10 + 10 * (n % 5)) for n in range(count)}
        made = scenario(
            robot("[1.5 m, 1.5 m]", halt=halt("50 ms", near="2 m"), **more), duration="2 s"
        )
        begun = time.process_time()
        found.append(run(made))
        took.append(time.process_time() - begun)
    return found[0], found[1], took[1] / took[0]


def shifted() -> int:
    """How many coordinates of the way differ."""
    alone, among, _ = runs()
    return int((alone.world.poses != among.world.poses).sum())


def test_a_hundred_behaviors_more_change_no_place_and_no_time() -> None:
    """2d: the first goes on as it did alone, to the last bit, though there is more to process."""
    alone, among, longer = runs()
    one, same = alone.robots[0].nodes[0], among.robots[0].nodes[0]

    assert longer > 1.5
    assert len(alone.world.poses) == len(among.world.poses)
    assert shifted() == 0
    assert np.array_equal(one.times, same.times)
    assert np.array_equal(one.register, same.register)


@cache
def missed() -> int:
    """Ticks that any of all these behaviors missed, or was not active at."""
    _, among, _ = runs()
    nodes = among.scenario.robots[0].architecture.nodes
    return sum(
        round(among.duration / node.period) - int(track.acts.sum())
        for node, track in zip(nodes, among.robots[0].nodes, strict=True)
    )


def test_all_of_them_are_active_at_each_of_their_instants() -> None:
    """2d: none waits until another is done."""
    _, among, _ = runs()
    ticks = sum(len(track.times) for track in among.robots[0].nodes)

    assert missed() == 0
    assert ticks > 8000
    for track in among.robots[0].nodes[1:]:  # all that sample at an instant sample the same
        rows = np.searchsorted(among.robots[0].nodes[0].times, track.times - 1e-9)
        assert np.array_equal(track.register[:, 0], among.robots[0].nodes[0].register[rows, 0])
