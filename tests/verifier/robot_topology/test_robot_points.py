"""Attractors and saddles of robots beside those of their specs."""

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.arrays import Array
from verifier.report.features import FeatureStanding
from verifier.traces.trace import Series

STARTS = [
    [-0.3, 1.2],
    [0.25, -1.3],
    [-1.7, 0.8],
    [1.7, -0.9],
    [0.1, 1.6],
    [-0.1, -1.5],
    [0.6, 0.9],
    [-0.6, -0.9],
]


def test_a_moved_attractor_exceeds_and_the_others_stay_within(scenes: ModuleType) -> None:
    program = scenes.wells()
    times, states = scenes.driven(scenes.in_wells(-1.2, 0.0, 1.0), STARTS, 12.0)
    features = scenes.compared(program, scenes.measured(program, times, states, 0.01, 1))
    moved = scenes.near(features, x=-1.0, y=0.0)
    assert moved.standing is FeatureStanding.EXCEEDED
    assert scenes.number(moved, "x").robot.value == pytest.approx(-1.2, abs=0.01)
    assert scenes.number(moved, "y").standing is FeatureStanding.WITHIN
    kept = scenes.near(features, x=1.0, y=0.0)
    assert kept.standing is FeatureStanding.WITHIN
    assert scenes.near(features, x=0.0, y=0.0).standing is not FeatureStanding.EXCEEDED


def test_a_moved_saddle_is_found_by_the_refitted_field_alone(scenes: ModuleType) -> None:
    program = scenes.wells()
    starts = [[0.2 + 0.04 * (-1) ** i, y] for i, (_, y) in enumerate(STARTS)]
    times, states = scenes.driven(scenes.in_wells(-1.0, 0.2, 1.0), starts, 12.0)
    features = scenes.compared(program, scenes.measured(program, times, states, 0.01, 2))
    saddle = scenes.near(features, x=0.0, y=0.0)
    number = scenes.number(saddle, "x")
    assert saddle.kind == "saddle"
    assert number.seen is None
    assert number.refitted.interval.low <= 0.2 <= number.refitted.interval.high
    assert saddle.standing is FeatureStanding.EXCEEDED
    assert "the field refitted to the robot has it at" in saddle.sentence


def test_what_the_robot_never_came_near_is_not_visited(scenes: ModuleType) -> None:
    program = scenes.wells()
    starts = [[1.6, 0.5], [0.7, -0.5], [1.4, -0.4], [0.8, 0.4]]
    times, states = scenes.driven(scenes.in_wells(-1.0, 0.0, 1.0), starts, 10.0)
    features = scenes.compared(program, scenes.measured(program, times, states, 0.01, 3))
    assert scenes.near(features, x=-1.0, y=0.0).standing is FeatureStanding.NOT_VISITED
    assert scenes.near(features, x=0.0, y=0.0).standing is FeatureStanding.NOT_VISITED
    assert scenes.near(features, x=1.0, y=0.0).standing is FeatureStanding.WITHIN
    sentence = scenes.near(features, x=-1.0, y=0.0).sentence
    assert sentence == "Stable node at x = -1, y = 0: not visited by the robot in this trace."


@pytest.mark.parametrize("seed", range(3))
def test_process_noise_alone_condemns_no_feature(scenes: ModuleType, seed: int) -> None:
    rng = np.random.default_rng(seed)
    program = scenes.wells()
    rate = scenes.in_wells(-1.0, 0.0, 1.0)
    step, parts, times = 0.05, [], []
    for i, start in enumerate(STARTS):
        x: Array = np.array(start)
        for k in range(240):
            parts.append(x)
            times.append(14.0 * i + step * k)
            half = x + 0.5 * step * np.array(rate(0.0, x))
            push = 0.03 * np.sqrt(step) * rng.standard_normal(2)
            x = x + step * np.array(rate(0.0, half)) + push
    trace = scenes.measured(program, np.array(times), np.array(parts), 0.01, seed)
    features = scenes.compared(program, trace)
    assert all(f.standing is not FeatureStanding.EXCEEDED for f in features.features)
    assert scenes.near(features, x=1.0, y=0.0).standing is FeatureStanding.WITHIN


def test_a_pendulum_rests_where_its_spec_does_and_a_bent_one_elsewhere(
    scenes: ModuleType,
) -> None:
    program = scenes.swinging()
    for bent, standing in ((0.0, FeatureStanding.WITHIN), (0.1, FeatureStanding.EXCEEDED)):
        times, states = scenes.driven(
            lambda _, s, bent=bent: [s[1], -9.0 * np.sin(s[0] - bent) - 0.6 * s[1]],
            [[2.5, 0.0]],
            50.0,
        )
        # From the upper side of the seam: whole turns must not count.
        states[:, 0] = np.mod(states[:, 0] + 2.0 * np.pi + np.pi, 2.0 * np.pi) - np.pi
        features = scenes.compared(program, scenes.measured(program, times, states, 0.01, 4))
        rest = scenes.near(features, angle=0.0, rate=0.0)
        assert rest.standing is standing
        assert scenes.number(rest, "angle").robot.value == pytest.approx(bent, abs=0.01)
        top = scenes.near(features, angle=-np.pi, rate=0.0)
        assert top.standing is FeatureStanding.NOT_VISITED


def test_features_are_those_of_the_setting_that_held_longest(scenes: ModuleType) -> None:
    plain = scenes.behavior(
        "homing",
        (scenes.state("x", -3.0, 3.0),),
        ("home x sub",),
        (scenes.control("home", -2.0, 2.0, 0.0),),
    )
    program = scenes.judged_by(plain, {"x": 0.05}, 1.0)
    times = np.arange(0.0, 60.0, 0.05)
    home = np.where(times < 20.0, -1.0, 1.5)
    x = np.where(times < 20.0, -1.0 + 1.5 * np.exp(-times), 1.5 - 2.5 * np.exp(-(times - 20.0)))
    trace = scenes.measured(program, times, x[:, None], 0.01, 5)
    told = Series("home", times, home, "/home", "plan")
    features = scenes.compared(program, replace(trace, series={**trace.series, "home": told}))
    assert dict(features.settings)["home"] == pytest.approx(1.5)
    [rest] = features.features
    assert scenes.number(rest, "x").spec == pytest.approx(1.5)
    assert rest.standing is FeatureStanding.WITHIN
    assert "held for 67 % of the time" in features.notes[0]


def test_a_robot_that_sticks_rests_where_its_spec_would_move_on(scenes: ModuleType) -> None:
    program = scenes.wells()
    stuck = lambda _, s: [-np.sign(s[0]) * np.tanh(8.0 * (abs(s[0]) - 0.5)), -s[1]]  # noqa: E731
    times, states = scenes.driven(stuck, [[1.5, 1.0], [1.2, -1.0]], 15.0)
    features = scenes.compared(program, scenes.measured(program, times, states, 0.01, 6))
    alone = [f for f in features.features if not f.in_spec]
    told = [*alone, scenes.near(features, x=1.0, y=0.0)]
    assert any(f.standing is FeatureStanding.EXCEEDED for f in told)
    places = [scenes.number(f, "x").robot for f in told if f.standing is FeatureStanding.EXCEEDED]
    assert any(place.value == pytest.approx(0.5, abs=0.01) for place in places)
