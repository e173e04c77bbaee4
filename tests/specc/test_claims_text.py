"""Claims refuted on purpose, each with its witness: transcripts in tests/golden/refuted."""

from collections.abc import Callable
from pathlib import Path

import pytest

from specc.claiming import check_claims
from specc.loading import load_program
from specc.texts.claims import finding_record, finding_text, totals_text
from verifier.topology.claims.findings import Ruling

FOLDER = Path(__file__).parents[1] / "golden" / "refuted"
SPECS = sorted(FOLDER.glob("*.yaml"))


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_a_refuted_claim_shows_its_witness(
    path: Path, expect: Callable[[Path, str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(FOLDER)
    program = load_program(path.name)

    findings = check_claims(program)

    refuted = [finding for finding in findings if finding.ruling is Ruling.REFUTED]
    assert len(refuted) == 1
    assert refuted[0].witness is not None
    assert len(refuted[0].witness.settings) == len(program.controls)
    text = [*(finding_text(program, finding) for finding in findings), totals_text(findings)]
    expect(path.with_suffix(".expected"), "\n".join(text) + "\n")


def test_records_are_in_the_users_units() -> None:
    program = load_program(FOLDER / "a_bifurcation.yaml")
    [finding] = check_claims(program)

    record = finding_record(program, finding)

    assert record["ruling"] == "refuted"
    [boundary] = record["boundaries"]
    assert boundary["value"] == pytest.approx(0.3, abs=1e-3 * 2.0)  # of the control's domain
    assert (boundary["holds"], boundary["change"]) == ("above", "saddle-node")
