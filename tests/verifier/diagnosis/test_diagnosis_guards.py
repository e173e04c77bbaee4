"""Guards that are off, refitted from where the robot switched."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.program import Fidelity, Program
from specc.loading import load_program
from tests.runtime import hybrids
from tests.study.diagnosis import diagnosed
from tests.verifier.fidelity.switching_robots import Patrol, patrol_log, thermostat_log
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.switching.judge import judged_changes
from verifier.fidelity.switching.setting import setting_of
from verifier.fidelity.switching.thresholds import thresholds_of
from verifier.fidelity.verify import fidelity_of
from verifier.report.diagnosis import CandidateKind, ParameterKind, Told

SPECS = Path(__file__).parents[3] / "specs"


def judged_by(program: Program, tolerance: dict[str, float], horizon: float) -> Program:
    return replace(program, fidelity=Fidelity(tolerance, horizon, {}, 0.0, "spec.yaml:9:1"))


@pytest.fixture(scope="module")
def patrol() -> Program:
    return judged_by(load_program(SPECS / "patrol.yaml"), {"x": 0.05, "v": 0.05}, 2.0)


def test_a_turning_point_that_is_off_is_named_with_what_it_is(patrol: Program) -> None:
    found = diagnosed(patrol, patrol_log(Patrol(x1=1.6).robot(), 120.0, 1))

    (moved,) = (each for each in found.refitted if each.is_moved)
    assert found.told is Told.SAME_STRUCTURE
    assert (moved.kind, moved.name, moved.spec) == (ParameterKind.CONTROL, "x1", 1.5)
    assert moved.interval.low < 1.6 < moved.interval.high
    assert moved.interval.high - moved.interval.low < 0.03
    assert found.sentences[0] == "same structure, other numbers: x1"
    assert found.sentences[1].startswith("x1 is 1.6")
    assert "(spec 1.5), as" in found.sentences[1]
    assert "from forward to back tell" in found.sentences[1]


def test_both_ends_that_are_off_are_named_each(patrol: Program) -> None:
    found = diagnosed(patrol, patrol_log(Patrol(x1=1.6, x2=-1.35).robot(), 120.0, 2))

    moved = {each.name: each.value for each in found.refitted if each.is_moved}
    assert moved == pytest.approx({"x1": 1.6, "x2": -1.35}, abs=0.01)


def test_intervals_hold_the_turning_point(patrol: Program) -> None:
    """95 % each: of eight, seven or eight in 94 of 100 tries."""
    errors = []
    for seed in range(8):
        needs = needs_of(patrol, patrol_log(Patrol(x1=1.42).robot(), 80.0, 10 + seed))
        _, compared = judged_changes(setting_of(patrol, needs, fidelity_of(patrol)))
        assert compared is not None
        ((found,),) = thresholds_of(compared, needs, (0,))
        half = 0.5 * (found.mean.interval.high - found.mean.interval.low)
        errors.append(abs(1.5 + found.mean.mean - 1.42) / half)

    assert np.sum(np.array(errors) <= 1.0) >= 7
    assert max(errors) > 0.1  # and they are not far too wide


def test_a_bare_number_in_a_guard_is_told_with_where_it_stands() -> None:
    thermostat = judged_by(hybrids.thermostat(), {"T": 0.4}, 4.0)

    found = diagnosed(thermostat, thermostat_log(2, off=22.8))

    (taken,) = (each for each in found.candidates if each.is_taken)
    (number,) = taken.numbers
    assert taken.kind is CandidateKind.GUARD
    assert number.interval.low < 22.8 < number.interval.high
    assert taken.label == "22 in the guard from heat to cool"
    assert not any(each.is_moved for each in found.refitted)


def test_of_a_guard_in_time_nothing_is_said(patrol: Program) -> None:
    found = diagnosed(patrol, patrol_log(Patrol(v1=0.4).robot(), 120.0, 3))

    assert not any(each.kind is CandidateKind.GUARD for each in found.candidates)
