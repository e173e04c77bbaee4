"""Robots with the faults that the self-test says are caught fail; with smaller ones they don't."""

import csv
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from runtime.code import Code
from runtime.program import Guard, Kind, Program
from specc.cli import main
from verifier.fidelity.verify import judged, verify
from verifier.limits.self_test import smallest_caught
from verifier.report.limits import Fault
from verifier.report.report import Verdict
from verifier.traces.trace import Trace

FAR = np.inf
LEEWAY = 0.1
"""A robot integrated apart is elsewhere than a copy; sizes stand 30 % apart."""

Rate = Callable[[np.ndarray, Mapping[str, np.ndarray]], list[np.ndarray]]
Planted = tuple[Fault, str, float]


@dataclass(frozen=True)
class Robot:
    """A robot's true rates, its inputs as logged, and the noise of its sensors."""

    rate: Rate
    start: tuple[float, ...]
    times: np.ndarray
    noise: Mapping[str, float]
    inputs: Mapping[str, tuple[np.ndarray, np.ndarray]]

    def drives(self, scenes: ModuleType, planted: list[Planted]) -> list[Trace]:
        """Logs of robots with one fault each, integrated by scipy; their noise is the same."""

        def sizes(kind: Fault, name: str) -> np.ndarray:
            return np.array([s if (f, n) == (kind, name) else 0.0 for f, n, s in planted])

        gain, offset, shown = (
            np.array([sizes(kind, name) for name in self.noise])
            for kind in (Fault.GAIN, Fault.OFFSET, Fault.SENSOR)
        )
        late = {name: sizes(Fault.DELAY, name) for name in self.inputs}

        def faulty(t: float, states: np.ndarray) -> np.ndarray:
            told = {
                name: values[np.maximum(np.searchsorted(times, t - late[name], "right") - 1, 0)]
                for name, (times, values) in self.inputs.items()
            }
            rates = np.array(self.rate(states.reshape(len(self.start), -1), told))
            return np.ravel((1.0 + gain) * rates + offset)

        start = np.repeat(self.start, len(planted))
        states = scenes.integrated(faulty, start, self.times, 0.2)
        states = states.reshape(len(self.times), len(self.start), -1)
        deviations = np.array(list(self.noise.values()))
        noise = deviations * np.random.default_rng(7).standard_normal(states.shape[:2])
        states = states + shown + noise[..., None]
        inputs = [scenes.series(name, *told) for name, told in self.inputs.items()]
        return [
            scenes.trace(
                *(scenes.series(n, self.times, states[:, j, i]) for j, n in enumerate(self.noise)),
                *inputs,
            )
            for i in range(len(planted))
        ]


def wandering_base(scenes: ModuleType) -> tuple[Program, Robot]:
    """A base under commands that change every 0.7 s."""
    judged_by = scenes.fidelity({"x": 0.05, "y": 0.05, "heading": 0.03}, 2.0)
    rng, jumps = np.random.default_rng(3), np.arange(0.0, 15.0, 1.1)
    robot = Robot(
        lambda s, u: [u["speed"] * np.cos(s[2]), u["speed"] * np.sin(s[2]), u["turn"]],
        (0.0, 0.0, 1.0),
        np.arange(0.0, 15.0, 0.1),
        {"x": 0.005, "y": 0.005, "heading": 0.005},
        {
            "speed": (jumps, rng.uniform(0.2, 1.0, len(jumps))),
            "turn": (jumps, rng.uniform(-0.6, 0.8, len(jumps))),
        },
    )
    return replace(scenes.unicycle(), fidelity=judged_by), robot


def swinging(scenes: ModuleType) -> tuple[Program, Robot]:
    """An oscillator that nothing drives."""
    robot = Robot(
        lambda s, _: [s[1], (1.0 - s[0] ** 2) * s[1] - s[0]],
        (0.8, -0.5),
        np.arange(0.0, 30.0, 0.05),
        {"x": 0.01, "v": 0.01},
        {},
    )
    return scenes.van_der_pol(), robot


def wall_follower(scenes: ModuleType) -> tuple[Program, Robot]:
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
    jumps = np.arange(0.0, 30.0, 3.0)
    robot = Robot(
        lambda s, u: [0.4 * np.sin(s[1]), 2.0 * (u["wanted"] - s[0]) - 2.0 * s[1]],
        (0.8, 0.0),
        np.arange(0.0, 30.0, 0.05),
        {"distance": 0.005, "heading": 0.01},
        {"wanted": (jumps, np.random.default_rng(4).uniform(0.6, 1.0, len(jumps)))},
    )
    return program, robot


@pytest.mark.parametrize("scene", [wandering_base, swinging, wall_follower])
def test_robots_with_faults_of_the_sizes_told_fail_or_not_as_was_said(
    scenes: ModuleType, scene: Callable[[ModuleType], tuple[Program, Robot]]
) -> None:
    """They are integrated apart, from the same start, and the whole log of each is judged."""
    program, robot = scene(scenes)
    (trace,) = robot.drives(scenes, [(Fault.OFFSET, "", 0.0)])
    report, study = judged(program, trace)
    assert report.verdict is not Verdict.FAIL

    found, _ = smallest_caught(program, trace, report, study=study)

    assert any(each.is_caught for each in found)
    told = [
        (each, is_caught, factor * size)
        for each in found
        for size, is_caught, factor in (
            (each.smallest, True, 1.0 + LEEWAY),
            (each.largest, False, 1.0 - LEEWAY),
        )
        if 0.0 < size < FAR
    ]
    logs = iter(
        robot.drives(scenes, [(e.fault, e.variable, s * z) for e, _, z in told for s in (1, -1)])
    )
    for (each, is_caught, _), *copies in zip(told, logs, logs, strict=True):
        fails = all(verify(program, copy).verdict is Verdict.FAIL for copy in copies)
        assert fails == is_caught, each.sentence


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
    x = trace.series["x"]
    for side in (1.0, -1.0):
        off = replace(x, values=x.values + side * sensor.smallest)
        copy = replace(trace, series={**trace.series, "x": off})
        assert verify(program, copy).verdict is Verdict.FAIL


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
    goals, x = rng.uniform(-0.9, 0.9, 10), 0.0
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["t", "x", "goal"])
        for k in range(400):
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
