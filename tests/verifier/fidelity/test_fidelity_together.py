"""Several recordings judged as one."""

from collections import Counter
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.arrays import Array
from runtime.program import Program
from verifier.fidelity.judging.neighbours import correlation_time, gathered
from verifier.fidelity.judging.structure import MOST, shown_structure
from verifier.fidelity.switching.together import with_every_switching
from verifier.fidelity.together import verify_together
from verifier.fidelity.verify import verify
from verifier.report.report import Interval, Report, Standing, Verdict
from verifier.report.switching import Sample, Switching, Timing, Way
from verifier.traces.trace import Loss, Trace

SETS = 100
RATE = 0.05
"""By how much the drifting robots below run away from their spec, per second: tolerance/horizon."""


def drives(scenes: ModuleType, count: int, seconds: float, noise: float = 0.03) -> list[Trace]:
    return [
        replace(scenes.van_der_pol_drive(seed, seconds, noise), source=f"run{seed}.mcap")
        for seed in range(count)
    ]


def turns(scenes: ModuleType, count: int) -> list[Trace]:
    return [
        replace(scenes.unicycle_drive(seed, 15.0, 0.01), source=f"run{seed}.mcap")
        for seed in range(count)
    ]


def cart(scenes: ModuleType) -> Program:
    return scenes.program(
        (scenes.state("x", -50.0, 50.0),),
        (scenes.control("u", -1.0, 1.0, 0.0),),
        {"x": "u"},
        scenes.fidelity({"x": 2.0 * RATE}, 2.0),
    )


def drifting(scenes: ModuleType, rng: np.random.Generator, seconds: float, name: str) -> Trace:
    """A cart that departs by its tolerance after each horizon: half of that squared is unrest."""
    times = np.arange(0.0, seconds, 0.1)
    switch = np.arange(0.0, seconds, 0.7)
    u = rng.uniform(-1.0, 1.0, len(switch))
    knots = np.union1d(times, switch)
    now = np.searchsorted(switch, knots[:-1], side="right") - 1
    way = np.concatenate([[0.0], np.cumsum(u[now] * np.diff(knots))])
    x = way[np.searchsorted(knots, times)]
    unrest = np.cumsum(rng.standard_normal(len(times))) * RATE * np.sqrt(2.0 * 0.1)
    drift = np.sqrt(0.5) * (RATE * times + unrest)
    measured = x + drift + 0.01 * rng.standard_normal(len(times))
    parts = (scenes.series("x", times, measured), scenes.series("u", switch, u))
    return replace(scenes.trace(*parts), source=name)


def figures(report: Report) -> Array:
    """All that is told of the variables, in numbers."""
    found: list[float] = []
    for each in report.variables:
        for at in each.horizons:
            found += [at.rmse, at.noise, at.departure, at.interval.low, at.interval.high]
        found += [each.systematic, each.scatter, each.mean, each.noise.sigma]
        found += [each.mean_interval.low, each.mean_interval.high]
        for region in each.regions:
            found += [region.mean, region.interval.low, region.interval.high]
    return np.array(found)


def test_short_drives_that_decide_nothing_alone_pass_together(scenes: ModuleType) -> None:
    program, traces = scenes.unicycle(), turns(scenes, 6)
    assert {verify(program, each).verdict for each in traces} == {Verdict.INCONCLUSIVE}

    report = verify_together(program, traces)

    assert report.verdict is Verdict.PASS
    assert report.trace.source == "6 recordings together"
    assert report.trace.judged == pytest.approx(
        sum(verify(program, t).trace.judged for t in traces)
    )


def test_short_drives_with_a_wrong_gain_fail_together(scenes: ModuleType) -> None:
    program, traces = scenes.unicycle(1.05), turns(scenes, 6)
    assert {verify(program, each).verdict for each in traces} == {Verdict.INCONCLUSIVE}

    report = verify_together(program, traces)

    assert report.verdict is Verdict.FAIL
    assert any("heading moves 0.95" in reason for reason in report.reasons)


def test_one_recording_together_is_that_recording(scenes: ModuleType) -> None:
    program, trace = scenes.van_der_pol(), scenes.van_der_pol_drive(1, 20.0, 0.03)

    one, alone = verify_together(program, [trace]), verify(program, trace)

    assert np.array_equal(figures(one), figures(alone))
    assert (one.reasons, one.notes, one.trace) == (alone.reasons, alone.notes, alone.trace)


