"""`specc check --claims` as a user runs it: exit statuses, records, annotations."""

import json
from pathlib import Path

import pytest

from specc.cli import main

FOLD = """
specc: 1
kind: behavior
name: fold
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: mark}}
control:
  pull: {unit: m/s, domain: [-1, 1], default: 0.5}
constants:
  b: {value: 1, unit: 1/m/s}
field:
  formula: {x: pull - b*x**2}
table: {keep: code}
expect:
"""
HOLDS = "  - one stable node: {over: {pull: [0.25, 1]}}\n"
FAILS = "  - exactly two saddles\n"
OPEN = "  - one stable node: {where: {pull: 0}}\n"
WRONG = "  - one stable knot\n"


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def written(*claims: str) -> str:
    Path("fold.yaml").write_text(FOLD + "".join(claims), encoding="utf-8")
    return "fold.yaml"


@pytest.mark.parametrize(
    ("claims", "status"),
    [
        ((HOLDS,), 0),
        ((HOLDS, FAILS), 1),
        ((FAILS, OPEN), 1),
        ((HOLDS, OPEN), 4),
        ((HOLDS, WRONG), 2),
    ],
    ids=["holds", "refuted", "refuted and open", "open", "no claim"],
)
def test_the_exit_status_is_that_of_the_worst_claim(claims: tuple[str, ...], status: int) -> None:
    assert main(["check", "--claims", written(*claims)]) == status


def test_a_spec_without_claims_has_nothing_to_check(capsys: pytest.CaptureFixture[str]) -> None:
    Path("fold.yaml").write_text(FOLD.removesuffix("expect:\n"), encoding="utf-8")

    assert main(["check", "--claims", "fold.yaml"]) == 0
    assert "0 claims: nothing to check" in capsys.readouterr().err


def test_what_does_not_hold_is_annotated_at_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    spec = written(HOLDS, FAILS, OPEN)

    assert main(["check", "--claims", spec, "--format", "github"]) == 1
    refuted, undecided = capsys.readouterr().out.strip().splitlines()
    last = len(Path(spec).read_text(encoding="utf-8").splitlines())

    assert refuted.startswith(f"::error file=fold.yaml,line={last - 1},col=5,title=refuted::")
    assert undecided.startswith(f"::warning file=fold.yaml,line={last},col=5,title=undecided::")
    assert "witness: pull = 0.5 m/s" in refuted
    assert "%0A" in refuted


def test_records_name_claim_ruling_and_witness(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--claims", written(HOLDS, FAILS), "--format", "json"]) == 1
    holds, fails = json.loads(capsys.readouterr().out)

    assert (holds["ruling"], holds["proved_share"], holds["witness"]) == ("proved", 1.0, None)
    assert fails["ruling"] == "refuted"
    assert fails["witness"]["settings"] == {"pull": 0.5}
    assert fails["origin"].endswith("fold.yaml:16:5")


def test_compile_says_that_claims_are_not_checked(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compile", written(HOLDS, FAILS)]) == 0
    assert "2 claims not checked: run `specc check --claims fold.yaml`" in capsys.readouterr().out
