"""A sensor that sticks is told first; rest, commands and coarse sensors are no such thing."""

from types import ModuleType

import numpy as np
import pytest

from verifier.examination import examine
from verifier.fidelity.judging.stuck import stuck_of
from verifier.fidelity.stretches.needs import needs_of
from verifier.report.report import Verdict
from verifier.traces.trace import Trace

TIMES = np.arange(0.0, 30.0, 0.05)


def settling(scenes: ModuleType, shown: np.ndarray) -> tuple[object, Trace]:
    """x follows a goal that swings; the log shows it as `shown`."""
    program = scenes.program(
        (scenes.state("x", -2.0, 2.0),),
        (scenes.control("goal", -1.0, 1.0, 0.0),),
        {"x": "goal x sub"},
        scenes.fidelity({"x": 0.05}, 1.0),
    )
    goal = scenes.series("goal", TIMES, np.sin(TIMES))
    return program, scenes.trace(scenes.series("x", TIMES, shown), goal)


def faithful(noise: float = 0.002) -> np.ndarray:
    """The response of x' = sin t - x, long after its start, with noise."""
    rng = np.random.default_rng(2)
    return (np.sin(TIMES) - np.cos(TIMES)) / 2.0 + noise * rng.standard_normal(len(TIMES))


def test_a_stuck_sensor_is_told_before_all_else(scenes: ModuleType) -> None:
    shown = faithful()
    shown[300:] = shown[300]
    program, trace = settling(scenes, shown)

    report = examine(program, trace).report

    assert report.verdict is not Verdict.PASS
    assert report.advice[0].startswith("look whether the sensor of x was stuck")
    said = "x reads the very same number 300 times, from 15 to "
    assert any(note.startswith(said) for note in report.notes)


@pytest.mark.parametrize(
    "shown",
    [
        pytest.param(faithful(), id="noise"),
        pytest.param(np.round(faithful(), 1), id="a coarse sensor"),
        pytest.param(np.where(TIMES < 1.5, faithful(), 0.3), id="hardly ever moving"),
        pytest.param(np.where(TIMES > 28.5, 0.3, faithful()), id="a short pause"),
    ],
)
def test_what_has_other_reasons_is_no_stuck_sensor(scenes: ModuleType, shown: np.ndarray) -> None:
    program, trace = settling(scenes, shown)

    assert stuck_of(needs_of(program, trace)) == ()
