"""What a diagnosis says of regions that are left, and what the report advises on it."""

from dataclasses import replace

import pytest

from runtime.program import Unit
from tests.verifier.fidelity.conftest import unicycle, unicycle_drive
from verifier.diagnosis.altered import Effect, Number
from verifier.diagnosis.naming import label_of
from verifier.diagnosis.sentences import of_candidate, where
from verifier.fidelity.verify import verify
from verifier.report.advice import advised
from verifier.report.diagnosis import (
    Candidate,
    CandidateKind,
    Diagnosis,
    Evidence,
    FittedNumber,
    ParameterKind,
    Refitted,
    Told,
)
from verifier.report.report import Interval, RegionMean, Report, Standing

METRE = Unit("m", 1.0)
UNITS = {"heading": Unit("rad", 1.0), "turn": Unit("rad/s", 1.0)}


def region(**changes: object) -> RegionMean:
    plain = RegionMean({}, {}, None, None, 40, 0.03, Interval(0.02, 0.04), Standing.EXCEEDED)
    return replace(plain, **changes)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "heading still differs"),
        ({"moved": -0.38}, "heading still differs where it should fall by 0.38 rad"),
        ({"hurried": 0.2}, "heading still differs where its rate should rise during the window"),
        (
            {"bounds": {"turn": (0.1, 0.3)}, "moved": 0.2},
            "heading still differs where turn is 0.1 to 0.3 rad/s and it should rise by 0.2 rad",
        ),
    ],
)
def test_where_a_variable_still_differs_is_said_as_the_verdict_says_it(
    changes: dict[str, object], said: str
) -> None:
    assert where("heading", region(**changes), UNITS) == said


def effect(kind: CandidateKind, *names: str, **more: object) -> Effect:
    """Its label says nothing."""
    number = Number("", METRE, 0.0, 0.1, -9.0, 9.0)
    plain = Effect(kind, names, "label", (number, number), lambda setting, _: setting, "")
    return replace(plain, **more)


@pytest.mark.parametrize(
    ("tried", "said"),
    [
        (effect(CandidateKind.DEAD_TIME, "turn"), "turn acts 0.5 m later than the spec says"),
        (
            effect(CandidateKind.LAG, "x", subject="the rate of x"),
            "the rate of x acts through a first-order lag of 0.5 m",
        ),
        (
            effect(CandidateKind.CLOCK_OFFSET, "x", "y", subject="/odom"),
            "the stamps of /odom are 0.5 m early beside those of the other topics",
        ),
        (
            effect(CandidateKind.TERM, "v", "x", detail="x |x|"),
            "the rate of v has a further term 0.5 m times x |x|",
        ),
        (
            effect(CandidateKind.REGION, "v", "x", detail="below"),
            "the rate of v is 0.5 m higher where x is below 0.5 m",
        ),
    ],
)
def test_an_explanation_is_told_from_its_parts(tried: Effect, said: str) -> None:
    exact = FittedNumber("", METRE, 0.0, 0.5, Interval(0.5, 0.5))

    assert of_candidate(tried, (0.5, 0.5), (exact, exact)) == said


def test_only_a_delay_is_named_by_its_direction() -> None:
    late = effect(CandidateKind.DEAD_TIME, "turn", is_delay=True)

    assert label_of(late, (0.5,)) == "dead time of turn"
    assert label_of(late, (-0.5,)) == "turn logged late"
    assert label_of(replace(late, is_delay=False), (0.5,)) == "label"


@pytest.fixture(scope="module")
def failed() -> Report:
    return verify(unicycle(1.2), unicycle_drive(4, 60.0, 0.01))


def of_a_guard(name: str, *moved: str) -> Diagnosis:
    """It names a number of a guard; `moved`: the refitted numbers."""
    exact = Interval(1.6, 1.6)
    number = FittedNumber("value", METRE, 1.5, 1.6, exact)
    evidence = Evidence(20, 0.9, 30.0, ())
    found = Candidate(
        kind=CandidateKind.GUARD,
        applies_to=(name,),
        label=name,
        numbers=(number,),
        evidence=evidence,
        is_taken=True,
        alike=(),
        origin="spec.yaml:3:1",
        claim="",
        sentence="",
    )
    refitted = tuple(
        Refitted(
            kind=ParameterKind.CONTROL,
            name=each,
            unit=METRE,
            spec=1.5,
            value=1.6,
            interval=exact,
            is_moved=True,
            origin="",
            sentence="",
        )
        for each in moved
    )
    return Diagnosis(Told.SAME_STRUCTURE, (), refitted, (), (found,), ())


def test_a_number_of_a_guard_that_has_a_name_is_what_fit_edits(failed: Report) -> None:
    (first, *_) = advised(failed, of_a_guard("x1", "x1"), None).advice

    assert "the spec has to say x1 = 1.6 m (`specc fit" in first


def test_a_bare_number_of_a_guard_is_to_be_settled_by_hand(failed: Report) -> None:
    (first, *_) = advised(failed, of_a_guard("22"), None).advice

    assert first == "mend the robot, or write into the spec what explains it: 22 (1.6 m)"
