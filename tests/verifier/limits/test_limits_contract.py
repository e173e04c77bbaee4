"""What the self-test says is caught fails, planted into the recording; what is not, does not."""

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from runtime.code import Code
from runtime.program import Guard, Kind, Program
from specc.cli import main
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.verify import judged, verify
from verifier.limits.faults import faults_of
from verifier.limits.lanes import Lane
from verifier.limits.planting import copy_of, plant
from verifier.limits.self_test import smallest_caught
from verifier.report.limits import Caught, Fault
from verifier.report.report import Verdict
from verifier.traces.trace import Trace

FAR = np.inf


def with_sensor_off(trace: Trace, caught: Caught, size: float) -> Trace:
    """The log with a constant added to one column."""
    series = trace.series[caught.variable]
    off = replace(series, values=series.values + size)
    return replace(trace, series={**trace.series, caught.variable: off})


def with_faults(
    program: Program, trace: Trace, study: Study, told: list[tuple[Caught, float]]
) -> list[Trace]:
    """The logs of robots with the faults, of these sizes, integrated anew."""
    assert program.fidelity is not None
    planned = {(p.fault, p.variable): p for p in faults_of(program, program.fidelity, study)}
    lanes = tuple(Lane(planned[each.fault, each.variable], size) for each, size in told)
    plantings = plant(study, lanes)
    return [
        with_sensor_off(trace, each, size)
        if each.fault is Fault.SENSOR
        else copy_of(trace, plantings, i, np.random.default_rng(1))
        for i, (each, size) in enumerate(told)
    ]


def wandering_base(scenes: ModuleType) -> tuple[Program, Trace]:
    program = scenes.unicycle()
    judged_by = scenes.fidelity({"x": 0.05, "y": 0.05, "heading": 0.03}, 2.0)
    return replace(program, fidelity=judged_by), scenes.unicycle_drive(3, 40.0, 0.005)


def swinging(scenes: ModuleType) -> tuple[Program, Trace]:
    return scenes.van_der_pol(), scenes.van_der_pol_drive(2, 30.0, 0.01)


