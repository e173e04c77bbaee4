"""Claims in the program's terms: SI, controls and constants, and what is checked on the way."""

import pytest

from compiler.check import check_behavior
from runtime.claim import Claim
from spec_schema import claim_sentences
from spec_schema.behavior import BehaviorSpec
from spec_schema.load import load_source
from spec_schema.source import Source
from verifier.topology.claims.members import CYCLES, POINTS

BEGINNING = """specc: 1
kind: behavior
name: claims
state:
  x: {unit: cm, domain: [-200, 200], role: both, relates: {agent: base, environment: mark}}
  v: {unit: m/s, domain: [-2, 2], role: both, relates: {agent: base, environment: mark}}
  gear: {kind: discrete, values: [low, high], role: sensed, relates: {agent: a, environment: b}}
control:
  goal: {unit: cm, domain: [-100, 100], default: 50}
constants:
  k: {value: 2, unit: 1/s}
  far: {value: 1, unit: m}
field:
  formula: {x: v, v: -k*k*(x - goal) - k*v}
expect:
"""


def lowered(text: str) -> tuple[tuple[Claim, ...], list[str]]:
    loaded = load_source(Source("claims.yaml", BEGINNING + text))
    assert isinstance(loaded.spec, BehaviorSpec)
    checked = check_behavior(loaded, loaded.spec)
    return checked.claims, [found.code for found in checked.findings.diagnostics]


def test_values_are_in_si() -> None:
    text = (
        "  - one stable focus: {at: {x: 30, v: -0.5}, within: {x: 5 mm, v: 10 %}, "
        "where: {gear: high}, over: {goal: [-50, 50 cm]}, called: home}\n"
    )

    [claim], codes = lowered(text)

    assert codes == ["S223"]  # no claim reads `far` here, nothing else does
    places = {place.state: place for place in claim.places}
    assert float(places["x"].at.text) == pytest.approx(0.3)
    assert float(places["v"].at.text) == -0.5
    assert (places["x"].within, places["v"].within) == pytest.approx((0.005, 0.4))
    [span] = claim.over
    assert (span.control, span.low, span.high) == ("goal", -0.5, 0.5)
    assert claim.settings == (("gear", 1.0),)
    assert (claim.called, claim.origin) == ("home", "claims.yaml:16:5")


def test_expressions_of_controls_and_constants_become_code() -> None:
    [claim], codes = lowered("  - one stable cycle: {period: 2*pi/k, reaches: {x: [-far, goal]}}\n")

    assert not codes
    assert claim.period is not None
    assert claim.period.tokens[-2:] == ("k", "div")
    [reach] = claim.reaches
    assert (reach.low.text, reach.high.text) == ("far neg", "goal")
    assert (reach.within, claim.period_within) == (pytest.approx(0.04), 0.01)


@pytest.mark.parametrize(
    ("claim", "code"),
    [
        ("one stable focus: {at: {x: k}}", "S211"),
        ("one stable focus: {at: {x: 3 s}}", "S125"),
        ("one stable focus: {at: {x: 300}}", "S275"),
        ("one stable focus: {at: {gear: 0}}", "S275"),
        ("one stable focus: {at: {x: 0}, where: {x: 0}}", "S275"),
        ("one stable focus: {where: {gear: middle}}", "S275"),
        ("one stable focus: {where: {goal: 1}, over: [goal]}", "S273"),
        ("one stable focus: {at: {x: 0}, within: 0 %}", "S277"),
        ("one stable focus: {at: {x: 0}, within: {v: 1 %}}", "S277"),
        ("one stable focus: {at: {x: 0}, within: {x: -1 cm}}", "S277"),
        ("one stable cycle: {at: {x: 0}}", "S273"),
        ("one stable cycle: {period: x/v}", "S276"),
        ("one stable cycle: {period: goal}", "S211"),
        ("one attractor: {at: {x: '('}}", "S133"),
    ],
)
def test_a_condition_that_is_wrong_is_told(claim: str, code: str) -> None:
    _, codes = lowered(f"  - {claim}\n")

    assert code in codes


def test_names_of_claims_are_told_apart() -> None:
    _, twice = lowered("  - one focus: {called: a}\n  - one saddle: {called: a}\n")
    _, repels = lowered("  - one saddle\n  - at least 9 % of the domain goes to it\n")

    assert "S274" in twice
    assert "S274" in repels


def test_the_judge_knows_every_feature_of_the_language() -> None:
    assert {*POINTS, *CYCLES} == {*claim_sentences.FEATURES}
    assert {*CYCLES} - {*POINTS} == claim_sentences.CYCLES
