"""What is planted, against closed forms and against robots that have the fault themselves."""

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.code import Code
from runtime.program import Guard, Kind, Program, Role
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.spans import contains
from verifier.fidelity.verify import judged
from verifier.limits.faults import Planned, faults_of
from verifier.limits.lanes import Lane
from verifier.limits.planting import copy_of, plant
from verifier.report.limits import Fault
from verifier.traces.trace import Trace


def studied(program: Program, trace: Trace) -> Study:
    _, study = judged(program, trace)
    assert study is not None
    return study


def fault_in(program: Program, study: Study, fault: Fault, variable: str) -> Planned:
    planned = faults_of(program, program.fidelity, study)
    return next(each for each in planned if (each.fault, each.variable) == (fault, variable))


def planted(
    program: Program, trace: Trace, fault: Fault, variable: str, size: float
) -> tuple[Trace, Study]:
    study = studied(program, trace)
    lane = Lane(fault_in(program, study, fault, variable), size)
    plantings = plant(study, (lane,))
    return copy_of(trace, plantings, 0, np.random.default_rng(0)), study


def moved(trace: Trace, copy: Trace, name: str) -> np.ndarray:
    return copy.series[name].values - trace.series[name].values


def turned_by(trace: Trace, times: np.ndarray) -> np.ndarray:
    """The integral of the turn command, held from each switch to the next."""
    turn = trace.series["turn"]
    fine = np.linspace(-10.0, 100.0, 1_100_001)
    held = turn.values[np.clip(np.searchsorted(turn.times, fine, side="right") - 1, 0, None)]
    return np.interp(times, fine, np.concatenate([[0.0], np.cumsum(held[:-1] * np.diff(fine))]))


def test_an_offset_of_a_turn_rate_turns_the_copy_at_that_rate(scenes: ModuleType) -> None:
    program, trace = scenes.unicycle(), scenes.unicycle_drive(1, 20.0, 0.0)

    copy, study = planted(program, trace, Fault.OFFSET, "heading", 0.01)

    ((start, end),) = study.segments.spans
    times = trace.series["heading"].times
    inside = (times >= start) & (times <= end)
    expected = 0.01 * (times[inside] - start)
    assert moved(trace, copy, "heading")[inside] == pytest.approx(expected, abs=1e-9)


def test_a_gain_of_a_turn_rate_turns_the_copy_by_that_share_more(scenes: ModuleType) -> None:
    program, trace = scenes.unicycle(), scenes.unicycle_drive(2, 20.0, 0.0)

    copy, study = planted(program, trace, Fault.GAIN, "heading", 0.1)

    start = study.segments.spans[0, 0]
    times = trace.series["heading"].times
    way = turned_by(trace, times) - turned_by(trace, np.array([start]))
    assert moved(trace, copy, "heading") == pytest.approx(0.1 * way, abs=1e-4)


@pytest.mark.parametrize("late", [0.3, -0.2])
def test_a_late_turn_command_turns_the_copy_late(scenes: ModuleType, late: float) -> None:
    program, trace = scenes.unicycle(), scenes.unicycle_drive(3, 20.0, 0.0)

    copy, study = planted(program, trace, Fault.DELAY, "turn", late)

    start = study.segments.spans[0, 0]
    times = trace.series["heading"].times

    def turned_since(shift: float) -> np.ndarray:
        since = turned_by(trace, np.array([start - shift]))
        return turned_by(trace, times - shift) - since

    before_end = times < times[-1] - 0.3
    expected = turned_since(late) - turned_since(0.0)
    assert moved(trace, copy, "heading")[before_end] == pytest.approx(
        expected[before_end], abs=1e-3
    )


def test_a_copy_with_a_gain_goes_where_a_robot_with_that_gain_goes(scenes: ModuleType) -> None:
    """Both oscillators start in one place; that of the robot is integrated by scipy."""
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(4, 20.0, 0.0)
    start = [trace.series["x"].values[0], trace.series["v"].values[0]]
    times = trace.series["x"].times
    faulty = scenes.integrated(
        lambda _, s: [1.05 * s[1], (1.0 - s[0] ** 2) * s[1] - s[0]], start, times, 0.1
    )

    copy, study = planted(program, trace, Fault.GAIN, "x", 0.05)

    assert study.segments.spans[0, 0] == times[0]
    for column, name in enumerate(("x", "v")):
        apart = np.max(np.abs(faulty[:, column] - trace.series[name].values))
        missed = np.max(np.abs(faulty[:, column] - copy.series[name].values))
        assert apart > 0.5
        assert missed < 0.03 * apart


def test_noise_stays_what_it_was(scenes: ModuleType) -> None:
    """Of noise of 0.03, next to nothing gets into the deviation that is planted."""
    program = scenes.van_der_pol()
    noisy, calm = (scenes.van_der_pol_drive(5, 30.0, noise) for noise in (0.03, 0.0))

    deviations = [
        moved(trace, planted(program, trace, Fault.GAIN, "v", 0.05)[0], "x")
        for trace in (noisy, calm)
    ]

    assert np.std(deviations[1]) > 0.03
    assert np.std(deviations[0] - deviations[1]) < 0.2 * np.std(deviations[1])


def test_a_sensor_that_shows_too_much_changes_the_log_alone(scenes: ModuleType) -> None:
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(6, 20.0, 0.01)

    copy, _ = planted(program, trace, Fault.SENSOR, "x", 0.07)

    assert moved(trace, copy, "x") == pytest.approx(0.07)
    assert not np.any(moved(trace, copy, "v"))


