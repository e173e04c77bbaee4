from types import ModuleType

import numpy as np

from verifier.fidelity.judging.regions import coverage_of
from verifier.fidelity.verify import verify
from verifier.report.report import CellAxis, Verdict


def axis(scenes: ModuleType, name: str, low: float, high: float, count: int) -> CellAxis:
    return CellAxis(name, scenes.ONE, low, high, count)


def test_a_cell_is_seen_with_three_samples(scenes: ModuleType) -> None:
    axes = (axis(scenes, "x", 0.0, 1.0, 4),)
    values = np.array([[0.1], [0.1], [0.1], [0.3], [0.3], [0.9], [0.9], [1.0], [1.5], [-1.0]])

    found = coverage_of(axes, values, 0.5)

    assert found.samples.tolist() == [3, 2, 0, 3]
    assert found.share == 0.5
    assert found.is_reached


def test_cells_of_two_axes_stand_in_their_order(scenes: ModuleType) -> None:
    axes = (axis(scenes, "x", 0.0, 1.0, 2), axis(scenes, "v", -1.0, 1.0, 3))

    found = coverage_of(axes, np.array([[0.9, -0.9]] * 4), 0.5)

    assert found.samples.tolist() == [[0, 0, 0], [4, 0, 0]]


def test_a_robot_that_is_weak_on_one_side_fails_there(scenes: ModuleType) -> None:
    spec = scenes.program(
        (scenes.state("x", -5.0, 5.0),),
        (scenes.control("goal", -3.0, 3.0, 0.0),),
        {"x": "goal x sub"},
        scenes.fidelity({"x": 0.1}, 1.0),
    )
    rng = np.random.default_rng(6)
    switches = np.arange(0.0, 240.0, 2.0)
    goals = rng.uniform(-3.0, 3.0, len(switches))
    times = np.arange(0.0, 240.0, 0.05)
    goal = goals[np.searchsorted(switches, times, side="right") - 1]
    x = np.zeros(len(times))
    for k in range(len(times) - 1):
        # Exact between samples; only half as quick where it has to go far down.
        rate = 0.8 if goal[k] < -1.5 else 1.0
        x[k + 1] = goal[k] + (x[k] - goal[k]) * np.exp(-rate * 0.05)
    drive = scenes.trace(
        scenes.series("x", times, x + 0.005 * rng.standard_normal(len(x))),
        scenes.series("goal", switches, goals),
    )

    report = verify(spec, drive)

    assert report.verdict is Verdict.FAIL
    worst = report.variables[0].worst
    assert worst is not None
    assert worst.mean > 0.0
    assert worst.bounds["goal"][1] < 0.0
    assert "goal is -" in report.reasons[0].split("where ", 1)[1]
    assert "above the prediction" in report.reasons[0]
