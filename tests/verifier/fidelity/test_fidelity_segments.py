from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.code import Code
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.stretches.segments import segments_of
from verifier.fidelity.stretches.spans import contains, intersect, length, merge, spans_of, without
from verifier.fidelity.verify import verify
from verifier.report.report import Verdict
from verifier.traces.trace import Trace

spans = st.lists(st.floats(0.0, 100.0), max_size=12, unique=True).map(
    lambda ends: spans_of(list(zip(*[iter(sorted(ends))] * 2, strict=False)))
)


@given(spans, spans)
def test_what_is_kept_and_what_is_taken_out_make_the_whole(a: np.ndarray, b: np.ndarray) -> None:
    kept, taken = intersect(a, b), without(a, b)

    assert length(kept) + length(taken) == pytest.approx(length(a), abs=1e-9)


@given(spans, spans, st.floats(0.0, 100.0))
def test_a_time_lies_in_the_union_if_it_lies_in_one(
    a: np.ndarray, b: np.ndarray, time: float
) -> None:
    t = np.array([time])
    both = merge(np.concatenate([a, b]))

    assert contains(both, t)[0] == (contains(a, t)[0] or contains(b, t)[0])
    assert np.all(np.diff(both.ravel()) >= 0.0)


def cut(drive: Trace, name: str, start: float, end: float) -> Trace:
    s = drive.series[name]
    kept = (s.times < start) | (s.times > end)
    return replace(
        drive,
        series=drive.series | {name: replace(s, times=s.times[kept], values=s.values[kept])},
    )


def test_a_gap_is_cut_out_and_counted(scenes: ModuleType) -> None:
    drive = cut(scenes.van_der_pol_drive(1, 60.0, 0.01), "v", 20.0, 24.0)

    report = verify(scenes.van_der_pol(), drive)

    gap = next(e for e in report.exclusions if e.cause == "a gap in v")
    assert gap.seconds == pytest.approx(4.1, abs=0.11)
    assert not np.any((report.starts > 18.0) & (report.starts < 24.0))


def test_a_short_gap_is_bridged(scenes: ModuleType) -> None:
    drive = cut(scenes.van_der_pol_drive(1, 60.0, 0.01), "v", 20.0, 20.2)

    causes = [each.cause for each in verify(scenes.van_der_pol(), drive).exclusions]
    assert causes == ["left over at the ends of stretches, where no window fits"]


def test_only_time_in_which_the_behavior_had_its_way_is_judged(scenes: ModuleType) -> None:
    drive = scenes.van_der_pol_drive(1, 60.0, 0.01)
    # From 20 s to 25 s somebody holds the robot.
    held = (drive.series["x"].times > 20.0) & (drive.series["x"].times < 25.0)
    stopped = {n: replace(s, values=np.where(held, 0.0, s.values)) for n, s in drive.series.items()}
    switch = scenes.series("intervention", np.array([0.0, 19.9, 25.05]), np.array([0.0, 1.0, 0.0]))
    spec = scenes.van_der_pol(
        bindings=(scenes.binding("intervention"),), judge_when=Code("intervention not")
    )

    watched = verify(spec, replace(drive, series=stopped | {"intervention": switch}))
    blind = verify(scenes.van_der_pol(), replace(drive, series=stopped))

    assert watched.verdict is Verdict.PASS
    excluded = next(e for e in watched.exclusions if e.cause == "judge_when is false")
    assert excluded.seconds == pytest.approx(5.15, abs=0.01)
    assert blind.verdict is not Verdict.PASS


def test_a_condition_may_read_states(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol(judge_when=Code("x 0 gt"))

    report = verify(spec, scenes.van_der_pol_drive(1, 60.0, 0.01))

    assert np.all(report.places["x"] > -0.05)


def test_a_signal_that_is_not_there_is_said(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol(
        bindings=(scenes.binding("intervention"),), judge_when=Code("intervention not")
    )

    report = verify(spec, scenes.van_der_pol_drive(1, 30.0, 0.01))

    assert report.verdict is Verdict.INCONCLUSIVE
    assert "intervention is not in the trace" in report.reasons[0]


def test_time_outside_the_domain_is_excluded_and_counted(scenes: ModuleType) -> None:
    spec = scenes.van_der_pol()
    narrow = replace(spec, states=(replace(spec.states[0], high=1.5), spec.states[1]))

    report = verify(narrow, scenes.van_der_pol_drive(1, 60.0, 0.0))

    cause = next(e for e in report.exclusions if e.cause == "x outside its domain")
    assert 10.0 < cause.seconds < 35.0
    assert cause.samples > 200


def test_all_time_is_accounted_for(scenes: ModuleType) -> None:
    drive = cut(scenes.unicycle_drive(3, 60.0, 0.01, late=0.3), "heading", 20.0, 27.0)
    drive = cut(drive, "speed", 40.0, 52.0)
    spec = scenes.unicycle(judge_when=Code("turn -0.5 gt"))

    found = segments_of(spec, needs_of(spec, drive), 5.0)

    taken = sum(each.seconds for each in found.exclusions)
    assert taken + length(found.spans) == pytest.approx(found.whole[1] - found.whole[0])
    samples = sum(each.samples for each in found.exclusions)
    base = drive.series["x"].times
    assert samples + int(np.sum(contains(found.spans, base))) == len(base)
    assert np.all(np.diff(found.spans) >= 5.0 - 1e-6)
