"""Sentences as people write them, on runs: compiled, judged, and told."""

from pathlib import Path

import numpy as np
import pytest

from compiler.findings import Findings
from compiler.requirement import Measured, lower_requirement
from runtime.program import Unit
from spec_schema.load import load
from spec_schema.units import parse_unit
from verifier.report.requirement_record import requirements_record, requirements_text
from verifier.report.requirement_results import Outcome, RequirementResult
from verifier.requirements.judge import judge_requirements
from verifier.requirements.signals import Signal

SPEC = Path(__file__).parents[3] / "specs/keep_left.yaml"
NUMBER, METRE = parse_unit("1").dimension, parse_unit("m").dimension
KNOWN = {
    "r.contacts": Measured(NUMBER, (), is_discrete=True),
    "r.clearance": Measured(METRE),
    "r.choose.choice": Measured(NUMBER, ("flee", "go"), is_discrete=True),
}
TIMES = np.arange(0.0, 20.05, 0.1)


def signals(touches: tuple[float, ...] = ()) -> dict[str, Signal]:
    """20 s: it nears something from 5 s on, flees from 8 to 9 s, and is away after that."""
    clearance = np.interp(TIMES, [0, 5, 8, 9, 20], [0.5, 0.5, 0.06, 0.5, 0.5])
    contacts = np.isin(np.round(TIMES, 1), touches).astype(float)
    choice = np.where((TIMES >= 7.9) & (TIMES < 9), 0.0, 1.0)
    return {
        "r.clearance": Signal("r.clearance", TIMES, clearance),
        "r.contacts": Signal("r.contacts", TIMES, contacts, is_held=True, is_discrete=True),
        "r.choose.choice": Signal(
            "r.choose.choice",
            TIMES,
            choice,
            is_held=True,
            is_discrete=True,
            labels=("flee", "go"),
        ),
    }


def told(sentence: str, run: dict[str, Signal]) -> RequirementResult:
    """What a run says of a sentence."""
    findings = Findings(load(SPEC))
    requirement = lower_requirement(sentence, ("name",), KNOWN, findings)
    assert requirement is not None, findings.diagnostics
    units = {"r.clearance": Unit("cm", 0.01)}
    return judge_requirements([requirement], run, None, units)[0]


@pytest.mark.parametrize(
    ("sentence", "outcome", "said"),
    [
        (
            "always r.clearance > 5 cm",
            Outcome.SATISFIED,
            "satisfied by 1 cm at 8 s, where r.clearance is 6 cm",
        ),
        (
            "always r.clearance > 10 cm",
            Outcome.VIOLATED,
            "violated by 4 cm at 8 s, where r.clearance is 6 cm",
        ),
        (
            "always (if r.choose.choice == 'flee' then eventually within 2 s r.clearance > 20 cm)",
            Outcome.SATISFIED,
            "satisfied",
        ),
        (
            "eventually within 7 s r.clearance > 80 cm",
            Outcome.VIOLATED,
            (
                "violated by 30 cm: r.clearance > 80 cm never came "
                "(nearest at 0 s, where r.clearance is 50 cm)"
            ),
        ),
        (
            "(eventually from 6 s to 8.5 s (r.clearance < 5 cm))",
            Outcome.VIOLATED,
            (
                "violated by 1 cm: r.clearance < 5 cm never came "
                "(nearest at 8 s, where r.clearance is 6 cm)"
            ),
        ),
        ("eventually within 60 s r.clearance > 1 m", Outcome.OPEN, "windows reach 60 s ahead"),
    ],
)
def test_a_sentence_is_told_as_it_was_asked(sentence: str, outcome: Outcome, said: str) -> None:
    found = told(sentence, signals())

    assert found.outcome == outcome
    assert said in found.sentence


@pytest.mark.parametrize(
    ("sentence", "said"),
    [
        ("always r.contacts == 0", "satisfied"),
        ("eventually r.contacts > 0", "violated: it never was so"),
        (
            "eventually r.choose.choice == 'flee'",
            "satisfied at 7.9 s, where r.choose.choice is 'flee'",
        ),
        (
            "always r.choose.choice == 'go'",
            "violated at 7.9 s, where r.choose.choice is 'flee'",
        ),
    ],
)
def test_what_is_discrete_is_told_by_name_and_without_a_number(sentence: str, said: str) -> None:
    assert told(sentence, signals()).sentence == said


@pytest.mark.parametrize(
    ("sentence", "said"),
    [
        (
            "(r.clearance > 5 cm) until within 10 s (r.choose.choice == 'flee')",
            (
                "satisfied: r.choose.choice == 'flee' came at 7.9 s, "
                "where r.choose.choice is 'flee'; until then "
                "r.clearance > 5 cm was nearest to its bound at 7.9 s, "
                "where r.clearance is 7.47 cm"
            ),
        ),
        (
            "r.clearance > 20 cm until r.choose.choice == 'flee'",
            (
                "violated: r.clearance > 20 cm no longer held at 7.05 s, "
                "where r.clearance is 20 cm, and r.choose.choice == 'flee' came only at 7.9 s"
            ),
        ),
        (
            "r.clearance > 5 cm until r.clearance > 80 cm",
            (
                "violated by 30 cm: r.clearance > 80 cm never came "
                "(nearest at 0 s, where r.clearance is 50 cm)"
            ),
        ),
        (
            "r.clearance > 20 cm until r.clearance > 80 cm",
            (
                "violated: r.clearance > 20 cm no longer held at 7.05 s, "
                "where r.clearance is 20 cm, and r.clearance > 80 cm never came "
                "(nearest at 0 s, where r.clearance is 50 cm)"
            ),
        ),
        (
            "r.contacts == 0 until r.choose.choice == 'flee'",
            (
                "violated: r.contacts == 0 no longer held at 3 s, where r.contacts is 1, "
                "and r.choose.choice == 'flee' came only at 7.9 s"
            ),
        ),
    ],
)
def test_of_until_both_sides_are_told(sentence: str, said: str) -> None:
    assert told(sentence, signals(touches=(3.0,))).sentence == said


def test_a_single_touch_is_found_and_when() -> None:
    found = told("always r.contacts == 0", signals(touches=(8.0,)))

    assert found.outcome is Outcome.VIOLATED
    assert found.witness is not None
    assert found.witness.time == pytest.approx(8.0)
    assert found.witness.values == {"r.contacts": 1.0}


def test_results_are_told_as_text_and_as_json() -> None:
    results = [told("always r.clearance > 10 cm", signals())]

    assert "violated by 4 cm" in requirements_text(results)
    record = requirements_record(results)[0]
    assert record["robustness"] == [pytest.approx(-4.0), pytest.approx(-4.0)]
    assert record["outcome"] == "violated"
