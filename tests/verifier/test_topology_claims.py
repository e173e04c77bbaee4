"""The judge against closed forms: what holds is proved, what fails has a witness and a boundary."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.claim import Claim, Reach, Span
from runtime.code import Code
from runtime.program import Program
from tests.verifier.claim_scenes import CROSS, FOLD, FORK, MU, ONSET, X, Y, all_of, at, claim
from tests.verifier.topology_scenes import behavior, control, linear, state, tabulated, van_der_pol
from verifier.topology.branches.continuation import Change
from verifier.topology.claims.findings import Finding, Ruling
from verifier.topology.claims.judge import judge

SHARE = 1e-3
"""How closely a boundary must be located, as a share of the control's domain."""


def judged(program: Program, one: Claim) -> Finding:
    [finding] = judge(program, (one,))
    return finding


@pytest.mark.parametrize(
    ("program", "feature", "boundary", "change"),
    [
        (FOLD, "stable node", 0.2, Change.SADDLE_NODE),
        (FORK, "unstable node", -0.1, Change.PITCHFORK),
        (ONSET, "unstable focus", -0.15, Change.HOPF),
    ],
    ids=["saddle-node", "pitchfork", "Hopf"],
)
def test_a_boundary_is_located_and_named(
    program: Program, feature: str, boundary: float, change: Change
) -> None:
    found = judged(program, claim(feature, over=all_of(program)))

    assert found.ruling is Ruling.REFUTED
    assert found.witness is not None
    [(_, mu)] = found.witness.settings
    assert mu < boundary
    [where] = found.boundaries
    assert abs(where.value - boundary) <= max(where.within, 1e-6) <= SHARE * 2.0
    assert where.above
    assert where.change is change


def test_a_claim_that_holds_all_over_is_proved() -> None:
    span = (Span("mu", 0.21, 1.0),)
    place = at("x", "mu 0.2 sub sqrt", 0.02)

    found = judged(FOLD, claim("stable node", places=(place,), over=span))

    assert found.ruling is Ruling.HOLDS_PROVED
    assert found.proved_share == 1.0


def test_a_place_that_moves_with_two_controls_is_proved() -> None:
    # x' = a - b x: a node at a/b.
    program = behavior(
        "ratio",
        (X,),
        ("a b x mul sub",),
        (control("a", -1.0, 1.0, 0.5), control("b", 1.0, 2.0, 1.5)),
    )
    spans = (*all_of(program, "a"), *all_of(program, "b"))

    right = judged(program, claim("node", places=(at("x", "a b div", 0.01),), over=spans))
    wrong = judged(program, claim("node", places=(at("x", "a 2 div", 0.1),), over=spans))

    assert right.ruling is Ruling.HOLDS_PROVED
    assert wrong.ruling is Ruling.REFUTED


@given(st.tuples(*(st.integers(-300, 300) for _ in range(4))))
@settings(max_examples=5, deadline=None)
def test_what_is_proved_of_a_linear_field_is_so(hundredths: tuple[int, int, int, int]) -> None:
    a, b, c, d = (entry / 100.0 for entry in hundredths)
    values = np.linalg.eigvals([[a, b], [c, d]])
    features = {
        "saddle": values.real.min() < 0.0 < values.real.max(),
        "stable focus": bool(values.real.max() < 0.0 and abs(values.imag).max() > 0.0),
        "unstable node": bool(values.real.min() > 0.0 and abs(values.imag).max() == 0.0),
    }

    for finding in judge(linear(a, b, c, d), tuple(claim(name) for name in features)):
        if finding.ruling is Ruling.HOLDS_PROVED:
            assert features[finding.claim.feature]
        if finding.ruling is Ruling.REFUTED:
            assert not features[finding.claim.feature]


def test_a_failure_between_samples_is_found_by_the_proof() -> None:
    # x' = (mu - 0.508)² - 1e-6 - x² has no fixed point for |mu - 0.508| < 0.001, and the samples
    # are 1/16 apart: 0.508 lies between them.
    narrow = "mu 0.508 sub mu 0.508 sub mul 1e-6 sub x x mul sub"
    program = behavior("gap", (X,), (narrow,), (MU,))

    found = judged(program, claim("fixed point", 2, 2, over=(Span("mu", 0.4, 0.6),)))

    assert found.ruling is Ruling.REFUTED
    assert found.witness is not None
    assert abs(found.witness.settings[0][1] - 0.508) < 1e-3


