"""`specc fit` as a user runs it: what it prints, what it writes, how it ends."""

import json
from pathlib import Path

import pytest

from specc.cli import main
from tests.specc.fit_scenes import TOLD, patrol, patrolled


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    patrol(Path(), TOLD)


def test_an_edit_is_shown_and_nothing_is_written(capsys: pytest.CaptureFixture[str]) -> None:
    patrolled(Path("run.csv"), 0.46)
    before = Path("patrol.yaml").read_bytes()

    assert main(["fit", "run.csv", "--spec", "patrol.yaml"]) == 0

    out = capsys.readouterr().out
    assert "run.csv  FAIL  -> PASS" in out
    lines = out.splitlines()
    assert [line for line in lines if line.startswith(("-", "+"))] == [
        "--- patrol.yaml",
        "+++ patrol.yaml",
        "-  v1: {constant: 0.5}  # as commanded",
        "+  v1: {constant: 0.46}  # as commanded",
    ]
    assert Path("patrol.yaml").read_bytes() == before


def test_with_write_the_file_is_edited(capsys: pytest.CaptureFixture[str]) -> None:
    patrolled(Path("run.csv"), 0.46)
    before = Path("patrol.yaml").read_text()

    assert main(["fit", "run.csv", "--spec", "patrol.yaml", "--write", "--format", "json"]) == 0

    record = json.loads(capsys.readouterr().out)
    after = before.replace("v1: {constant: 0.5}", "v1: {constant: 0.46}")
    assert Path("patrol.yaml").read_text() == after
    assert (record["outcome"], record["written"]) == ("moved", True)
    [move] = record["moves"]
    assert (move["path"], move["old"], move["new"]) == ("$.trace.v1.constant", "0.5", "0.46")
    assert [run["verdict"] for run in record["after"]] == ["pass"]
    assert record["diff"].count("\n+  v1: {constant: 0.46}") == 1


def test_a_faithful_robot_ends_with_0_and_a_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    patrolled(Path("run.csv"), 0.5, 30.0)

    assert main(["fit", "run.csv", "--spec", "patrol.yaml", "--write"]) == 0

    assert capsys.readouterr().out.startswith("nothing is to be moved")


def test_a_missing_log_is_told_as_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fit", "nowhere.csv", "--spec", "patrol.yaml"]) == 2
    assert "V301" in capsys.readouterr().err
