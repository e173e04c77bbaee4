"""A procedure is for robots with a module's own timing: they pass, and who departs fails."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.arrays import Array
from runtime.program import Program
from specc.loading import load_program
from verifier.fidelity.together import verify_together
from verifier.fidelity.verify import fidelity_of
from verifier.procedure.behavior import procedure_of, rounded_down
from verifier.procedure.driving import Plans, driven_paths, inputs_of
from verifier.procedure.lateness import BORNE, is_clear, lateness_of, paths_of
from verifier.procedure.model import Procedure
from verifier.procedure.robot import Robot
from verifier.procedure.usable import within_reach
from verifier.procedure.wording import procedure_sentences
from verifier.report.report import Verdict
from verifier.traces.trace import Series, Trace

SPECS = Path(__file__).parents[3] / "specs"
HELD = {"gain": (1.5,), "speed": (0.25,)}
ROBOT = Robot(0.1, 0.05, HELD, {"distance": (0.0, 2.0)}, {"bearing": 0.0175})


@pytest.fixture(scope="module")
def phototaxis() -> Program:
    return load_program(SPECS / "phototaxis.yaml", allow_code=False)


@pytest.fixture(scope="module")
def avoid() -> Program:
    return load_program(SPECS / "avoid.yaml", allow_code=False)


@pytest.fixture(scope="module")
def procedure(phototaxis: Program) -> Procedure:
    return procedure_of(phototaxis, ROBOT)


def towards_the_light(start: tuple[float, float], seconds: float, gain: float) -> Array:
    """Rows of time, bearing, distance of a robot on a plane whose wheels take time to follow.

    Every 0.1 s it reads, 0.05 s later its wheels are told to turn by gain * sin(bearing); they
    change that by 20 rad/s in a second.
    """
    step, speed = 0.005, 0.25
    bearing, distance = start
    light = distance * np.array([np.cos(bearing), np.sin(bearing)])
    place, heading, told, turn = np.zeros(2), 0.0, [], gain * np.sin(bearing)
    queue, wanted = [], turn
    for k in range(round(seconds / step) + 1):
        apart = light - place
        distance = float(np.hypot(*apart))
        bearing = float(np.angle(np.exp(1j * (np.arctan2(apart[1], apart[0]) - heading))))
        if k % 20 == 0:
            queue.append((k + 10, gain * np.sin(bearing)))
        while queue and queue[0][0] <= k:
            wanted = queue.pop(0)[1]
        if k % 10 == 0:
            told.append((k * step, bearing, distance))
        turn += float(np.clip(wanted - turn, -20.0 * step, 20.0 * step))
        place = place + step * speed * np.array([np.cos(heading), np.sin(heading)])
        heading += step * turn
    return np.array(told)


def verdict(program: Program, procedure: Procedure, gain: float, seed: int) -> Verdict:
    rng = np.random.default_rng(seed)
    traces: list[Trace] = []
    for drive in procedure.drives:
        for _ in range(drive.repeats):
            start = (drive.start["bearing"], drive.start["distance"])
            rows = towards_the_light(start, drive.seconds, gain)
            noisy = rows[:, 1:] + rng.standard_normal((len(rows), 2)) * [0.0175, 0.01]
            columns = {"bearing": noisy[:, 0], "distance": noisy[:, 1]}
            columns |= {name: np.full(len(rows), *value) for name, value in HELD.items()}
            series = {n: Series(n, rows[:, 0], v, f"/{n}", "s") for n, v in columns.items()}
            traces.append(Trace(f"run {len(traces)}", series, {}, float(len(traces)), (), ()))
    return verify_together(replace(program, judge_when=None), traces).verdict


@pytest.mark.parametrize("seed", [1, 2])
def test_a_robot_as_late_as_its_module_passes_and_a_weak_one_fails(
    phototaxis: Program, procedure: Procedure, seed: int
) -> None:
    assert procedure.rate == 20.0
    assert verdict(phototaxis, procedure, 1.5, seed) is Verdict.PASS
    assert verdict(phototaxis, procedure, 0.7 * 1.5, seed) is Verdict.FAIL


def test_controls_are_held_at_what_the_architecture_sets(procedure: Procedure) -> None:
    assert {each.name for each in procedure.excited} <= {"distance"}
    for drive in procedure.drives:
        for stage in drive.stages:
            assert {name: (value,) for name, value in stage.held.items()} == HELD


def test_runs_start_within_the_reach_of_the_sensor(procedure: Procedure) -> None:
    assert all(0.2 < drive.start["distance"] < 2.0 for drive in procedure.drives)


def test_the_sensors_may_be_as_noisy_as_those_of_the_body(procedure: Procedure) -> None:
    assert {each.name: each.noise for each in procedure.signals}["bearing"] == 0.0175


def test_what_lateness_is_borne_is_told(procedure: Procedure) -> None:
    late = procedure.lateness
    assert late is not None
    assert 0.2 < late.share < 0.75
    told = " ".join(procedure_sentences(procedure))
    assert "a faithful robot that reads every 0.1 s and acts 0.05 s later gets PASS" in told
    assert "being so late alone takes up" in told


def test_a_run_in_which_lateness_breaks_the_tolerance_is_not_asked_for(
    phototaxis: Program,
) -> None:
    slow = Robot(0.3, 0.1)
    prompt = procedure_of(phototaxis, is_rehearsed=False)
    starts = np.array(
        [[drive.start["bearing"], drive.start["distance"]] for drive in prompt.drives]
    )
    held = np.array(
        [[[0.0, 0.0, s.held["gain"], s.held["speed"]] for s in d.stages[:1]] for d in prompt.drives]
    )
    plans = Plans(starts, held, inputs_of(phototaxis), 3.0)
    paths = paths_of(phototaxis, plans, slow, 0.05, 1)
    late = lateness_of(phototaxis, fidelity_of(phototaxis), plans, paths, 0.05)
    assert late.max() > 1.0
    found = procedure_of(phototaxis, slow, is_rehearsed=False).lateness
    assert found is not None
    assert found.share < BORNE


def test_a_sampled_robot_comes_to_follow_the_field_as_its_period_shrinks(
    phototaxis: Program,
) -> None:
    held = np.array([[[0.0, 0.0, 1.5, 0.25]]])
    plans = Plans(np.array([[2.0, 1.5]]), held, inputs_of(phototaxis), 2.0)
    prompt = driven_paths(phototaxis, plans, 0.05, 1).register[0, -1, 0]
    apart = [
        abs(paths_of(phototaxis, plans, Robot(p, p / 2.0), 0.05, 1).register[0, -1, 0] - prompt)
        for p in (0.2, 0.1, 0.02)
    ]
    assert apart[0] > 1.5 * apart[1] > 3.0 * apart[2]
    assert apart[2] < 0.02


def test_a_mode_changes_at_the_next_tick(avoid: Program) -> None:
    """Left falls from 1 m by 1 m/s, right stays: right >= left + 0.3 from 0.3 s on."""
    left, right, side = (avoid.register.index(name) for name in ("left", "right", "side"))
    start = np.zeros((1, len(avoid.states)))
    start[0, [left, right]] = 1.01, 1.0
    held = np.zeros((1, 1, len(avoid.states) + len(avoid.controls)))
    held[0, 0, [left, right]] = 0.01, 1.0
    plans = Plans(start, held, inputs_of(avoid), 1.0)
    paths = paths_of(avoid, plans, Robot(0.1, 0.05), 0.025, 1)
    first = paths.times[np.argmax(paths.register[0, :, side] == 1.0)]
    assert first == pytest.approx(0.4)
    heading = paths.register[0, :, avoid.register.index("heading")]
    assert paths.times[np.argmax(heading)] == pytest.approx(0.45)


def test_a_stage_that_ends_upon_a_threshold_is_not_clear(avoid: Program) -> None:
    left, right = (avoid.register.index(name) for name in ("left", "right"))
    held = np.zeros((2, 1, len(avoid.states) + len(avoid.controls)))
    held[:, 0, left], held[:, 0, right] = 0.5, (0.8, 1.2)
    start = np.ones((2, len(avoid.states)))
    plans = Plans(start, held, inputs_of(avoid), 1.0)
    paths = driven_paths(avoid, plans, 0.025, 1)
    noise = np.where([state.name in {"left", "right"} for state in avoid.states], 0.005, 0.0)
    assert is_clear(avoid, plans, paths, noise, 0.025).tolist() == [False, True]


def test_a_reach_narrows_what_is_only_sensed_and_no_declared_region(phototaxis: Program) -> None:
    fidelity = fidelity_of(phototaxis)
    robot = Robot(reach={"distance": (0.0, 2.0), "bearing": (0.0, 1.0)})
    near = {s.name: (s.low, s.high) for s in within_reach(phototaxis, robot, fidelity).states}
    assert near["distance"] == (0.2, 2.0)
    assert near["bearing"][0] < -3.0
    demanded = replace(fidelity, region={"distance": (0.5, 3.0)})
    kept = within_reach(phototaxis, robot, demanded)
    assert kept.states == phototaxis.states


def test_runs_last_round_times() -> None:
    lasts = np.array([9.0, 2.85, 0.95, 0.31])
    assert rounded_down(lasts, 0.05).tolist() == pytest.approx([9.0, 2.5, 0.9, 0.31])


def test_lateness_right_after_a_mode_changed_counts(avoid: Program) -> None:
    """Where it turns round at 2 rad/s the old command stands for 0.05 s too long: 0.1 rad or more.

    With readings near 0 the two turns differ by 4 rad/s, far away by a third of that.
    """
    left, right = (avoid.register.index(name) for name in ("left", "right"))
    start = np.zeros((2, len(avoid.states)))
    held = np.zeros((2, 1, len(avoid.states) + len(avoid.controls)))
    start[:, left], start[:, right] = (0.4, 1.9), (0.4, 1.9)
    held[:, 0, left], held[:, 0, right] = (0.0, 1.3), (0.4, 1.9)
    plans = Plans(start, held, inputs_of(avoid), 3.0)
    paths = paths_of(avoid, plans, Robot(0.1, 0.05), 0.025, 1)
    near, far = lateness_of(avoid, fidelity_of(avoid), plans, paths, 0.025)[:, 0]
    assert near > 1.0
    assert far < 0.75