def wall_follower(scenes: ModuleType) -> tuple[Program, Trace]:
    """Distance and heading under a wanted distance that jumps every 3 s."""
    program = scenes.program(
        (scenes.state("distance", 0.1, 1.9), scenes.state("heading", -1.4, 1.4)),
        (scenes.control("wanted", 0.4, 1.2, 0.8),),
        {
            "distance": "0.4 heading sin mul",
            "heading": "wanted distance sub 2 mul 2 heading mul sub",
        },
        scenes.fidelity({"distance": 0.03, "heading": 0.04}, 2.0),
    )
    rng = np.random.default_rng(4)
    times, jumps = np.arange(0.0, 30.0, 0.05), np.arange(0.0, 30.0, 3.0)
    wanted = rng.uniform(0.6, 1.0, len(jumps))

    def rate(t: float, s: np.ndarray) -> list[float]:
        now = wanted[min(int((t + 1e-9) // 3.0), len(wanted) - 1)]
        return [0.4 * np.sin(s[1]), 2.0 * (now - s[0]) - 2.0 * s[1]]

    states = scenes.integrated(rate, [0.8, 0.0], times, 0.02)
    states = states + rng.standard_normal(states.shape) * [0.005, 0.01]
    return program, scenes.trace(
        scenes.series("distance", times, states[:, 0]),
        scenes.series("heading", times, states[:, 1]),
        scenes.series("wanted", jumps, wanted),
    )


@pytest.mark.parametrize("scene", [wandering_base, swinging, wall_follower])
def test_the_sizes_told_are_what_the_verdict_does_with_the_whole_trace(
    scenes: ModuleType, scene: Callable[[ModuleType], tuple[Program, Trace]]
) -> None:
    program, trace = scene(scenes)
    report, study = judged(program, trace)
    assert report.verdict is not Verdict.FAIL

    found, _ = smallest_caught(program, trace, report, study=study)

    assert any(each.is_caught for each in found)
    assert study is not None
    told = [(e, size) for e in found for size in (e.smallest, e.largest) if 0.0 < size < FAR]
    much, little = (
        with_faults(program, trace, study, [(e, side * size) for e, size in told])
        for side in (1.0, -1.0)
    )
    for (each, size), copies in zip(told, zip(much, little, strict=True), strict=True):
        fails = all(verify(program, copy).verdict is Verdict.FAIL for copy in copies)
        assert fails == (size == each.smallest), each.sentence


def heater(scenes: ModuleType) -> tuple[Program, Trace]:
    """Heats up to 0.5 and cools down to -0.5; log 3 seconds each way."""
    mode = scenes.state("mode", 0.0, 1.0, kind=Kind.DISCRETE, values=("heat", "cool"))
    plain = scenes.program(
        (scenes.state("x", -2.0, 2.0), mode),
        (),
        {"x": "mode 0 eq 1 x sub -1 x sub where"},
        scenes.fidelity({"x": 0.1}, 0.5),
    )
    guards = (
        Guard(0, 1, Code("x 0.5 sub"), (), "spec.yaml:21:7"),
        Guard(1, 0, Code("-0.5 x sub"), (), "spec.yaml:24:7"),
    )
    times, half = np.arange(0.0, 40.0, 0.05), np.log(3.0)
    phase = times % (2.0 * half)
    rising = phase < half
    x = np.where(rising, 1.0 - 1.5 * np.exp(-phase), -1.0 + 1.5 * np.exp(-(phase - half)))
    noisy = x + 0.003 * np.random.default_rng(1).standard_normal(len(x))
    trace = scenes.trace(
        scenes.series("x", times, noisy), scenes.series("mode", times, np.where(rising, 0.0, 1.0))
    )
    return replace(plain, field=replace(plain.field, mode="mode", guards=guards)), trace


def test_a_fault_that_only_the_changes_of_mode_show_counts_as_caught(scenes: ModuleType) -> None:
    """x seen 0.15 too high: within a mode that costs 0.06 in half a second, which is allowed."""
    program, trace = heater(scenes)
    report, study = judged(program, trace)
    assert report.verdict is not Verdict.FAIL

    found, _ = smallest_caught(program, trace, report, study=study)

    [sensor] = [each for each in found if each.fault is Fault.SENSOR]
    assert sensor.smallest < 0.2
    assert sensor.shown_by == ("changes of mode",)
    assert "seen in changes of mode" in sensor.sentence
    copies = [with_sensor_off(trace, sensor, side * sensor.smallest) for side in (1.0, -1.0)]
    assert [verify(program, copy).verdict for copy in copies] == [Verdict.FAIL] * 2


SPEC = """\
specc: 1
kind: behavior
name: settle
about: x goes to its goal.
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: mark}}
control:
  goal: {unit: m, domain: [-1, 1], default: 0}
constants:
  pace: {value: 1, unit: 1/s}
field:
  formula:
    x: pace * (goal - x)
feasibility: {level: demonstrated, evidence: a test}
fidelity:
  tolerance: {x: 0.05 m}
  horizon: 1 s
trace:
  x: x
  goal: goal
"""


def logged(path: Path, more: float) -> Path:
    """A robot that follows a goal which jumps every 2 s; its x is shown `more` too high."""
    rng = np.random.default_rng(8)
    goals, x = rng.uniform(-0.9, 0.9, 20), 0.0
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["t", "x", "goal"])
        for k in range(800):
            goal = goals[k // 40]
            shown = x + 0.003 * rng.standard_normal() + more
            rows.writerow([f"{0.05 * k:.2f}", f"{shown:.5f}", f"{goal:.5f}"])
            x = goal + (x - goal) * np.exp(-0.05)
    return path


def test_the_command_fails_files_with_what_it_said_it_would_catch(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spec = tmp_path / "settle.yaml"
    spec.write_text(SPEC)

    def status(name: str, more: float, *options: str) -> int:
        file = logged(tmp_path / name, more)
        return main(["verify", str(file), "--spec", str(spec), *options])

    status("plain.csv", 0.0, "--format", "json")
    [sensor] = [
        each
        for each in json.loads(capsys.readouterr().out)["limits"]["caught"]
        if each["fault"] == "sensor"
    ]
    caught, missed = sensor["smallest"], sensor["largest_not_caught"]

    assert [status("caught.csv", side * caught, "--quick") for side in (1, -1)] == [1, 1]
    assert [status("missed.csv", side * missed, "--quick") for side in (1, -1)] != [1, 1]
