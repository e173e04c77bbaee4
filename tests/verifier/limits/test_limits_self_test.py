"""The self-test, against robots that really have the faults it speaks of."""

from types import ModuleType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.program import Program
from verifier.fidelity.verify import judged, verify
from verifier.limits.excerpt import excerpt_of
from verifier.limits.faults import faults_of
from verifier.limits.search import turning
from verifier.limits.self_test import smallest_caught
from verifier.report.limits import Caught, Fault
from verifier.report.report import Report, Verdict
from verifier.traces.trace import Trace


def of(found: tuple[Caught, ...], fault: Fault, variable: str) -> Caught:
    return next(each for each in found if (each.fault, each.variable) == (fault, variable))


@given(st.integers(1, 40), st.data())
def test_the_turning_is_found_wherever_it_is(rungs: int, data: st.DataObject) -> None:
    turns_at = data.draw(st.integers(0, rungs))
    guess = data.draw(st.integers(0, rungs - 1))
    hint = data.draw(st.integers(-50, 50))
    tried: list[int] = []

    def is_caught(rung: int) -> bool:
        tried.append(rung)
        return rung >= turns_at

    missed, caught = turning(is_caught, lambda _: hint, guess, rungs)

    assert caught == (turns_at if turns_at < rungs else None)
    assert missed == (turns_at - 1 if turns_at > 0 else None)
    assert len(tried) <= 20
    assert len(set(tried)) == len(tried)


@pytest.fixture(scope="module")
def oscillator(scenes: ModuleType) -> tuple[Caught, ...]:
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.01)
    found, notes = smallest_caught(program, trace, verify(program, trace))
    assert notes == ()
    return found


def fast(scenes: ModuleType, seed: int, gain: float) -> Trace:
    """An oscillator whose x moves `gain` times as fast as v says."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, 60.0, 0.05)
    start = [rng.uniform(-1.5, 1.5), rng.uniform(-1.0, 1.0)]
    x = scenes.integrated(
        lambda _, s: [gain * s[1], (1.0 - s[0] ** 2) * s[1] - s[0]], start, times, 0.1
    )
    x = x + 0.01 * rng.standard_normal(x.shape)
    return scenes.trace(scenes.series("x", times, x[:, 0]), scenes.series("v", times, x[:, 1]))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_robots_with_the_fault_are_caught_where_it_says_so(
    scenes: ModuleType, oscillator: tuple[Caught, ...], side: float
) -> None:
    caught = of(oscillator, Fault.GAIN, "x")
    assert caught.largest < caught.smallest < 1.4 * caught.largest

    larger = [
        verify(scenes.van_der_pol(), fast(scenes, seed, 1.0 + side * 1.5 * caught.smallest))
        for seed in range(3)
    ]
    smaller = [
        verify(scenes.van_der_pol(), fast(scenes, seed, 1.0 + side * caught.largest / 1.5))
        for seed in range(3)
    ]

    assert [report.verdict for report in larger] == [Verdict.FAIL] * 3
    assert Verdict.FAIL not in [report.verdict for report in smaller]


def test_every_driven_variable_has_its_faults(oscillator: tuple[Caught, ...]) -> None:
    kinds = {(each.fault, each.variable) for each in oscillator}

    assert kinds == {
        (fault, name) for fault in (Fault.GAIN, Fault.OFFSET, Fault.SENSOR) for name in ("x", "v")
    }
    for each in oscillator:
        assert each.is_caught
        assert each.shown_by


def test_the_sentence_tells_what_was_planted_and_what_was_missed(
    oscillator: tuple[Caught, ...],
) -> None:
    caught = of(oscillator, Fault.GAIN, "x")

    percent = f"{caught.smallest / 0.01:.3g} %"
    missed = f"{caught.largest / 0.01:.3g} %"
    assert caught.sentence == (
        f"a robot whose x changes {percent} faster or slower than the spec says would have failed;"
        f" {missed} would not"
    )


def test_the_trials_stand_behind_the_sizes(oscillator: tuple[Caught, ...]) -> None:
    for each in oscillator:
        verdicts = {trial.size: trial.verdict for trial in each.trials}
        assert verdicts[each.smallest] is Verdict.FAIL
        assert verdicts[-each.smallest] is Verdict.FAIL
        missed = [verdicts.get(side * each.largest) for side in (1.0, -1.0)]
        assert any(verdict not in {Verdict.FAIL, None} for verdict in missed)
        assert [trial.size for trial in each.trials] == sorted(trial.size for trial in each.trials)


def test_the_sensor_of_what_no_rate_reads_cannot_be_caught(scenes: ModuleType) -> None:
    program, trace = scenes.unicycle(), scenes.unicycle_drive(1, 30.0, 0.01)
    report = verify(program, trace)

    found, _ = smallest_caught(program, trace, report, lambda _program, _trace: report)

    caught = of(found, Fault.SENSOR, "x")
    assert not caught.is_caught
    assert caught.trials == ()
    assert "the field does not read x" in caught.sentence


def test_where_nothing_is_caught_the_largest_fault_is_told(scenes: ModuleType) -> None:
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(1, 20.0, 0.01)
    report = verify(program, trace)
    assert report.verdict is not Verdict.FAIL

    found, _ = smallest_caught(program, trace, report, lambda _program, _trace: report)

    caught = of(found, Fault.GAIN, "v")
    assert not caught.is_caught
    assert caught.sentence.startswith("not even a robot whose v changes")
    assert caught.largest == max(trial.size for trial in caught.trials)


def test_nothing_is_planted_into_a_trace_that_fails(scenes: ModuleType) -> None:
    program, trace = scenes.van_der_pol("1.5"), scenes.van_der_pol_drive(1, 60.0, 0.01)
    report = verify(program, trace)
    assert report.verdict is Verdict.FAIL

    found, notes = smallest_caught(program, trace, report)

    assert found == ()
    assert "fails as it is" in notes[0]


def test_an_input_that_is_not_told_is_assumed_and_said(scenes: ModuleType) -> None:
    """x' = goal - x + push settles to goal + (cos t + sin t) / 2 for push = cos t."""
    program = scenes.program(
        (scenes.state("x", -2.0, 2.0),),
        (scenes.control("goal", -1.0, 1.0, 0.25), scenes.control("push", -2.0, 2.0, 0.0)),
        {"x": "goal x sub push add"},
        scenes.fidelity({"x": 0.05}, 1.0),
    )
    times, fine = np.arange(0.0, 40.0, 0.05), np.arange(0.0, 40.0, 0.01)
    x = 0.25 + (np.cos(times) + np.sin(times)) / 2.0
    x += 0.002 * np.random.default_rng(3).standard_normal(len(times))
    push = np.cos(fine + 0.005)
    trace = scenes.trace(scenes.series("x", times, x), scenes.series("push", fine, push))
    report = verify(program, trace)
    assert report.verdict is Verdict.INCONCLUSIVE

    judged: list[Trace] = []

    def judge(_program: Program, copy: Trace) -> Report:
        judged.append(copy)
        return report

    _, notes = smallest_caught(program, trace, report, judge)

    assert notes == (
        "faults were planted as if goal = 0.25 (SI) were known, which this trace does not tell",
    )
    assert {copy.constants["goal"] for copy in judged} == {0.25}


