"""Angles on the circle: across the seam, over many turns, in degrees, and in guards."""

from pathlib import Path

import numpy as np
import pytest

from runtime.arrays import Array
from specc.loading import load_program
from tests.verifier.fidelity.switching_robots import Leave, Robot, run
from verifier.fidelity.verify import judgement_of, verify
from verifier.report.report import Report, Standing, Verdict
from verifier.report.switching import Switching
from verifier.traces.read import read_trace

SPEC = """
specc: 1
kind: behavior
name: lookout
about: Turns round and round, slowly where it looks back, across the seam of its heading.
state:
  heading:
    unit: deg
    kind: periodic
    domain: [-180, 180]
    role: both
    relates: {agent: heading, environment: north}
  pace:
    kind: discrete
    values: [fast, slow]
    role: both
    relates: {agent: gait, environment: north}
control:
  fast: {unit: deg/s, domain: [10, 200], default: 90}
  slow: {unit: deg/s, domain: [10, 200], default: 30}
field:
  modes:
    of: pace
    each:
      fast:
        formula: {heading: fast}
        leave: [{when: cos(heading) <= -0.9, to: slow}]
      slow:
        formula: {heading: slow}
        leave: [{when: cos(heading) >= -0.8, to: fast}]
fidelity: {tolerance: {heading: 5 deg}, horizon: 1 s}
trace:
  heading: {path: heading_deg, unit: deg}
  pace: pace
  fast: {constant: 90}
  slow: {constant: 30}
"""


def lookout(slow: float, leaves: float) -> Robot:
    return Robot(
        {"fast": lambda *_: [np.deg2rad(90.0)], "slow": lambda *_: [np.deg2rad(slow)]},
        {
            "fast": [Leave(lambda s: -0.9 - np.cos(s[0]), "slow")],
            "slow": [Leave(lambda s: np.cos(s[0]) - leaves, "fast")],
        },
        step=0.1,
    )


def written(folder: Path, robot: Robot, low: float, seed: int) -> Path:
    """A log of 80 s at 20 Hz, its heading in degrees within [low, low + 360)."""
    times = np.arange(0.0, 80.0, 0.05)
    states, modes = run(robot, "fast", [0.3], times)
    noise = np.deg2rad(1.0) * np.random.default_rng(seed).standard_normal(len(times))
    measured = wrapped(np.rad2deg(states[:, 0] + noise), low)
    rows = [f"{t:.3f},{h:.4f},{m}" for t, h, m in zip(times, measured, modes, strict=True)]
    path = folder / "log.csv"
    path.write_text("\n".join(["t,heading_deg,pace", *rows]) + "\n")
    return path


def wrapped(degrees: Array, low: float) -> Array:
    return low + np.mod(degrees - low, 360.0)


def judged(folder: Path, robot: Robot, low: float, seed: int) -> tuple[Report, Switching]:
    spec = folder / "lookout.yaml"
    spec.write_text(SPEC)
    program = load_program(spec)
    trace = read_trace(written(folder, robot, low, seed), program, "auto")
    switching = judgement_of(program, trace).switching
    assert switching is not None
    return verify(program, trace), switching


@pytest.mark.parametrize("low", [-180.0, 0.0])
def test_a_heading_that_winds_across_the_seam_in_degrees_passes(tmp_path: Path, low: float) -> None:
    report, found = judged(tmp_path, lookout(30.0, -0.8), low, 1)

    [heading] = report.variables
    assert report.verdict is Verdict.PASS
    assert np.nanmax(np.abs(heading.errors)) < np.deg2rad(8.0)
    assert {way.standing for way in found.ways} == {Standing.WITHIN}


def test_a_guard_that_opens_beyond_the_seam_is_timed(tmp_path: Path) -> None:
    report, found = judged(tmp_path, lookout(30.0, -0.6), -180.0, 2)

    # It leaves the slow turn at 360 - 126.9 deg instead of 360 - 143.1 deg.
    timing = found.ways[1].timing
    assert timing is not None
    assert timing.late == pytest.approx((143.13 - 126.87) / 30.0, abs=0.05)
    assert timing.allowed == pytest.approx(5.0 / 30.0, rel=0.05)
    assert timing.standing is Standing.EXCEEDED
    assert report.verdict is Verdict.FAIL
    assert {each.standing for each in report.variables} == {Standing.WITHIN}


def test_a_turn_that_is_too_slow_beyond_the_seam_is_an_error_of_the_heading(
    tmp_path: Path,
) -> None:
    report, found = judged(tmp_path, lookout(20.0, -0.8), -180.0, 3)

    [heading] = report.variables
    assert report.verdict is Verdict.FAIL
    assert heading.standing is Standing.EXCEEDED
    assert found.ways[1].standing is Standing.WITHIN
