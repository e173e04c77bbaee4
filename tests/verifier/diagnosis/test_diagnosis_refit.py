"""Sensitivities, the information matrix, and refitted numbers."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import specc
from runtime.program import Program
from tests.study.planted import Wall, wall
from verifier.diagnosis.diagnose import diagnose
from verifier.diagnosis.fitting import extended, intervals_of, plain_fit
from verifier.diagnosis.parameters import effect_of, parameters_of
from verifier.diagnosis.profiled import profiled, setting_of
from verifier.diagnosis.residuals import residuals
from verifier.diagnosis.scene import Scene, scene_of
from verifier.diagnosis.sensitivities import sensitivities
from verifier.fidelity.verify import judged
from verifier.report.diagnosis import Told
from verifier.traces.trace import Trace

SPECS = Path(__file__).parents[3] / "specs"


@pytest.fixture(scope="module")
def wall_follow() -> Program:
    return specc.load_program(SPECS / "wall_follow.yaml")


def scene(program: Program, trace: Trace) -> Scene:
    _, study = judged(program, trace)
    assert study is not None
    return scene_of(program, study)


def test_refitted_gains_are_unbiased_and_their_intervals_hold(wall_follow: Program) -> None:
    gains, held = [], 0
    for seed in range(4):
        here = scene(wall_follow, wall(Wall(), seed))
        parameters = parameters_of(wall_follow, here.needs)
        (gain,) = (effect_of(p) for p in parameters if p.label == "gain of the rate of heading")
        fitted = extended(here, plain_fit(here), gain)
        (interval,) = intervals_of(here, fitted, 0.95)
        gains.append(fitted.values[0])
        held += interval.low <= 1.0 <= interval.high

    # A single gain is known to about 0.014; the mean of 4 to 0.007.
    assert np.mean(gains) == pytest.approx(1.0, abs=0.015)
    assert held >= 3


def test_the_information_on_the_speed_is_that_of_a_straight_line(wall_follow: Program) -> None:
    """While its heading is held at 0.3 rad, distance grows by speed sin 0.3: a line, free start."""
    still = dict.fromkeys(("stiffness", "damping"), 0.0)
    here = scene(wall_follow, wall(Wall(), 1))
    register = {**here.plain.register, **still}
    calm = replace(here, plain=replace(here.plain, register=register))
    (speed,) = (p for p in parameters_of(wall_follow, here.needs) if p.label == "speed")
    starts = np.array(here.start)
    starts[:, 1] = 0.3
    sigma = np.array([0.01, 1e-5])  # the heading is known, so that the start has no say in it

    found = profiled(calm, (effect_of(speed),), (0.4,), starts, sigma)

    d = here.observed[0]
    spread = [np.sum((t[u] - np.mean(t[u])) ** 2) for t, u in zip(d.times, d.used, strict=True)]
    wanted = np.sum(spread) * np.sin(0.3) ** 2
    # Slopes are differences of a ten-thousandth.
    assert np.sum(found.slopes[..., : d.values.shape[1], 0] ** 2) == pytest.approx(wanted, rel=1e-3)


def test_the_information_matrix_is_symmetric_and_sees_no_more_than_there_is(
    wall_follow: Program,
) -> None:
    here = scene(wall_follow, wall(Wall(), 1))

    found = sensitivities(here, parameters_of(wall_follow, here.needs))

    labels = [each.label for each in found.parameters]
    size = np.sqrt(np.diag(found.information))
    shared = found.information / np.outer(size, size)
    # A faster robot and a larger gain of its first rate are one and the same.
    pair = labels.index("speed"), labels.index("gain of the rate of distance")
    assert found.information == pytest.approx(found.information.T)
    assert shared[pair] == pytest.approx(1.0, abs=1e-6)
    assert np.min(np.linalg.eigvalsh(shared)) < 1e-6


def test_what_free_starts_leave_does_not_hang_on_where_they_began(wall_follow: Program) -> None:
    here = scene(wall_follow, wall(Wall(), 3))
    sigma = np.array([0.01, 0.02])
    once = profiled(here, (), (), here.start, sigma)
    moved = here.start + np.array([0.005, -0.01])

    other = profiled(here, (), (), moved, sigma)

    # What is left is linear in the start up to the curvature of the flow over 5 mm and 0.01 rad.
    assert other.residual == pytest.approx(once.residual, abs=2e-4)
    assert other.improved == pytest.approx(once.improved, abs=1e-3)


def test_the_plain_setting_predicts_what_the_verdict_predicts(wall_follow: Program) -> None:
    here = scene(wall_follow, wall(Wall(), 3, noise=1e-6))
    fitted = plain_fit(here)

    left = residuals(here, [setting_of(here, (), ())], fitted.starts[None])[0]

    # The robot's integrator, Heun's rule, errs by the third power of its 5 ms at rates of 2 1/s.
    assert np.max(np.abs(left)) < 1e-4


def test_a_number_that_moved_is_told_with_its_interval(wall_follow: Program) -> None:
    trace = wall(Wall(speed=0.46), 2)
    report, study = judged(wall_follow, trace)

    found = diagnose(wall_follow, trace, study, report)

    (speed,) = (each for each in found.refitted if each.is_moved)
    assert found.told is Told.SAME_STRUCTURE
    assert (speed.name, speed.spec) == ("speed", 0.4)
    assert speed.interval.low < 0.46 < speed.interval.high
    assert speed.interval.high - speed.interval.low < 0.02
    assert speed.origin.endswith("wall_follow.yaml:23:3")
    assert all(each.after < each.before for each in found.after)
