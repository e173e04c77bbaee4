"""Changes of mode: their times, their jumps, and what they do to the verdict."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.program import Fidelity, Program
from specc.loading import load_program
from tests.runtime import hybrids
from tests.runtime.behaviors import formula_program, state
from tests.verifier.fidelity.switching_robots import (
    Leave,
    Patrol,
    Robot,
    ball_log,
    log,
    patrol_log,
    run,
    thermostat_log,
    with_mode,
)
from verifier.fidelity.verify import judgement_of, verify
from verifier.report.report import Report, Standing, VariableResult, Verdict
from verifier.report.switching import Switching, SwitchSort, Way
from verifier.traces.trace import TICKS, Series, Trace

SPECS = Path(__file__).parents[3] / "specs"


@pytest.fixture(scope="module")
def patrol() -> Program:
    return judged_by(load_program(SPECS / "patrol.yaml"), {"x": 0.05, "v": 0.05}, 2.0)


def judged_by(program: Program, tolerance: dict[str, float], horizon: float) -> Program:
    return replace(program, fidelity=Fidelity(tolerance, horizon, {}, 0.0, "spec.yaml:9:1"))


def switching(program: Program, trace: Trace) -> Switching:
    found = judgement_of(program, trace).switching
    assert found is not None
    return found


def way(found: Switching, source: str) -> Way:
    return next(way for way in found.ways if way.source == source)


def of(report: Report, name: str) -> VariableResult:
    return next(result for result in report.variables if result.name == name)


def test_a_faithful_patrol_passes_and_says_that_it_turns_in_time(patrol: Program) -> None:
    report = verify(patrol, patrol_log(Patrol().robot(), 120.0, 1))

    assert report.verdict is Verdict.PASS
    assert any("goes from forward to back in time" in reason for reason in report.reasons)


def test_a_guard_five_per_cent_off_is_an_error_of_time_and_not_of_state(patrol: Program) -> None:
    drive = patrol_log(Patrol(x1=1.575).robot(), 120.0, 2)

    report, found = verify(patrol, drive), switching(patrol, drive)

    assert report.verdict is Verdict.FAIL
    assert "the robot goes from forward to back 0.1" in report.reasons[0]
    assert "s later than by the spec" in report.reasons[0]
    assert {result.standing for result in report.variables} == {Standing.WITHIN}
    timing = way(found, "forward").timing
    assert timing is not None
    # 0.075 m at 0.5 m/s; allowed are 0.05 m at 0.5 m/s.
    assert timing.late == pytest.approx(0.15, abs=0.015)
    assert timing.interval.low < 0.15 < timing.interval.high
    assert timing.allowed == pytest.approx(0.1, rel=0.05)
    assert way(found, "back").standing is Standing.WITHIN


def test_a_switch_that_comes_early_is_told_as_such(patrol: Program) -> None:
    drive = patrol_log(Patrol(x2=-1.35).robot(), 120.0, 3)

    timing = way(switching(patrol, drive), "back").timing

    assert timing is not None
    assert timing.standing is Standing.EXCEEDED
    assert timing.late == pytest.approx(-0.3, abs=0.02)


def test_a_guard_one_per_cent_off_is_within_the_tolerance(patrol: Program) -> None:
    report = verify(patrol, patrol_log(Patrol(x1=1.515).robot(), 120.0, 4))

    assert report.verdict is Verdict.PASS


def test_a_speed_ten_per_cent_off_is_an_error_of_state_and_not_of_time(patrol: Program) -> None:
    drive = patrol_log(Patrol(v1=0.45).robot(), 120.0, 5)

    report, found = verify(patrol, drive), switching(patrol, drive)

    assert report.verdict is Verdict.FAIL
    assert of(report, "x").standing is Standing.EXCEEDED
    timing = way(found, "forward").timing
    assert timing is not None
    assert timing.standing is Standing.WITHIN
    assert abs(timing.late) < 0.03


def test_a_wrong_reset_is_named_with_its_size(patrol: Program) -> None:
    drive = patrol_log(Patrol(kept=0.8).robot(), 80.0, 6)

    report, found = verify(patrol, drive), switching(patrol, drive)

    assert report.verdict is Verdict.FAIL
    jump = next(jump for jump in way(found, "forward").jumps if jump.name == "v")
    assert jump.is_reset
    assert jump.standing is Standing.EXCEEDED
    assert jump.error == pytest.approx(0.1, abs=0.02)
    kept = next(jump for jump in way(found, "forward").jumps if jump.name == "x")
    assert not kept.is_reset
    assert kept.standing is Standing.WITHIN


def test_windows_go_on_through_switches_where_stays_are_short(patrol: Program) -> None:
    far = judged_by(patrol, {"x": 0.05, "v": 0.05}, 8.0)

    faithful = verify(far, patrol_log(Patrol().robot(), 240.0, 7))
    turning_late = verify(far, patrol_log(Patrol(x1=1.575).robot(), 240.0, 8))
    slow = verify(far, patrol_log(Patrol(v1=0.45).robot(), 240.0, 9))

    assert faithful.verdict is Verdict.PASS
    assert of(faithful, "x").declared.windows > 50
    assert turning_late.verdict is Verdict.FAIL
    assert {result.standing for result in turning_late.variables} == {Standing.WITHIN}
    # 0.05 m/s for up to 8 s.
    assert of(slow, "x").standing is Standing.EXCEEDED


@pytest.mark.parametrize("every", [1, 4, 10])
def test_how_often_the_mode_is_logged_does_not_shift_a_switch(patrol: Program, every: int) -> None:
    drive = patrol_log(Patrol().robot(), 240.0, 10)
    mode = drive.series["going"]
    drive = with_mode(drive, "going", mode.times[::every], mode.values[::every])

    found = way(switching(patrol, drive), "forward")

    assert found.timing is not None
    assert abs(found.timing.late) < 0.02
    assert found.timing.resolution == pytest.approx(0.05 * every)
    assert found.timing.standing is Standing.WITHIN
    # At 1 m/s from before to after, a stamp that is 0.25 s off would be 0.25 m.
    assert all(abs(jump.error) < 0.02 for jump in found.jumps)


def test_a_mode_that_is_logged_only_when_it_changes_has_the_stamp_of_the_change(
    patrol: Program,
) -> None:
    drive = patrol_log(Patrol().robot(), 120.0, 11)
    mode = drive.series["going"]
    first = np.append(True, np.diff(mode.values) != 0.0)
    # The very first sample of a mode comes half a period after the switch, on average.
    drive = with_mode(drive, "going", mode.times[first] - 0.025, mode.values[first])

    timing = way(switching(patrol, drive), "forward").timing

    assert timing is not None
    assert timing.resolution == 0.0
    assert timing.late == pytest.approx(0.0, abs=0.02)


def test_a_switch_where_none_was_due_is_unexpected(patrol: Program) -> None:
    plain = Patrol().robot()
    # Every time but the first it turns back half way.
    robot = Robot(
        plain.rates | {"startled": lambda _, s: [s[1], 0.0]},
        plain.leave
        | {
            "back": [Leave(lambda s: -1.5 - s[0], "startled", lambda s: [s[0], 0.5])],
            "startled": [Leave(lambda s: s[0], "back", lambda s: [s[0], -0.5])],
        },
        {"startled": "forward"},
    )

    drive = patrol_log(robot, 60.0, 12)
    report, found = verify(patrol, drive), switching(patrol, drive)

    # It goes back at x = 0, three seconds before the end of the line.
    assert way(found, "forward").unexpected >= 5
    assert report.verdict is Verdict.FAIL
    assert "where by the spec it was not due" in report.reasons[0]


def test_a_guard_that_is_passed_without_a_switch_is_missed(patrol: Program) -> None:
    plain = Patrol().robot()
    # It turns at 1.9, comes back, and only at 1 it says that it goes back.
    robot = Robot(
        plain.rates | {"silent": lambda _, s: [s[1], 0.0]},
        plain.leave
        | {
            "forward": [Leave(lambda s: s[0] - 1.9, "silent", lambda s: [s[0], -0.5])],
            "silent": [Leave(lambda s: 1.0 - s[0], "back")],
        },
        {"silent": "forward"},
    )

    drive = patrol_log(robot, 60.0, 13)
    report, found = verify(patrol, drive), switching(patrol, drive)

    assert way(found, "forward").missed >= 3
    missed = [each.time for each in found.switches if each.sort is SwitchSort.MISSED]
    assert missed[0] == pytest.approx(3.0, abs=0.4)
    assert report.verdict is Verdict.FAIL
    assert any("although by the spec it had to" in reason for reason in report.reasons)


def test_a_way_that_the_spec_does_not_have_is_named() -> None:
    spec = judged_by(load_program(SPECS / "patrol_turning.yaml"), {"x": 0.05, "v": 0.1}, 1.0)
    drive = patrol_log(Patrol(x1=1.2, x2=-1.2).robot(), 60.0, 14)
    mode = drive.series["going"]
    drive = with_mode(drive, "going", mode.times, np.where(mode.values == 1.0, 2.0, 0.0))
    drive = replace(drive, constants={"x1": 1.2, "x2": -1.2, "v1": 0.5, "v2": 0.5, "a": 4.0})

    report = verify(spec, drive)

    assert report.verdict is Verdict.FAIL
    assert "going went from forward to back" in report.reasons[0]
    assert "the spec has no such way" in report.reasons[0]


def test_a_mode_that_is_not_in_the_log_is_asked_for(patrol: Program) -> None:
    drive = patrol_log(Patrol().robot(), 60.0, 15)
    drive = replace(drive, series={n: s for n, s in drive.series.items() if n != "going"})

    report = verify(patrol, drive)

    assert report.verdict is Verdict.INCONCLUSIVE
    assert any("going, the mode, is not in the trace" in reason for reason in report.reasons)


def test_one_turn_decides_nothing(patrol: Program) -> None:
    drive = patrol_log(Patrol().robot(), 10.0, 16)

    found = switching(patrol, drive)

    assert found.standing is Standing.UNDECIDED
    assert found.advice[0].startswith("record more switches from forward to back: there was 1, 3 ")


def test_so_few_switches_have_no_interval_and_rounding_is_no_difference(patrol: Program) -> None:
    found = switching(patrol, patrol_log(Patrol(x1=1.55).robot(), 30.0, 3))

    of_x = next(said for said in found.reasons if "whether x is right after" in said)
    assert of_x.startswith("it is open whether x is right after going from back to forward: off by")
    assert "off by 0 m on average over 2 switches (too few to tell), 0.05 m is allowed" in of_x
    assert not any("unbounded" in said or "e-" in said for said in found.reasons)
    assert any("over 3 switches (95 % interval of the delay" in said for said in found.reasons)


def test_a_switch_beside_a_gap_is_not_judged(patrol: Program) -> None:
    drive = patrol_log(Patrol().robot(), 60.0, 17)
    x = drive.series["x"]
    kept = (x.times < 2.0) | (x.times > 4.0)
    cut = replace(x, times=x.times[kept], values=x.values[kept])
    drive = replace(drive, series=drive.series | {"x": cut})

    found = switching(patrol, drive)

    assert found.switches[0].sort is SwitchSort.UNJUDGED
    assert way(found, "forward").standing is Standing.WITHIN


def test_at_the_tolerance_itself_neither_verdict_is_common(patrol: Program) -> None:
    standings = []
    for seed in range(20):
        drive = patrol_log(Patrol(x1=1.55).robot(), 60.0, 100 + seed)
        timing = way(switching(patrol, drive), "forward").timing
        assert timing is not None
        standings.append(timing.standing)

    # Both are to come in at most 2.5 % of cases; 3 or more of 20 would have a chance of 1 %.
    assert standings.count(Standing.WITHIN) < 3
    assert standings.count(Standing.EXCEEDED) < 3


@pytest.fixture(scope="module")
def thermostat() -> Program:
    return judged_by(hybrids.thermostat(), {"T": 0.4}, 4.0)


def test_a_thermostat_is_judged_through_stays_shorter_than_the_horizon(
    thermostat: Program,
) -> None:
    faithful = verify(thermostat, thermostat_log(1))
    late = thermostat_log(2, off=22.8)
    report, found = verify(thermostat, late), switching(thermostat, late)

    assert faithful.verdict is Verdict.PASS
    assert of(faithful, "T").declared.windows > 30
    assert report.verdict is Verdict.FAIL
    assert of(report, "T").standing is not Standing.EXCEEDED
    timing = way(found, "heat").timing
    assert timing is not None
    # T = 40 - 18 exp(-0.1 t) after 22: it takes 0.4545 s to 22.8.
    assert timing.late == pytest.approx(10.0 * np.log(18.0 / 17.2), abs=0.03)


def test_a_mode_logged_as_seldom_as_it_changes_decides_nothing(thermostat: Program) -> None:
    drive = thermostat_log(3, k=0.5)

    found = switching(thermostat, drive)

    assert found.standing is Standing.UNDECIDED
    assert verify(thermostat, drive).verdict is Verdict.INCONCLUSIVE


def test_a_ball_bounces_although_no_log_shows_it() -> None:
    spec = judged_by(hybrids.bouncing_ball(), {"x": 0.05, "v": 0.1}, 0.5)

    report = verify(spec, ball_log(0.9, 0.0, 6.0, 1))
    found = switching(spec, ball_log(0.9, 0.0, 6.0, 1))

    assert report.verdict is Verdict.PASS
    # It falls for sqrt(2 h / g), and from then on every flight takes 2 v / g.
    height = 2.0 + 0.3 * np.random.default_rng(1).random()
    first, speed = np.sqrt(2.0 * height / 9.81), np.sqrt(2.0 * 9.81 * height)
    bounces = first + np.concatenate(
        [[0.0], np.cumsum(2.0 * speed * 0.9 ** np.arange(1, 5) / 9.81)]
    )
    times = [each.time for each in found.switches]
    assert times[:5] == pytest.approx(bounces, abs=0.005)


def test_a_ball_that_loses_more_speed_fails_by_its_reset() -> None:
    spec = judged_by(hybrids.bouncing_ball(), {"x": 0.05, "v": 0.1}, 0.5)

    drive = ball_log(0.81, 0.0, 3.2, 2)
    found = switching(spec, drive)

    assert verify(spec, drive).verdict is Verdict.FAIL
    jump = next(jump for jump in found.ways[0].jumps if jump.name == "v")
    assert jump.standing is Standing.EXCEEDED
    assert jump.error < -0.2


def test_a_ball_that_bounces_off_a_shelf_fails_by_its_time() -> None:
    spec = judged_by(hybrids.bouncing_ball(), {"x": 0.05, "v": 0.1}, 0.5)

    found = switching(spec, ball_log(0.9, 0.1, 6.0, 3))

    timing = found.ways[0].timing
    assert timing is not None
    assert timing.standing is Standing.EXCEEDED
    assert all(jump.standing is not Standing.EXCEEDED for jump in found.ways[0].jumps)


@pytest.mark.parametrize(("beyond", "verdict"), [(0.0, Verdict.PASS), (0.08, Verdict.FAIL)])
def test_a_patrol_that_takes_time_to_turn_is_judged_in_all_its_modes(
    beyond: float, verdict: Verdict
) -> None:
    spec = judged_by(load_program(SPECS / "patrol_turning.yaml"), {"x": 0.05, "v": 0.1}, 1.0)
    names = ("forward", "turning_back", "back", "turning_forward")
    robot = Robot(
        {
            "forward": lambda _, s: [s[1], 2.0 * (0.5 - s[1])],
            "turning_back": lambda _, s: [s[1], -2.0],
            "back": lambda _, s: [s[1], 2.0 * (-0.5 - s[1])],
            "turning_forward": lambda _, s: [s[1], 2.0],
        },
        {
            "forward": [Leave(lambda s: s[0] - 1.2 - beyond, "turning_back")],
            "turning_back": [Leave(lambda s: -0.5 - s[1], "back")],
            "back": [Leave(lambda s: -1.2 - s[0], "turning_forward")],
            "turning_forward": [Leave(lambda s: s[1] - 0.5, "forward")],
        },
    )
    times = np.arange(0.0, 120.0, 0.05)
    told = {"x1": 1.2, "x2": -1.2, "v1": 0.5, "v2": 0.5, "a": 2.0}
    ran = run(robot, "forward", [0.0, 0.5], times)
    drive = log(("x", "v"), ran, times, {"x": 0.01, "v": 0.02}, 4, ("going", names), **told)

    report, found = verify(spec, drive), switching(spec, drive)

    assert report.verdict is verdict
    assert way(found, "turning_back").expected > 8
    assert way(found, "turning_back").standing is Standing.WITHIN
    timing = way(found, "forward").timing
    assert timing is not None
    assert timing.late == pytest.approx(beyond / 0.5, abs=0.02)


def test_a_robot_that_goes_elsewhere_than_it_should_is_told_where_to() -> None:
    spec = hybrids.with_modes(
        formula_program(
            (state("x", -1.0, 3.0), state("y", -1.0, 3.0)),
            {"x": "mode 0 eq 1 mode 1 eq -1 0 where where", "y": "mode 2 eq -1 0 where"},
        ),
        ("out", "home", "dock"),
        hybrids.guard(0, 1, "x 1 sub"),
        hybrids.guard(0, 2, "y 2 sub"),
        hybrids.guard(1, 0, "x neg"),
        hybrids.guard(2, 0, "y neg", x="0"),
    )
    # At x = 1 it goes to its dock; y is 1 all the time, and no reason to.
    robot = Robot(
        {"out": lambda *_: [1.0, 0.0], "dock": lambda *_: [0.0, -1.0]},
        {
            "out": [Leave(lambda s: s[0] - 1.0, "dock")],
            "dock": [Leave(lambda s: -s[1], "out", lambda _: [0.0, 1.0])],
        },
        step=0.1,
    )
    times = np.arange(0.0, 30.0, 0.05)
    ran = run(robot, "out", [0.0, 1.0], times)
    names = ("mode", ("out", "home", "dock"))
    drive = log(("x", "y"), ran, times, {"x": 0.01, "y": 0.01}, 5, names)

    found = switching(judged_by(spec, {"x": 0.05, "y": 0.05}, 0.5), drive)

    wrong = [each for each in found.switches if each.sort is SwitchSort.WRONG_TARGET]
    assert len(wrong) > 10
    assert {(each.target, each.wanted) for each in wrong} == {("dock", "home")}
    assert (
        "where by the spec it had to go from out to home, the robot went elsewhere"
        in (found.reasons[0])
    )


@pytest.mark.parametrize("samples", [1, 2, 3, 20, 61, 62, 63])
def test_a_log_that_is_cut_short_is_no_mishap(patrol: Program, samples: int) -> None:
    whole = patrol_log(Patrol().robot(), 10.0, 18)
    cut = {
        name: replace(each, times=each.times[:samples], values=each.values[:samples])
        for name, each in whole.series.items()
    }

    assert verify(patrol, replace(whole, series=cut)).verdict is Verdict.INCONCLUSIVE


LAMP = """
specc: 1
kind: behavior
name: lamp
state:
  x: {unit: m, domain: [0, 4], role: both, relates: {agent: base, environment: wall}}
  lamp:
    {kind: discrete, values: [hidden, shown], role: sensed, relates: {agent: eye, environment: it}}
  doing:
    {kind: discrete, values: [rest, go], role: both, relates: {agent: base, environment: lamp}}
