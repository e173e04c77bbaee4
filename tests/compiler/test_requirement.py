"""Requirements in code: margins in SI, names, dimensions, the unit that they are shown in."""

from collections.abc import Callable

import numpy as np
import pytest

from compiler.findings import Findings
from compiler.requirement import Measured, lower_requirement
from runtime.requirement import Operator, Requirement
from spec_schema.load import load_source
from spec_schema.source import Source
from spec_schema.units import parse_unit
from verifier.report.requirement_results import Outcome
from verifier.requirements.judge import judge_requirements
from verifier.requirements.signals import Signal

KNOWN = {
    "r.clearance": Measured(parse_unit("m").dimension),
    "r.x": Measured(parse_unit("m").dimension),
    "r.light": Measured(parse_unit("lx").dimension),
    "r.choose.choice": Measured(parse_unit("1").dimension, ("flee", "go"), is_discrete=True),
    "r.bumper.hit": Measured(parse_unit("1").dimension, is_discrete=True),
}


@pytest.fixture
def lowered() -> Callable[[str], tuple[Requirement | None, list[str]]]:
    def run(text: str) -> tuple[Requirement | None, list[str]]:
        source = (
            "specc: 1\nkind: scenario\nname: tried\nworld: w.yaml\n"
            f'robots: {{r: {{architecture: a.yaml}}}}\nduration: 1 s\nrequire: ["{text}"]\n'
        )
        findings = Findings(load_source(Source("spec.yaml", source)))
        found = lower_requirement(text, ("require", 0), KNOWN, findings)
        return found, [one.code for one in findings.diagnostics]

    return run


@pytest.mark.parametrize(
    ("text", "code", "unit"),
    [
        ("r.clearance > 5 cm", "r.clearance 0.05 sub 2e-09 sub", "cm"),
        ("r.clearance < r.x", "r.x r.clearance sub 2e-09 sub", "m"),
        ("r.light <= 2 lx", "2 r.light sub 2e-09 add", "lx"),
        ("r.choose.choice == 'go'", "r.choose.choice 1 eq 1 -1 where", "1"),
        ("r.bumper.hit != 1", "r.bumper.hit 1 ne 1 -1 where", "1"),
    ],
)
def test_a_margin_is_in_si_and_positive_where_it_holds(
    lowered: Callable[[str], tuple[Requirement | None, list[str]]], text: str, code: str, unit: str
) -> None:
    found, codes = lowered(text)

    assert not codes
    assert found is not None
    assert found.formula[0].margin is not None
    assert found.formula[0].margin.text == code
    assert found.unit == unit


@pytest.mark.parametrize(
    ("text", "outcome"),
    [
        ("always r.clearance > 5 cm", Outcome.VIOLATED),
        ("always r.clearance >= 5 cm", Outcome.SATISFIED),
        ("always 5 cm < r.clearance", Outcome.VIOLATED),
        ("always r.clearance <= 5 cm", Outcome.SATISFIED),
        ("eventually not r.clearance > 5 cm", Outcome.SATISFIED),
        ("always not r.clearance >= 5 cm", Outcome.VIOLATED),
        ("always not (not r.clearance >= 5 cm)", Outcome.SATISFIED),
        ("always not (r.clearance >= 5 cm and r.clearance < 1 m)", Outcome.VIOLATED),
        ("always (if r.clearance >= 5 cm then r.clearance > 1 m)", Outcome.VIOLATED),
        ("always (if r.clearance > 5 cm then r.clearance > 1 m)", Outcome.SATISFIED),
    ],
)
def test_what_is_at_its_bound_is_not_beyond_it(
    lowered: Callable[[str], tuple[Requirement | None, list[str]]], text: str, outcome: Outcome
) -> None:
    found, _ = lowered(text)
    assert found is not None
    touching = Signal("r.clearance", np.array([0.0, 1.0, 2.0]), np.array([0.05, 0.05, 0.05]))

    (judged,) = judge_requirements([found], {"r.clearance": touching})

    assert judged.outcome is outcome
    assert judged.robustness == 0.0
    assert "exactly at its bound" in judged.sentence


def test_parts_stand_before_what_joins_them(
    lowered: Callable[[str], tuple[Requirement | None, list[str]]],
) -> None:
    found, _ = lowered("if r.x > 1 m then r.light > 1 lx until within 3 s not r.clearance < 2 m")

    assert found is not None
    predicate = Operator.PREDICATE
    assert [part.operator for part in found.formula] == [
        *(predicate, predicate, predicate, Operator.NOT, Operator.UNTIL, Operator.IMPLIES)
    ]
    assert found.formula[4].last == pytest.approx(3.0)
    assert found.unit == ""
    assert set(found.quantities) == {"r.x", "r.light", "r.clearance"}


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("r.clearence > 5 cm", ["S371"]),
        ("clearance > 5 cm", ["S371"]),
        ("r.clearance > 5 lx", ["S141"]),
        ("r.clearance > 5", ["S141"]),
        ("r.clearance == 5 cm", ["S374"]),
        ("r.choose.choice == 'run'", ["S138"]),
        ("r.clearence > 5 cm and r.lihgt > 2 m", ["S371", "S371"]),
    ],
)
def test_every_mistake_is_told(
    lowered: Callable[[str], tuple[Requirement | None, list[str]]], text: str, wrong: list[str]
) -> None:
    found, codes = lowered(text)

    assert found is None
    assert codes == wrong
