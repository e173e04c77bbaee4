"""Cycles of robots whose modes alternate: laps are told by the changes of mode."""

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.program import Program
from tests.runtime import hybrids
from verifier.fidelity.stretches.changes import Changes
from verifier.fidelity.stretches.needs import changes_of, needs_of
from verifier.report.features import ComparedFeature, FeatureStanding
from verifier.robot_topology.laps import Laps, period_of_laps
from verifier.robot_topology.loops import mean_lap
from verifier.robot_topology.mode_laps import Round, laps_by_modes, round_of
from verifier.robot_topology.scene import Stretch, scene_of
from verifier.traces.trace import Series, Trace


def _thermostat(scenes: ModuleType) -> Program:
    program: Program = scenes.judged_by(hybrids.thermostat(), {"T": 0.1}, 1.0)
    return program


def _heated(off: float, rate: float, seconds: float, noise: float, seed: int) -> Trace:
    """Towards 40 until `off`, towards 10 until 20, at `rate`: the closed form, at 20 Hz."""
    up, down = np.log(20.0 / (40.0 - off)) / rate, np.log((off - 10.0) / 10.0) / rate
    times = np.arange(0.0, seconds, 0.05)
    phase = np.mod(times + 0.37, up + down)
    heats = phase < up
    rest = phase - up
    T = np.where(
        heats, 40.0 - 20.0 * np.exp(-rate * phase), 10.0 + (off - 10.0) * np.exp(-rate * rest)
    )
    T = T + noise * np.random.default_rng(seed).standard_normal(len(times))
    mode = Series("mode", times, np.where(heats, 0.0, 1.0), "/mode", "sensor")
    series = {"T": Series("T", times, T, "/T", "sensor"), "mode": mode}
    return Trace("room.csv", series, {"k": rate}, 0.0, (), ())


def _period(off: float, rate: float) -> float:
    return float(np.log(20.0 / (40.0 - off)) + np.log((off - 10.0) / 10.0)) / rate


def _cycle(scenes: ModuleType, trace: Trace) -> ComparedFeature:
    found: ComparedFeature = scenes.cycle(scenes.compared(_thermostat(scenes), trace))
    return found


def test_a_thermostat_on_a_single_axis_makes_its_laps(scenes: ModuleType) -> None:
    found = _cycle(scenes, _heated(22.0, 0.1, 100.0, 0.05, 1))
    # 100 s hold 34.8 laps; the first and the last are cut, one may still settle.
    assert 32 <= found.visits <= 34
    assert found.standing is FeatureStanding.WITHIN
    period, amplitude = scenes.number(found, "period"), scenes.number(found, "amplitude of T")
    assert period.seen.value == pytest.approx(_period(22.0, 0.1), abs=0.01)
    assert amplitude.spec == pytest.approx(1.0, abs=1e-6)
    assert amplitude.seen.value == pytest.approx(1.0, abs=0.03)
    assert "the robot makes" in found.sentence


def test_a_thermostat_that_switches_late_has_a_longer_and_a_wider_cycle(
    scenes: ModuleType,
) -> None:
    found = _cycle(scenes, _heated(22.6, 0.1, 100.0, 0.05, 2))
    period, amplitude = scenes.number(found, "period"), scenes.number(found, "amplitude of T")
    assert period.seen.value == pytest.approx(_period(22.6, 0.1), abs=0.02)
    assert amplitude.seen.value == pytest.approx(1.3, abs=0.03)
    assert amplitude.standing is FeatureStanding.EXCEEDED
    assert found.standing is FeatureStanding.EXCEEDED


def test_noise_as_large_as_the_swing_does_not_hide_the_laps(scenes: ModuleType) -> None:
    found = _cycle(scenes, _heated(22.0, 0.1, 100.0, 0.8, 3))
    assert 32 <= found.visits <= 34
    assert found.standing is not FeatureStanding.EXCEEDED