def test_a_claim_fails_where_its_cycle_is_born() -> None:
    found = judged(ONSET, claim("stable cycle", over=(Span("mu", -0.6, 0.4),)))

    assert found.ruling is Ruling.REFUTED
    [where] = found.boundaries
    assert where.change is Change.HOPF
    assert where.value == pytest.approx(-0.15, abs=SHARE * 2.0)
    assert where.above


def test_two_intervals_in_which_a_claim_holds_have_their_boundaries() -> None:
    # x' = (mu² - 0.25) - x² has fixed points for |mu| > 1/2.
    program = behavior("twice", (X,), ("mu mu mul 0.25 sub x x mul sub",), (MU,))

    found = judged(program, claim("fixed point", 2, 2, over=all_of(program)))

    assert [b.value for b in found.boundaries] == pytest.approx([-0.5, 0.5], abs=1e-5)
    assert [b.above for b in found.boundaries] == [False, True]


def test_exchange_of_stability_is_no_change_of_numbers() -> None:
    found = judged(CROSS, claim("fixed point", 2, 2, over=(Span("mu", -0.9, 0.25),)))

    assert found.ruling is Ruling.HOLDS_PROVED


@pytest.mark.parametrize("mu", [-0.05, 0.3, 0.9])
def test_reach_and_period_of_a_cycle_decide(mu: float) -> None:
    radius = "mu 0.15 add sqrt"
    right = claim(
        "stable cycle",
        settings=(("mu", mu),),
        period=Code(f"{2.0 * math.pi!r}"),
        reaches=(Reach("x", Code(f"{radius} neg"), Code(radius), 0.01),),
    )
    late = replace(right, period=Code("7"))
    wide = replace(right, reaches=(Reach("x", Code("-2"), Code("2"), 0.01),))

    rulings = [finding.ruling for finding in judge(ONSET, (right, late, wide))]

    assert rulings == [Ruling.HOLDS_SAMPLED, Ruling.REFUTED, Ruling.REFUTED]


def test_other_leaves_out_what_is_named_above() -> None:
    # Two wells and a saddle between them.
    program = behavior("wells", (X, Y), ("y", "x x x x mul mul sub y 0.5 mul sub"), ())
    right = claim("stable focus", places=(at("x", "1", 0.01),))
    rest = claim("attractor", 0, 0, other=True)
    left = claim("stable focus", other=True)
    saddle = claim("fixed point", other=True)

    rulings = [f.ruling for f in judge(program, (right, rest, left, saddle))]

    assert rulings == [
        Ruling.HOLDS_PROVED,
        Ruling.REFUTED,
        Ruling.HOLDS_PROVED,
        Ruling.HOLDS_PROVED,
    ]


def test_a_share_of_the_domain_goes_where_it_goes() -> None:
    # x' = x - x³: to 1 from the right half of [-2, 2].
    program = behavior("halves", (X,), ("x x x x mul mul sub",), ())
    right = claim("stable node", places=(at("x", "1", 0.01),), called="right")
    half = claim("basin", 0, None, share=0.49, goes_to="right")
    more = claim("basin", 0, None, share=0.52, goes_to="right")

    rulings = [finding.ruling for finding in judge(program, (right, half, more))]

    assert rulings == [Ruling.HOLDS_PROVED, Ruling.HOLDS_SAMPLED, Ruling.REFUTED]


def test_a_bifurcation_itself_is_undecided() -> None:
    [found] = judge(FOLD, (claim("stable node", settings=(("mu", 0.2),)),))

    assert found.ruling is Ruling.UNDECIDED
    assert found.witness is not None


def test_the_proof_of_tables_speaks_of_tables() -> None:
    found = judged(tabulated(van_der_pol(), 33, 1e-6), claim("unstable focus"))

    assert found.ruling is Ruling.HOLDS_PROVED
    assert "the tables" in found.how


def test_more_states_than_can_be_seen_are_undecided() -> None:
    states = tuple(state(name, -1.0, 1.0) for name in "abcdef")
    program = behavior("many", states, tuple(f"{name} neg" for name in "abcdef"))

    assert judged(program, claim("stable node")).ruling is Ruling.UNDECIDED
