"""A joint whose sensor is late, whose speed is bounded, whose set-point jumps between samples."""

import numpy as np
import pytest

from runtime.program import Program
from tests.study.diagnosis import diagnosed
from tests.verifier.diagnosis.joint import joint, program
from verifier.report.diagnosis import Candidate, CandidateKind, Diagnosis, Told


@pytest.fixture(scope="module")
def spec(tmp_path_factory: pytest.TempPathFactory) -> Program:
    return program(tmp_path_factory.mktemp("joint"))


def taken(found: Diagnosis) -> list[Candidate]:
    return [each for each in found.candidates if each.is_taken]


def test_a_late_sensor_is_named_though_its_first_moments_tell_nothing(spec: Program) -> None:
    """Until its first value arrives, a late sensor repeats one that no delay explains."""
    found = diagnosed(spec, joint(5, late=250))

    (only,) = taken(found)
    assert (only.kind, only.applies_to) == (CandidateKind.LATE_LOG, ("q",))
    assert only.numbers[0].value == pytest.approx(-0.25, abs=0.01)
    assert only.evidence.share > 0.95


@pytest.mark.parametrize(
    ("least", "most", "label", "value", "words"),
    [
        (-1.0, 1.0, "bound of w", 1.0, "w goes no further than"),
        (-9.0, 0.8, "upper bound of w", 0.8, "w goes no higher than"),
        (-0.7, 9.0, "lower bound of w", -0.7, "w goes no lower than"),
    ],
)
def test_a_state_that_stops_at_a_bound_is_named_with_it(
    spec: Program, least: float, most: float, label: str, value: float, words: str
) -> None:
    found = diagnosed(spec, joint(10, held=lambda w: float(np.clip(w, least, most))))

    (only,) = taken(found)
    assert (only.kind, only.label) == (CandidateKind.BOUND, label)
    (number,) = only.numbers
    assert number.value == pytest.approx(value, abs=0.01)
    assert number.interval.high - number.interval.low < 0.02
    assert words in only.sentence
    assert all(each.after < 0.5 * each.tolerance for each in found.after)


@pytest.mark.parametrize("seed", [0, 2])
def test_a_set_point_that_jumps_between_samples_is_late_by_half_of_one(
    spec: Program, seed: int
) -> None:
    """It is known up to one sample later: on average, half of one late."""
    found = diagnosed(spec, joint(seed, grid=1))

    (only,) = taken(found)
    assert (only.kind, only.applies_to) == (CandidateKind.LATE_LOG, ("target",))
    assert only.numbers[0].value == pytest.approx(-0.025, abs=0.01)
    assert "target is logged every 0.05 s and may jump in between" in only.sentence


def test_two_causes_together_are_told_without_the_rivals_of_each_alone(spec: Program) -> None:
    found = diagnosed(spec, joint(4, seconds=60.0, grid=1, damping=4.4))

    named = {each.applies_to: each for each in taken(found)}
    assert set(named) == {("target",), ("kd",)}
    assert named["target",].kind is CandidateKind.LATE_LOG
    assert found.told is not Told.CANNOT_TELL
    (damping,) = named["kd",].numbers
    assert damping.value == pytest.approx(4.4, abs=0.06)