def test_intervals_of_a_cycle_with_corners_hold_the_truth(scenes: ModuleType) -> None:
    program = _thermostat(scenes)
    trace = _heated(22.0, 0.1, 60.0, 0.05, 0)
    [cycle] = scene_of(program, needs_of(program, trace), None).portrait.cycles
    way = round_of(cycle)
    assert way is not None
    misses = 0
    for seed in range(10):
        rate = 0.1 + 0.001 * seed
        trace = _heated(22.4, rate, 60.0, 0.05, seed)
        stretch = Stretch(trace.series["T"].times, trace.series["T"].values[:, None])
        laps = laps_by_modes((stretch,), changes_of(program, needs_of(program, trace)), way)
        lap = mean_lap(laps, cycle, 0.95, np.random.default_rng(seed))
        period = period_of_laps(laps, 0.95)
        assert lap is not None
        assert period is not None
        for found, truth in ((period, _period(22.4, rate)), (lap.amplitude[0], 1.2)):
            misses += not found.interval.low <= truth <= found.interval.high
    # 20 intervals at 95 %: more than 4 misses in 0.3 % of the cases.
    assert misses <= 4


def test_too_few_laps_are_counted_aloud(scenes: ModuleType) -> None:
    found = _cycle(scenes, _heated(22.0, 0.1, 9.0, 0.05, 4))
    assert found.standing is FeatureStanding.NOT_VISITED
    said = "not visited: the robot makes only 1 settled lap of it in this trace (three are needed)."
    assert found.sentence == f"Stable cycle of period 2.877 s: {said}"


def test_a_lap_that_takes_another_way_is_none() -> None:
    """Changes a, b, a, b, then c instead of b, then a, b, a: laps of two changes each."""
    pairs = [(0, 1), (1, 0), (0, 1), (1, 0), (0, 2), (2, 0), (0, 1), (1, 0), (0, 1)]
    times = np.arange(1.0, 10.0)
    left, entered = np.array(pairs).T
    changes = Changes(times, np.zeros(9), left, entered)
    stretch = Stretch(np.arange(0.0, 11.0, 0.1), np.zeros((110, 1)))
    laps = laps_by_modes((stretch,), changes, Round(((0, 1), (1, 0)), np.array([0.0, 0.5])))
    assert [list(each.starts) for each in laps] == [[1.0, 3.0], [7.0, 9.0]]


def test_laps_of_two_stretches_are_not_taken_for_neighbours() -> None:
    """Slow laps in one, quick ones in the other: together they must not look correlated twice."""
    stretch = Stretch(np.arange(0.0, 1.0, 0.1), np.zeros((10, 1)))

    def laps(durations: list[float]) -> Laps:
        starts = np.concatenate([[0.0], np.cumsum(durations)])
        return Laps(stretch, starts, starts[None, :], np.empty(0), 0.0)

    apart = tuple(laps([value]) for value in (1.0, 1.0, 2.0, 2.0, 1.0, 1.0, 2.0, 2.0))
    turned = tuple(reversed(apart[::2])) + apart[1::2]
    one, other = period_of_laps(apart, 0.95), period_of_laps(turned, 0.95)
    assert one is not None
    assert one == other


def test_a_mode_that_is_sampled_seldom_leaves_the_period_in_doubt() -> None:
    """Laps that fall on the samples look exact; their ends are not known better than these."""
    stretch = Stretch(np.arange(0.0, 10.0, 0.1), np.zeros((100, 1)))
    starts = np.arange(0.0, 10.0, 2.0)
    sampled = Laps(stretch, starts, starts[None, :], np.array([0.0, 0.5]), 0.5)
    found = period_of_laps((sampled,), 0.95)
    assert found is not None
    half = 0.5 * (found.interval.high - found.interval.low)
    # Four laps, each end uniform within half a second; Student's t of three degrees is 3.18.
    assert half == pytest.approx(3.182 * 0.5 / np.sqrt(6.0) / 4.0, rel=1e-3)


def test_a_log_of_changes_alone_tells_the_laps_as_well(scenes: ModuleType) -> None:
    trace = _heated(22.0, 0.1, 60.0, 0.05, 5)
    sparse = trace.series["mode"]
    changed = np.concatenate([[True], np.diff(sparse.values) != 0.0])
    events = replace(sparse, times=sparse.times[changed], values=sparse.values[changed])
    found = _cycle(scenes, replace(trace, series={**trace.series, "mode": events}))
    period = scenes.number(found, "period")
    # Stamps of changes are late by half a sample on average, each lap by as much.
    assert period.seen.value == pytest.approx(_period(22.0, 0.1), abs=0.02)