def test_a_long_trace_is_planted_into_where_most_moves(
    scenes: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Standing for 40 s, a gap, then 90 s of swinging: 40 horizons of 2 s are taken."""
    monkeypatch.setattr("verifier.limits.excerpt.WHOLE_WINDOWS", 79)
    program, swinging = scenes.van_der_pol(), scenes.van_der_pol_drive(1, 90.0, 0.01)
    times = np.arange(0.0, 40.0, 0.05)
    noise = 0.01 * np.random.default_rng(0).standard_normal((2, len(times)))
    parts = []
    for i, name in enumerate(("x", "v")):
        late = swinging.series[name]
        joined = np.concatenate([noise[i], late.values])
        parts.append(scenes.series(name, np.concatenate([times, late.times + 45.0]), joined))
    trace = scenes.trace(*parts)
    report = verify(program, trace)
    seen: list[Trace] = []

    def judge(_program: Program, copy: Trace) -> Report:
        seen.append(copy)
        return report

    _, notes = smallest_caught(program, trace, report, judge)

    assert "a recording of 80 s" in notes[0]
    assert "of this one, 135 s long" in notes[0]
    assert min(copy.series["x"].times[0] for copy in seen) > 44.0


def test_what_is_caught_in_one_direction_only_is_told_for_the_other(scenes: ModuleType) -> None:
    """A copy fails wherever its x was made larger than it was."""
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(1, 20.0, 0.01)
    report = verify(program, trace)
    failing = verify(scenes.van_der_pol("1.5"), scenes.van_der_pol_drive(1, 60.0, 0.01))
    mean = np.mean(trace.series["x"].values)

    def judge(_program: Program, copy: Trace) -> Report:
        return failing if np.mean(copy.series["x"].values) > mean + 1e-9 else report

    found, _ = smallest_caught(program, trace, report, judge)

    sentence = of(found, Fault.SENSOR, "x").sentence
    assert sentence.startswith("not even a sensor that shows")
    assert sentence.endswith("too low would have failed; as much too high would have")


def test_the_search_for_a_delay_begins_where_it_shows_first(scenes: ModuleType) -> None:
    """Turn rates jump by 0.57 rad/s, root mean square: late by s, a window ends 0.57 s rad off.

    Much later ones look like chance, so a search from there would miss those in between.
    """
    program, trace = scenes.unicycle(), scenes.unicycle_drive(1, 40.0, 0.005)
    _, study = judged(program, trace)
    assert program.fidelity is not None
    assert study is not None

    planned = faults_of(program, program.fidelity, study)

    (turn,) = (p for p in planned if (p.fault, p.variable) == (Fault.DELAY, "turn"))
    allowed = program.fidelity.tolerance["heading"]
    # Within a factor of two: of x and y it may show even earlier, and sizes stand on a ladder.
    assert 0.5 < turn.sizes[turn.guess] / (allowed / 0.57) < 2.0


def test_windows_that_are_far_apart_are_taken_together(scenes: ModuleType) -> None:
    """An oscillator that is logged for 5 s of every 25, three windows each: all are taken."""
    program = scenes.van_der_pol()
    assert program.fidelity is not None
    whole = scenes.van_der_pol_drive(1, 500.0, 0.01)
    kept = whole.series["x"].times % 25.0 < 5.0
    series = [scenes.series(n, s.times[kept], s.values[kept]) for n, s in whole.series.items()]
    trace = scenes.trace(*series)
    _, study = judged(program, trace)
    assert study is not None

    part, note = excerpt_of(trace, program.fidelity, study)

    assert len(study.plan.windows.times) == 20 * 3
    assert (part, note) == (trace, "")
