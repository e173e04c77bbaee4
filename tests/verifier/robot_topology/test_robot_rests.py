"""What counts as holding a setting, and as resting: staying, for several time constants."""

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.arrays import Array
from runtime.program import Program
from verifier.fidelity.stretches.needs import needs_of
from verifier.report.features import Features, FeatureStanding
from verifier.robot_topology.rests import rests_of
from verifier.robot_topology.scene import Scene, scene_of
from verifier.robot_topology.settings import Setting, longest_setting
from verifier.traces.trace import Series, Trace


def _homing(scenes: ModuleType) -> Program:
    """x' = home - x: it settles within a second."""
    plain = scenes.behavior(
        "homing",
        (scenes.state("x", -3.0, 3.0),),
        ("home x sub",),
        (scenes.control("home", -2.0, 2.0, 0.0),),
    )
    program: Program = scenes.judged_by(plain, {"x": 0.05}, 1.0)
    return program


def _led(scenes: ModuleType, times: Array, home: Array, noise: float = 0.0) -> Trace:
    x = np.empty_like(home)
    x[0] = home[0]
    for k in range(1, len(times)):
        x[k] = home[k] + (x[k - 1] - home[k]) * np.exp(-(times[k] - times[k - 1]))
    trace: Trace = scenes.measured(_homing(scenes), times, x[:, None], 0.01, 5)
    seen = home + noise * np.random.default_rng(6).standard_normal(len(home))
    told = Series("home", times, seen, "/home", "plan")
    return replace(trace, series={**trace.series, "home": told})


def _setting(scenes: ModuleType, trace: Trace) -> Setting:
    program = _homing(scenes)
    needs = needs_of(program, trace)
    return longest_setting(program, needs, trace.series["x"].times, 1.0)


def _hidden(scenes: ModuleType, times: Array, home: Array) -> Scene:
    """The robot goes where `home` goes, which the log does not tell."""
    trace = _led(scenes, times, home)
    only_x = Trace("drive.csv", {"x": trace.series["x"]}, {"home": 0.0}, 0.0, (), ())
    program = _homing(scenes)
    return scene_of(program, needs_of(program, only_x), None)


TIMES = np.arange(0.0, 200.0, 0.05)


@pytest.mark.parametrize("period", [20.0, 60.0, 150.0])
@pytest.mark.parametrize("noise", [0.0, 0.005])
def test_a_sine_never_holds_a_setting(scenes: ModuleType, period: float, noise: float) -> None:
    home = 0.4 * np.sin(2.0 * np.pi * TIMES / period)
    setting = _setting(scenes, _led(scenes, TIMES, home, noise))
    # At 150 s and with noise, the crest is flat within the noise for some seconds: no more.
    assert setting.share <= (0.1 if noise > 0.0 and period > 100.0 else 0.0)
    assert [name for name, _ in setting.varied] == ["home"]


def test_steps_hold_their_setting_with_and_without_noise(scenes: ModuleType) -> None:
    home = np.where(np.mod(TIMES, 20.0) < 12.0, 1.0, -0.5)
    for noise in (0.0, 0.005):
        setting = _setting(scenes, _led(scenes, TIMES, home, noise))
        assert setting.share == pytest.approx(0.6, abs=0.02)
        assert dict(setting.values)["home"] == pytest.approx(1.0, abs=0.002)


def test_an_input_that_stays_within_a_hundredth_of_its_domain_did_not_vary(
    scenes: ModuleType,
) -> None:
    home = 1.0 + 0.02 * np.sin(0.1 * TIMES)
    setting = _setting(scenes, _led(scenes, TIMES, home))
    assert setting.share > 0.98
    assert setting.varied == ()


def test_a_note_tells_that_the_inputs_kept_changing(scenes: ModuleType) -> None:
    home = 0.4 * np.sin(2.0 * np.pi * TIMES / 20.0)
    features: Features = scenes.compared(_homing(scenes), _led(scenes, TIMES, home))
    assert features.notes[0].startswith("the inputs kept changing")
    assert "held for" not in " ".join(features.notes)
    assert "rests" not in " ".join(f.sentence for f in features.features)


@pytest.mark.parametrize("period", [20.0, 60.0, 150.0])
def test_the_turning_points_of_a_hidden_sine_are_no_rests(
    scenes: ModuleType, period: float
) -> None:
    for phase in (0.0, 1.0, 2.0, 4.0):
        home = 0.4 * np.sin(2.0 * np.pi * TIMES / period + phase)
        assert rests_of(_hidden(scenes, TIMES, home), 1.0) == ()


@pytest.mark.parametrize("speed", [0.003, 0.01, 0.03])
def test_a_slow_drift_is_no_rest(scenes: ModuleType, speed: float) -> None:
    assert rests_of(_hidden(scenes, TIMES, -0.5 + speed * TIMES), 1.0) == ()


def test_a_robot_that_is_pushed_rests_as_often_as_it_comes_back(scenes: ModuleType) -> None:
    home = np.where(np.mod(TIMES, 40.0) < 39.5, 0.3, 2.0)
    rests = rests_of(_hidden(scenes, TIMES, home), 1.0)
    assert len(rests) == 5
    for rest in rests:
        assert rest.place[0] == pytest.approx(0.3, abs=0.01)


def test_a_place_passed_by_is_never_both_passed_and_not_visited(scenes: ModuleType) -> None:
    """The robot of a hidden slow sine comes by the spec's home again and again."""
    home = 0.4 * np.sin(2.0 * np.pi * TIMES / 150.0)
    trace = _led(scenes, TIMES, home)
    only_x = Trace("drive.csv", {"x": trace.series["x"]}, {"home": 0.0}, 0.0, (), ())
    [point] = scenes.compared(_homing(scenes), only_x).features
    [number] = point.numbers
    assert point.standing is not FeatureStanding.NOT_VISITED
    assert number.standing is not FeatureStanding.NOT_VISITED
    assert ("comes near" in point.sentence) or (number.robot is not None)
    assert "not visited" not in point.sentence
