"""Cycles of robots beside those of their specs."""

import math
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from compiler.compile_file import compile_file
from runtime.claim import Claim, Reach
from runtime.code import Code
from runtime.program import Fidelity
from verifier.fidelity.stretches.needs import needs_of
from verifier.report.features import Estimate, FeatureStanding
from verifier.robot_topology.laps import laps_of, period_of_laps
from verifier.robot_topology.loops import mean_lap
from verifier.robot_topology.scene import scene_of
from verifier.traces.trace import Series, Trace

SPECS = Path(__file__).parents[3] / "specs"


def _off(estimate: Estimate | None, truth: float) -> float:
    """How far an estimate is off, in half intervals."""
    assert estimate is not None
    return abs(estimate.value - truth) / (0.5 * (estimate.interval.high - estimate.interval.low))


def test_a_robot_with_another_damping_has_its_own_period_and_amplitude(
    scenes: ModuleType,
) -> None:
    truth = scenes.cycle_of(1.1)
    program = scenes.oscillator((0.02, 0.04))
    times, states = scenes.driven(scenes.van_der_pol(1.1), [[1.0, 0.5]], 60.0)
    found = scenes.cycle(scenes.compared(program, scenes.measured(program, times, states, 0.02, 1)))
    assert found.standing is FeatureStanding.EXCEEDED
    for name, value in zip(("period", "amplitude of x", "amplitude of v"), truth, strict=True):
        number = scenes.number(found, name)
        assert _off(number.seen, value) < 2.0
        assert _off(number.refitted, value) < 2.0
    assert scenes.number(found, "period").standing is FeatureStanding.EXCEEDED
    assert "its period is 0.07" in found.sentence
    assert "the tolerance allows" in found.sentence


def test_a_faithful_robot_is_within_and_both_ways_agree(scenes: ModuleType) -> None:
    program = scenes.oscillator()
    times, states = scenes.driven(scenes.van_der_pol(1.0), [[-1.0, 0.3]], 60.0)
    found = scenes.cycle(scenes.compared(program, scenes.measured(program, times, states, 0.02, 2)))
    assert found.standing is FeatureStanding.WITHIN
    for number in found.numbers:
        assert number.seen is not None
        assert number.refitted is not None
        room = 0.5 * number.tolerance
        assert number.seen.value == pytest.approx(number.refitted.value, abs=room)
    assert found.visits >= 5
    assert found.robot_path.shape[1] == 2


def test_intervals_of_periods_and_amplitudes_hold_the_truth(scenes: ModuleType) -> None:
    truth = scenes.cycle_of(1.1)
    program = scenes.oscillator()
    times, states = scenes.driven(scenes.van_der_pol(1.1), [[2.0, 0.0]], 50.0)
    misses = 0
    for seed in range(10):
        trace = scenes.measured(program, times, states, 0.02, seed)
        scene = scene_of(program, needs_of(program, trace), None)
        [cycle] = scene.portrait.cycles
        laps = laps_of(scene, cycle)
        lap = mean_lap(laps, cycle, 0.95, np.random.default_rng(seed))
        assert lap is not None
        found = (period_of_laps(laps, 0.95), *lap.amplitude)
        misses += sum(_off(f, t) > 1.0 for f, t in zip(found, truth, strict=True))
    # 30 intervals at 95 %: more than 6 misses in 0.1 % of the cases.
    assert misses <= 6


def test_a_patrol_that_is_slow_one_way_is_late_by_the_closed_form(scenes: ModuleType) -> None:
    spec = compile_file(SPECS / "patrol.yaml", lambda _what, _done, _of: None).program
    program = replace(spec, fidelity=Fidelity({"x": 0.05, "v": 0.1}, 4.0, {}, 0.0, ""))
    times = np.arange(0.0, 120.0, 0.05)
    period = 3.0 / 0.45 + 3.0 / 0.5
    phase = np.mod(times, period)
    ahead = phase < 3.0 / 0.45
    x = np.where(ahead, -1.5 + 0.45 * phase, 1.5 - 0.5 * (phase - 3.0 / 0.45))
    states = np.column_stack([x, np.where(ahead, 0.45, -0.5)])
    controls = {"x1": 1.5, "x2": -1.5, "v1": 0.5, "v2": 0.5}
    trace = scenes.measured(program, times, states, 0.01, 3, **controls)
    going = Series("going", times, np.where(ahead, 0.0, 1.0), "/going", "driver")
    trace = replace(trace, series={**trace.series, "going": going})
    found = scenes.cycle(scenes.compared(program, trace))
    number = scenes.number(found, "period")
    assert number.seen is not None
    assert number.seen.value == pytest.approx(period, abs=5e-3)
    assert number.standing is FeatureStanding.EXCEEDED
    assert scenes.number(found, "amplitude of x").standing is FeatureStanding.WITHIN
    assert found.is_declared
    assert found.origin.endswith("patrol.yaml:46:5")


def test_a_resting_robot_makes_no_laps(scenes: ModuleType) -> None:
    program = scenes.oscillator()
    times = np.arange(0.0, 60.0, 0.05)
    states = np.tile([1.0, 0.0], (len(times), 1))
    features = scenes.compared(program, scenes.measured(program, times, states, 0.01, 4))
    assert scenes.cycle(features).standing is FeatureStanding.NOT_VISITED
    alone = [f for f in features.features if not f.in_spec]
    assert len(alone) == 1
    assert "where the spec has no attractor" in alone[0].sentence


def test_what_is_allowed_is_the_wider_of_claim_and_tolerance(scenes: ModuleType) -> None:
    claim = Claim(
        text="one stable cycle: x from -2 to 2",
        feature="stable cycle",
        least=1,
        most=1,
        other=False,
        places=(),
        reaches=(Reach("x", Code("-2"), Code("2"), 0.2),),
        period=Code("6.66"),
        period_within=1e-4,
        share=None,
        goes_to="",
        called="",
        over=(),
        settings=(),
        sketched=False,
        origin="spec.yaml:9:5",
    )
    program = replace(scenes.oscillator(), claims=(replace(claim, period_within=1e-2),))
    times, states = scenes.driven(scenes.van_der_pol(1.0), [[2.0, 0.0]], 40.0)
    found = scenes.cycle(scenes.compared(program, scenes.measured(program, times, states, 0.01, 5)))
    assert found.claim == claim.text
    assert found.origin == "spec.yaml:9:5"
    assert scenes.number(found, "highest x").allowed_by == "the claim"
    assert scenes.number(found, "highest x").tolerance == 0.2
    # x swings 4 times its amplitude of 2.0086 a lap: a lap late by p is p * 2 s * speed off.
    by_tolerance = 0.05 / (4 * 2.0086 / 6.6633) / 2.0 * 6.6633
    assert scenes.number(found, "period").allowed_by == "the tolerance"
    assert scenes.number(found, "period").tolerance == pytest.approx(by_tolerance, rel=1e-3)


def test_a_trace_without_a_state_is_told(scenes: ModuleType) -> None:
    times, states = scenes.driven(scenes.van_der_pol(1.0), [[2.0, 0.0]], 20.0)
    program = scenes.oscillator()
    trace = scenes.measured(program, times, states, 0.01, 6)
    only_x = Trace("drive.mcap", {"x": trace.series["x"]}, {}, 0.0, (), ())
    features = scenes.compared(program, only_x)
    assert features.features == ()
    assert features.notes == ("not compared: the trace lacks v",)
    assert math.isclose(features.confidence, 0.95)