def test_a_quantised_sensor_stays_on_its_steps(scenes: ModuleType) -> None:
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(7, 30.0, 0.0)
    x = trace.series["x"]
    steps = scenes.series("x", x.times, np.round(x.values / 0.02) * 0.02)
    coarse = scenes.trace(steps, trace.series["v"])

    copy, _ = planted(program, coarse, Fault.OFFSET, "x", 0.01)

    counts = copy.series["x"].values / 0.02
    assert counts == pytest.approx(np.rint(counts), abs=1e-6)
    assert np.mean(moved(coarse, copy, "x")[300:]) != 0.0


def test_a_copy_that_drifts_far_begins_anew_after_a_gap(scenes: ModuleType) -> None:
    """x' = u on [-1, 1]: an offset of 0.1 takes x out of its domain within 12 s."""
    program = scenes.program(
        (scenes.state("x", -1.0, 1.0),),
        (scenes.control("u", -1.0, 1.0, 0.0),),
        {"x": "u"},
        scenes.fidelity({"x": 0.05}, 1.0),
    )
    times = np.arange(0.0, 30.0, 0.05)
    trace = scenes.trace(
        scenes.series("x", times, 0.2 * np.sin(times)),
        scenes.series("u", times, 0.2 * np.cos(times)),
    )

    copy, _ = planted(program, trace, Fault.OFFSET, "x", 0.1)

    kept = copy.series["x"].times
    deviation = copy.series["x"].values - 0.2 * np.sin(kept)
    assert np.max(copy.series["x"].values) <= 1.0 + 0.1 * 0.05
    fell = np.flatnonzero(np.diff(deviation) < -0.5)
    assert len(fell) >= 2
    assert np.all(np.diff(kept)[fell] > 0.5)


def test_a_step_map_takes_the_faulty_steps(scenes: ModuleType) -> None:
    """x -> 0.9 x + 0.1: with an offset of 0.02 a step it settles 0.2 higher."""
    program = scenes.program(
        (scenes.state("x", -4.0, 4.0, role=Role.BOTH, kind=Kind.CONTINUOUS),),
        (),
        {"x": "0.9 x mul 0.1 add"},
        scenes.fidelity({"x": 0.05}, 1.0),
    )
    field = replace(program.field, every=0.1, form="step")
    program = replace(program, field=field)
    times = np.arange(0.0, 20.0, 0.1)
    trace = scenes.trace(scenes.series("x", times, 1.0 + 2.0 * 0.9 ** np.arange(200)))

    copy, _ = planted(program, trace, Fault.OFFSET, "x", 0.02)

    expected = 0.2 * (1.0 - 0.9 ** np.arange(200))
    assert moved(trace, copy, "x") == pytest.approx(expected, abs=1e-9)


def test_what_a_guard_resets_has_no_deviation_afterwards(scenes: ModuleType) -> None:
    """Back and forth at 0.5, 6 s each way; a window of 5 s goes through the turns."""
    values = ("forward", "back")
    mode = scenes.state("going", 0.0, 1.0, kind=Kind.DISCRETE, values=values)
    plain = scenes.program(
        (scenes.state("x", -4.0, 4.0), scenes.state("v", -2.0, 2.0), mode),
        (),
        {"x": "v", "v": "going 0 mul"},
        scenes.fidelity({"x": 0.2, "v": 0.2}, 5.0),
    )
    guards = (
        Guard(0, 1, Code("x 1.5 sub"), (("v", Code("0.5 neg")),), "spec.yaml:1:1"),
        Guard(1, 0, Code("0 x sub 1.5 sub"), (("v", Code("0.5")),), "spec.yaml:2:1"),
    )
    program = replace(plain, field=replace(plain.field, mode="going", guards=guards))
    times = np.arange(0.0, 40.0, 0.05)
    phase = (times + 0.025) % 12.0
    forward = phase < 6.0
    x = np.where(forward, phase - 3.0, 9.0 - phase) / 2.0
    trace = scenes.trace(
        scenes.series("x", times, x),
        scenes.series("v", times, np.where(forward, 0.5, -0.5)),
        scenes.series("going", times, np.where(forward, 0.0, 1.0)),
    )

    copy, study = planted(program, trace, Fault.OFFSET, "v", 0.01)

    inside = contains(study.segments.spans, times)
    since = np.where(forward, phase, phase - 6.0)
    settled = inside & (since > 0.1) & (times > 6.0)
    assert np.sum(settled) > 200
    assert moved(trace, copy, "v")[settled] == pytest.approx(0.01 * since[settled], abs=1e-3)
    assert np.max(moved(trace, copy, "x")[settled]) > 0.3


@pytest.mark.parametrize("pace", [50.0, 150.0, 600.0])
def test_a_field_that_is_fast_beside_the_steps_leaves_what_the_fault_leaves_of_it(
    scenes: ModuleType, pace: float
) -> None:
    """x' = pace (goal - x) + offset rests offset / pace away from its goal, however fast it is."""
    program = scenes.program(
        (scenes.state("x", -2.0, 2.0),),
        (scenes.control("goal", -1.0, 1.0, 0.0),),
        {"x": f"{pace} goal x sub mul"},
        scenes.fidelity({"x": 0.02}, 2.0),
    )
    times, jumps = np.arange(0.0, 20.0, 0.01), np.arange(0.0, 20.0, 1.0)
    goals = np.random.default_rng(3).uniform(-0.9, 0.9, len(jumps))
    goal = goals[np.clip(np.searchsorted(jumps, times, side="right") - 1, 0, None)]
    trace = scenes.trace(scenes.series("x", times, goal), scenes.series("goal", jumps, goals))

    copy, study = planted(program, trace, Fault.OFFSET, "x", 0.23)

    assert len(copy.series["x"].times) == len(times), "no gap was cut"
    ((start, _),) = study.segments.spans
    settled = times > start + 0.5
    assert moved(trace, copy, "x")[settled] == pytest.approx(0.23 / pace, rel=0.02)