def test_the_order_of_the_recordings_does_not_matter(scenes: ModuleType) -> None:
    # So long that of the windows only every second foretells others.
    rng = np.random.default_rng(1)
    traces = [drifting(scenes, rng, seconds, f"{seconds}") for seconds in (401.0, 300.0, 9.0)]

    one = verify_together(cart(scenes), traces)
    other = verify_together(cart(scenes), traces[::-1])

    assert len(one.starts) > MOST
    assert one.verdict is other.verdict
    assert figures(other) == pytest.approx(figures(one), rel=1e-6, abs=1e-9)
    assert np.array_equal(one.coverage.samples, other.coverage.samples)


def test_nothing_of_what_lies_between_recordings_counts(scenes: ModuleType) -> None:
    program, traces = scenes.van_der_pol(), drives(scenes, 3, 10.0)
    apart = [replace(each, start=1e5 * k) for k, each in enumerate(traces)]

    assert np.array_equal(
        figures(verify_together(program, traces)), figures(verify_together(program, apart))
    )
    assert (
        gathered(np.array([0, 0, 0, 1, 1, 1, 1, 1, 1, 1]), 3).tolist()
        == [0] * 3 + [1] * 4 + [2] * 3
    )


def test_what_is_common_to_a_recording_is_correlation() -> None:
    runs = np.repeat(np.arange(20), 10)
    rng = np.random.default_rng(1)
    white = rng.standard_normal(200)
    offsets = 3.0 * rng.standard_normal(20)[runs]

    assert correlation_time(white, runs) < 2.0
    assert correlation_time(white + offsets, runs) > 5.0
    assert correlation_time(white, np.zeros(200, np.int64)) == correlation_time(white)


def test_a_cluster_is_foretold_by_the_last_one_of_the_recording_before() -> None:
    situation = np.linspace(-1.0, 1.0, 12)[:, None]
    clusters = np.arange(12) // 3
    errors = 1.0 + 0.001 * situation[:, 0]

    one = shown_structure(errors, situation, clusters, 0.01)
    four = shown_structure(errors, situation, clusters, 0.01, runs=clusters)

    assert four > one


def test_the_coverage_is_that_of_all(scenes: ModuleType) -> None:
    program, traces = scenes.van_der_pol(), drives(scenes, 4, 8.0)
    alone = [verify(program, each).coverage for each in traces]

    found = verify_together(program, traces).coverage

    assert np.array_equal(found.samples, sum(each.samples for each in alone))
    assert found.share >= max(each.share for each in alone)


def test_controls_held_at_different_values_span_the_coverage(scenes: ModuleType) -> None:
    program = replace(cart(scenes), fidelity=scenes.fidelity({"x": 0.1}, 2.0))
    times = np.arange(0.0, 12.0, 0.1)
    held = [
        replace(scenes.trace(scenes.series("x", times, u * times), u=u), source=f"{u}.mcap")
        for u in (0.1, 0.5)
    ]

    assert verify(program, held[0]).coverage.axes[0].name == "x"
    assert [axis.name for axis in verify_together(program, held).coverage.axes] == ["u"]


def test_what_cannot_be_compared_is_named_and_left_out(scenes: ModuleType) -> None:
    program, traces = scenes.unicycle(), turns(scenes, 6)
    brief = replace(scenes.unicycle_drive(9, 3.0, 0.01), source="brief.mcap")
    untold = replace(scenes.unicycle_drive(9, 15.0, 0.01), source="untold.mcap")
    untold = replace(untold, series={n: s for n, s in untold.series.items() if n != "turn"})
    copy = replace(traces[0], source="copy.mcap")

    report = verify_together(program, [brief, untold, *traces, copy])

    assert np.array_equal(figures(report), figures(verify_together(program, traces)))
    left = [reason for reason in report.reasons if "is left out" in reason]
    assert [reason.split(" ")[0] for reason in left] == ["brief.mcap", "untold.mcap", "copy.mcap"]
    assert "turn is neither in the trace" in left[1]


def test_where_nothing_can_be_compared_it_says_so_of_each(scenes: ModuleType) -> None:
    brief = [replace(scenes.unicycle_drive(k, 3.0, 0.01), source=f"{k}.mcap") for k in range(2)]

    report = verify_together(scenes.unicycle(), brief)

    assert report.verdict is Verdict.INCONCLUSIVE
    assert [reason.split(" ")[0] for reason in report.reasons[1:]] == ["0.mcap", "1.mcap"]


def test_no_recordings_are_refused(scenes: ModuleType) -> None:
    with pytest.raises(ValueError, match="at least one"):
        verify_together(scenes.unicycle(), [])


