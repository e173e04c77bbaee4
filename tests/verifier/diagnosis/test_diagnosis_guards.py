"""Guards that are off, refitted from where the robot switched."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.code import Code
from runtime.program import Fidelity, Program
from specc.loading import load_program
from tests.runtime import hybrids
from tests.study.diagnosis import diagnosed
from tests.verifier.fidelity.switching_robots import Patrol, patrol_log, thermostat_log
from verifier.diagnosis.guards import with_guards
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.switching.judge import judged_changes
from verifier.fidelity.switching.means import Mean
from verifier.fidelity.switching.setting import setting_of
from verifier.fidelity.switching.thresholds import Number, agrees, share_by_others, thresholds_of
from verifier.fidelity.verify import fidelity_of
from verifier.report.diagnosis import CandidateKind, Diagnosis, ParameterKind, Told
from verifier.report.report import Interval
from verifier.report.switching import NO_SAMPLE

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
        switching, compared = judged_changes(setting_of(patrol, needs, fidelity_of(patrol)))
        assert compared is not None
        ((found,),) = thresholds_of(compared, needs, switching.ways, (True, False)).groups
        half = 0.5 * (found.mean.interval.high - found.mean.interval.low)
        errors.append(abs(1.5 + found.mean.mean - 1.42) / half)

    assert np.sum(np.array(errors) <= 1.0) >= 7
    assert np.median(errors) > 0.1  # and they are not far too wide: about 0.34 is right


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


def test_a_share_is_what_the_mean_of_all_other_switches_explains() -> None:
    moved = np.random.default_rng(4).normal(0.3, 0.2, 7)

    left = [moved[i] - np.mean(np.delete(moved, i)) for i in range(len(moved))]

    assert share_by_others(moved) == pytest.approx(1.0 - np.sum(np.square(left)) / np.sum(moved**2))


def test_three_switches_that_a_mean_of_them_fits_by_chance_explain_little() -> None:
    """Their own mean explains 0.6 of them; that of the two others a tenth."""
    spread = np.sqrt(0.4) * np.array([-1.0, 0.0, 1.0]) * np.sqrt(1.5)

    assert share_by_others(np.sqrt(0.6) + spread) == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("apart", "count", "told"), [(0.9, 10, "yes"), (1.1, 10, "no"), (0.9, 2, "?"), (0.0, 2, "yes")]
)
def test_a_guard_agrees_within_the_interval_of_its_own_switches(
    apart: float, count: int, told: str
) -> None:
    values = np.random.default_rng(5).normal(0.0, 1.0, count)
    half = 2.262157 * np.std(values, ddof=1) / np.sqrt(count)  # Student's t, nine degrees
    mean = Mean(40, float(np.mean(values) + apart * half), Interval(-1.0, 1.0), 0.0, 0.5, NO_SAMPLE)

    found = agrees((values, np.zeros(count), 0.0, 0.0), Number("x1", 0.0, (0,)), mean)

    assert {True: "yes", False: "no", None: "?"}[found] == told


def test_of_two_switches_that_come_too_early_it_is_said_that_they_are_few(patrol: Program) -> None:
    quick = judged_by(patrol, {"x": 0.05, "v": 0.05}, 0.5)
    needs = needs_of(quick, patrol_log(Patrol(x1=0.5).robot(), 14.0, 1))
    before = Diagnosis(Told.NO_DIFFERENCE, ("no difference",), (), (), (), ())

    found = with_guards(before, quick, needs, fidelity_of(quick))

    assert found.told is Told.CANNOT_TELL
    assert found.sentences[0].startswith("this trace does not tell why the robot switches")
    assert "2 switches tell too little of the guard from forward to back" in found.sentences[1]


def test_of_a_number_that_the_rates_read_too_it_is_said_that_it_was_not_tried(
    patrol: Program,
) -> None:
    first, second = patrol.field.guards
    first = replace(first, condition=Code("x v1 v1 add v1 add sub"))
    other = replace(patrol, field=replace(patrol.field, guards=(first, second)))
    needs = needs_of(other, patrol_log(Patrol(x1=1.6).robot(), 80.0, 1))
    before = Diagnosis(Told.NO_DIFFERENCE, ("no difference",), (), (), (), ())

    found = with_guards(before, other, needs, fidelity_of(other))

    assert found.told is Told.CANNOT_TELL
    assert "reads v1, which the rates read, too" in found.sentences[1]
    assert not any("structure" in said for said in found.sentences)
