"""`specc check --claims` as a user runs it: exit statuses, records, annotations."""

import json
from pathlib import Path
from typing import Any

import pytest

from specc.cli import main
from verifier.topology.claims import judge
from verifier.topology.claims.findings import Finding

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
    printed = json.loads(capsys.readouterr().out)
    holds, fails = printed["claims"]

    assert printed["mistakes"] == []

    assert (holds["ruling"], holds["proved_share"], holds["witness"]) == ("proved", 1.0, None)
    assert fails["ruling"] == "refuted"
    assert fails["witness"]["settings"] == {"pull": 0.5}
    assert fails["origin"].endswith("fold.yaml:16:5")


def test_compile_says_that_claims_are_not_checked(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compile", written(HOLDS, FAILS)]) == 0
    assert "2 claims not checked: run `specc check --claims fold.yaml`" in capsys.readouterr().out


def test_a_mistake_is_told_from_a_claim_in_a_record(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--claims", written(WRONG), "--format", "json"]) == 2
    printed = json.loads(capsys.readouterr().out)

    assert printed["claims"] == []
    assert [one["code"] for one in printed["mistakes"]] == ["S271"]


@pytest.mark.parametrize("command", [["compile"], ["portrait"], ["compare", "fold.yaml"]])
@pytest.mark.parametrize("form", [["--format", "json"], ["--format=json"], ["-f", "json"]])
def test_programs_get_a_specs_mistakes_as_records(
    command: list[str], form: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*command, written(WRONG), *form]) == 2
    out, err = capsys.readouterr()

    assert [one["code"] for one in json.loads(out)] == ["S271"]
    assert not err


def test_each_claim_is_printed_with_its_conditions_as_soon_as_it_is_decided(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    spec = written(
        "  - one stable node: {at: {x: sqrt(pull/b)}, within: 2 %, over: [pull]}\n", FAILS, HOLDS
    )

    def impatient(*_arguments: Any) -> Finding:
        raise KeyboardInterrupt

    monkeypatch.setattr(judge, "_judged_at", impatient)

    assert main(["check", "--claims", spec]) == 130
    out, err = capsys.readouterr()
    assert "one stable node at x = sqrt(pull/b) (within 2 %), over pull from -1 m/s to 1" in out
    assert err.splitlines() == ["1 claim: 1 refuted", "interrupted; 2 claims were not judged"]


def test_the_example_of_a_claim_over_controls_says_where_it_is(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["check", "--claims", written(HOLDS)]) == 0
    assert "\n  at the defaults: 1 stable node at x = 0.70711 m\n" in capsys.readouterr().out


def test_a_claim_that_holds_on_an_interval_names_both_its_ends(
    capsys: pytest.CaptureFixture[str],
) -> None:
    claim = "  - one stable node: {at: {x: 0.5}, within: {x: 1 dm}, over: [pull]}\n"

    assert main(["check", "--claims", written(claim)]) == 1
    [line] = [line for line in capsys.readouterr().out.splitlines() if "holds for" in line]
    assert line.startswith("  holds for pull from 0.16 m/s to 0.36 m/s (± ")  # 0.4² to 0.6²
    assert "; below 0.16 m/s: expected exactly 1" in line
    assert "; above 0.36 m/s: expected exactly 1" in line


TWO_MODES = """
specc: 1
kind: behavior
name: two
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: line}}
  side: {kind: discrete, values: [l, r], role: both, relates: {agent: base, environment: line}}
control:
  edge: {unit: m, domain: [0.1, 0.5], default: 0.2}
constants:
  k: {value: 1, unit: 1/s}
  a: {value: 1, unit: m}
field:
  modes:
    of: side
    each:
      l: {formula: {x: -k*(x - a)}, leave: [{when: x >= edge, to: r}]}
      r: {formula: {x: -k*(x - 0.5*a)}, leave: [{when: x <= -edge, to: l}]}
table: {keep: code}
expect:
  - one stable node: {at: {x: 0.5}, over: [edge]}
  - no saddle
  - exactly two fixed points
"""


def test_fixed_points_of_modes_are_proved_where_the_mode_is_not_left(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("two.yaml").write_text(TWO_MODES, encoding="utf-8")

    assert main(["check", "--claims", "two.yaml", "--format", "json"]) == 1
    node, saddle, two = json.loads(capsys.readouterr().out)["claims"]

    # The zero of `l`, at x = 1, lies beyond its guard.
    assert (node["ruling"], saddle["ruling"], two["ruling"]) == ("proved", "proved", "refuted")
    assert "of each mode" in node["how"]