def test_exclusions_and_losses_are_told_by_recording(scenes: ModuleType) -> None:
    first, second = drives(scenes, 2, 10.0)
    torn = replace(second, losses=(Loss("torn chunk", 3, "at its end"),), notes=("slow clock",))

    report = verify_together(scenes.van_der_pol(), [first, torn])

    assert [loss.cause for loss in report.losses] == ["run1.mcap: torn chunk"]
    assert "run1.mcap: slow clock" in report.notes
    assert {each.cause.split(":")[0] for each in report.exclusions} == {"run0.mcap", "run1.mcap"}
    assert any("told by each recording for itself" in note for note in report.notes)


def test_the_noise_is_that_of_each_recording(scenes: ModuleType) -> None:
    quiet = [scenes.van_der_pol_drive(seed, 20.0, 0.002) for seed in range(3)]
    loud = [scenes.van_der_pol_drive(seed, 20.0, 0.06) for seed in range(3, 6)]

    alone = [verify(scenes.van_der_pol(), each).variables[0] for each in quiet + loud]

    found = verify_together(scenes.van_der_pol(), quiet + loud).variables[0]

    assert found.noise.sigma == pytest.approx(np.sqrt((0.002**2 + 0.06**2) / 2.0), rel=0.1)
    carried = np.sqrt(np.mean([each.declared.noise**2 for each in alone]))
    assert found.declared.noise == pytest.approx(carried)


def changes(standing: Standing, expected: int) -> Switching:
    way = Way("go", "rest", expected, 0, 0, 0, None, (), standing, "spec.yaml:1:1")
    return Switching("mode", (way,), (), standing, ("that is why",), ())


@pytest.mark.parametrize(
    ("first", "second", "verdict"),
    [
        (changes(Standing.WITHIN, 9), changes(Standing.WITHIN, 5), Verdict.PASS),
        (changes(Standing.WITHIN, 9), changes(Standing.UNDECIDED, 0), Verdict.PASS),
        (changes(Standing.WITHIN, 9), changes(Standing.UNDECIDED, 2), Verdict.INCONCLUSIVE),
        (changes(Standing.UNDECIDED, 0), changes(Standing.UNDECIDED, 0), Verdict.INCONCLUSIVE),
        (changes(Standing.UNDECIDED, 2), changes(Standing.EXCEEDED, 2), Verdict.FAIL),
        (None, None, Verdict.PASS),
    ],
)
def test_changes_of_mode_make_a_common_verdict_only_worse(
    scenes: ModuleType, first: Switching | None, second: Switching | None, verdict: Verdict
) -> None:
    report = verify(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.01))
    assert report.verdict is Verdict.PASS

    found = with_every_switching(report, [("a.mcap", first), ("b.mcap", second)])

    assert found.verdict is verdict
    if verdict is not Verdict.PASS:
        assert any(reason.endswith(".mcap: that is why") for reason in found.reasons)


def timed(count: int, late: float, allowed: float) -> Switching:
    """A way that was taken so many times, each so much too late (s)."""
    sample = Sample((late,) * count, (0.01,) * count, 0.0)
    few = Interval(-np.inf, np.inf)
    timing = Timing(count, late, few, allowed, "", 0.05, Standing.UNDECIDED, sample)
    way = Way("go", "rest", count, 0, 0, 0, timing, (), Standing.UNDECIDED, "spec.yaml:1:1")
    return Switching("mode", (way,), (), Standing.UNDECIDED, ("too few",), ())


@pytest.mark.parametrize(
    ("switchings", "verdict"),
    [
        ([timed(1, 0.01, 0.1)] * 4, Verdict.PASS),
        ([timed(1, 0.01, 0.1)] * 2, Verdict.INCONCLUSIVE),
        ([timed(2, 0.01, 0.1), timed(2, 0.02, 0.2)], Verdict.PASS),
        ([timed(2, 0.3, 0.1)] * 3, Verdict.FAIL),
    ],
)
def test_switches_of_several_recordings_decide_together_what_few_do_not(
    scenes: ModuleType, switchings: list[Switching], verdict: Verdict
) -> None:
    report = verify(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.01))
    named = [(f"{k}.mcap", each) for k, each in enumerate(switchings)]

    assert with_every_switching(report, named).verdict is verdict


@pytest.mark.slow
def test_at_the_tolerance_hardly_any_verdict_is_given(scenes: ModuleType) -> None:
    program, found = cart(scenes), Counter[Verdict]()
    for number in range(SETS):
        rng = np.random.default_rng(number)
        traces = [drifting(scenes, rng, 8.0, f"{number}-{k}") for k in range(5)]
        found[verify_together(program, traces).verdict] += 1

    assert found[Verdict.PASS] <= 0.06 * SETS
    assert found[Verdict.FAIL] <= 0.06 * SETS
