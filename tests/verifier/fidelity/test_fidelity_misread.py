"""Logs in degrees for radians, centimetres for metres, milliseconds for seconds: told as that."""

from pathlib import Path

import numpy as np
import pytest

from runtime.arrays import Array
from specc.loading import load_program
from verifier.fidelity.judging.outside import Outside, outside_of
from verifier.fidelity.judging.verdict import Finding, with_outside
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.verify import verify
from verifier.report.report import Report, Verdict
from verifier.traces.read import read_trace

SPEC = """
specc: 1
kind: behavior
name: turner
about: Turns at the pace it is told, and faster near a wall.
state:
  heading:
    unit: rad
    kind: periodic
    domain: [-pi, pi]
    role: both
    relates: {agent: heading, environment: north}
  far:
    unit: m
    domain: [0.2, 4]
    role: sensed
    relates: {agent: front, environment: wall}
control:
  pace: {unit: rad/s, domain: [0, 2], default: 1}
constants:
  reach: {value: 0.1, unit: m}
field:
  formula: {heading: pace * (1 + reach / far)}
fidelity: {tolerance: {heading: 0.1 rad}, horizon: 1 s}
"""
FAR = 2.0


def told(
    folder: Path,
    pace: float,
    *,
    seconds: float = 30.0,
    angle: float = 1.0,
    is_wrapped: bool = False,
    far: float = 1.0,
    time: float = 1.0,
    begin: float = 0.5,
) -> Report:
    """Of a faithful robot whose log has its columns so many times as large."""
    (folder / "turner.yaml").write_text(SPEC)
    times = np.arange(0.0, seconds, 0.05)
    turned: Array = begin + pace * (1.0 + 0.1 / FAR) * times
    if is_wrapped:
        turned = (turned + np.pi) % (2.0 * np.pi) - np.pi
    noisy = turned + 0.005 * np.random.default_rng(4).standard_normal(times.size)
    rows = [
        f"{t * time:.6f},{a * angle:.6f},{FAR * far},{pace}"
        for t, a in zip(times, noisy, strict=True)
    ]
    log = folder / "run.csv"
    log.write_text("\n".join(["time,heading,far,pace", *rows]) + "\n")
    program = load_program(folder / "turner.yaml", allow_code=False)
    return verify(program, read_trace(log, program))


def test_an_angle_that_counts_its_turns_is_none_in_another_unit(tmp_path: Path) -> None:
    assert told(tmp_path, 1.5).verdict is Verdict.PASS


def test_a_log_cut_from_one_that_counted_turns_is_none_in_another_unit(tmp_path: Path) -> None:
    assert told(tmp_path, 1.5, begin=40.0).verdict is Verdict.PASS


@pytest.mark.parametrize("pace", [0.05, 0.3, 1.5])
@pytest.mark.parametrize("seconds", [4.0, 60.0])
def test_degrees_for_radians_of_an_angle_that_goes_round_are_told(
    tmp_path: Path, pace: float, seconds: float
) -> None:
    degrees = 180.0 / np.pi
    report = told(tmp_path, pace, seconds=seconds, angle=degrees, is_wrapped=True)
    assert report.verdict is Verdict.INCONCLUSIVE
    assert "heading lies outside its domain for " in report.reasons[0]
    assert "read in deg, it would lie inside" in report.reasons[0]
    assert "`heading: {path: heading, unit: deg}`" in report.advice[0]


def test_centimetres_for_metres_under_the_variables_own_name_are_told(tmp_path: Path) -> None:
    report = told(tmp_path, 1.0, far=100.0)
    assert report.verdict is Verdict.INCONCLUSIVE
    assert "it reads 200 to 200 m, the domain is 0.2 to 4 m" in report.reasons[0]
    assert "read in mm or cm, it would lie inside" in report.reasons[0]


@pytest.mark.parametrize(
    ("time", "unit", "column"),
    [(1e3, "milliseconds", "time_ms"), (1e6, "microseconds", "time_us")],
)
def test_milliseconds_for_seconds_are_told(
    tmp_path: Path, time: float, unit: str, column: str
) -> None:
    report = told(tmp_path, 1.0, time=time)
    assert report.verdict is Verdict.INCONCLUSIVE
    assert f"as if {unit} were taken for seconds" in report.reasons[0]
    assert "times are column 'time' in seconds (no unit in its name)" in report.reasons[0]
    assert f"`{column}`" in report.advice[0]


@pytest.mark.parametrize(
    ("is_far", "verdict"), [(True, Verdict.INCONCLUSIVE), (False, Verdict.FAIL)]
)
def test_nobody_fails_by_what_is_far_from_what_was_meant(*, is_far: bool, verdict: Verdict) -> None:
    outside = Outside("far lies outside", "log far in m", is_far, is_slip=False)
    found = with_outside(Finding(Verdict.FAIL, ("it departs",), ()), [outside])
    assert found.verdict is verdict
    assert found.advice == ("log far in m",)


def test_what_lies_a_little_beyond_its_domain_is_not_far_from_what_was_meant(
    tmp_path: Path,
) -> None:
    assert "read in" not in told(tmp_path, 1.0, far=3.0).reasons[0]
    program = load_program(tmp_path / "turner.yaml", allow_code=False)
    trace = read_trace(tmp_path / "run.csv", program)
    (near,) = outside_of(program, needs_of(program, trace))
    assert not near.is_far