constants:
  calm: {value: 1, unit: 1/s}
  there: {value: 1, unit: m}
  beyond: {value: 1.5, unit: m}
field:
  modes:
    of: doing
    each:
      rest:
        formula: {x: -calm * x}
        leave: [{when: lamp == 'shown', to: go}]
      go:
        formula: {x: calm * (there - x)}
        leave: [{when: lamp == 'hidden', to: rest}, {when: x >= beyond, to: rest}]
fidelity: {tolerance: {x: 0.05}, horizon: 0.5 s}
"""


def test_of_two_ways_to_a_mode_the_one_that_opened_was_taken(tmp_path: Path) -> None:
    (tmp_path / "lamp.yaml").write_text(LAMP)
    times = np.arange(0.0, 40.0, 0.05)
    shown = (times % 4.0) >= 1.99
    x = np.zeros(times.size)
    for k in range(1, times.size):
        x[k] = (x[k - 1] - shown[k - 1]) * np.exp(-0.05) + shown[k - 1]
    values = {"x": x, "lamp": shown.astype(float), "doing": shown.astype(float)}
    series = {name: Series(name, times, each, name, TICKS) for name, each in values.items()}

    found = switching(load_program(tmp_path / "lamp.yaml"), Trace("log", series, {}, 0.0, (), ()))

    assert {each.sort for each in found.switches} == {SwitchSort.EXPECTED}
