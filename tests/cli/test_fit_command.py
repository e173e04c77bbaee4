"""`specc fit` as a user runs it: what it prints, what it writes, how it ends."""

import json
from pathlib import Path

import pytest

from specc.cli import main
from tests.specc.fit_scenes import MOVER, TOLD, late_mover, patrol, patrolled


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


def test_a_guard_that_is_off_moves_the_number_in_it(capsys: pytest.CaptureFixture[str]) -> None:
    patrolled(Path("run.csv"), 0.5, 80.0, far=1.6)

    assert main(["fit", "run.csv", "--spec", "patrol.yaml"]) == 0

    out = capsys.readouterr().out
    assert "run.csv  FAIL  -> PASS" in out
    assert "(spec 1.5), as" in out
    [old, new] = [line for line in out.splitlines() if line.startswith(("-  ", "+  "))]
    assert old == "-  x1: {constant: 1.5}"
    assert float(new.removeprefix("+  x1: {constant: ").removesuffix("}")) == pytest.approx(
        1.6, abs=0.01
    )


def test_a_fail_that_no_number_mends_ends_with_1(capsys: pytest.CaptureFixture[str]) -> None:
    """Its speed turns round at once, where the spec lets it go on: that is no number."""
    patrolled(Path("run.csv"), 0.5, 80.0, bounces=True)
    before = Path("patrol.yaml").read_bytes()

    assert main(["fit", "run.csv", "--spec", "patrol.yaml", "--write"]) == 1

    out = capsys.readouterr().out
    assert out.startswith("nothing is edited: no number of the spec mends it")
    assert "run.csv: after going from" in out
    assert Path("patrol.yaml").read_bytes() == before


def test_anyway_writes_what_explains_as_well(capsys: pytest.CaptureFixture[str]) -> None:
    """A robot of one input: the log of its state is late, or it acts late."""
    late_mover(Path("run.csv"), 0.3)
    Path("mover.yaml").write_text(MOVER)

    assert main(["fit", "run.csv", "--spec", "mover.yaml", "--write"]) == 4
    out = capsys.readouterr().out
    assert "or the log tells x 0.3" in out
    assert Path("mover.yaml").read_text() == MOVER

    assert main(["fit", "run.csv", "--spec", "mover.yaml", "--write", "--anyway"]) == 0
    assert "run.csv  FAIL  -> PASS" in capsys.readouterr().out
    text = Path("mover.yaml").read_text()
    [line] = set(text.splitlines()) - set(MOVER.splitlines())
    assert line.startswith("  x: {path: x, delay: 0.")
    assert len(text.splitlines()) == len(MOVER.splitlines())
