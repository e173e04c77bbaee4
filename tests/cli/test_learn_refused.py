"""What `specc learn` refuses, so that no file of a user's is lost and no figure misleads."""

import json
from pathlib import Path

import pytest

from specc.cli import main
from specc.learning.experiment import Experiment
from specc.learning.folder import NAMES, begin_in

BOARD = ["learn", "checkerboard_3x3", "--cycles", "300", "--tests", "50"]
ROWS = "near,far,does\n" + "0.1,0.2,go\n0.9,0.3,stop\n0.2,0.8,go\n0.7,0.9,stop\n" * 8


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("name", [*NAMES, "seed_0/rules.txt", "seed_0/checkpoint.npz"])
def test_a_file_that_an_experiment_would_write_over_is_left_alone(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    own = Path("out") / name
    own.parent.mkdir(parents=True)
    own.write_text("mine")

    assert main([*BOARD, "-o", "out"]) == 2
    told = capsys.readouterr().err
    assert f"out/{name.partition('/')[0]}: error[V405]" in told
    assert own.read_text() == "mine"
    assert [path for path in Path("out").rglob("*") if path.is_file()] == [own]


def test_a_folder_with_other_files_can_be_begun_in() -> None:
    Path("out").mkdir()
    Path("out/notes.txt").write_text("mine")

    begin_in(Path("out"), Experiment("checkerboard_3x3", {}, "alcsr", {}, 300, (0,), 50))

    assert Path("out/experiment.json").exists()


@pytest.mark.parametrize("asked", [BOARD, ["learn", "--resume"]])
def test_a_file_in_the_place_of_the_folder_is_told(
    asked: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("out").write_text("mine")

    assert main([*asked, "-o", "out"]) == 2
    assert "out: error[V405]: this is a file, no folder" in capsys.readouterr().err
    assert Path("out").read_text() == "mine"


def test_a_folder_in_the_place_of_the_problem_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    Path("tables.csv").mkdir()

    for name in ("tables.csv", "."):
        assert main(["learn", name]) == 2
        assert f"{name}: error[V401]: this is a folder" in capsys.readouterr().err


def test_an_experiment_goes_on_with_its_table_and_with_no_other(
    capsys: pytest.CaptureFixture[str],
) -> None:
    table = Path("rows.csv")
    table.write_text(ROWS)
    assert main(["learn", "rows.csv", "--cycles", "200", "-o", "out"]) == 0
    summary = json.loads(Path("out/summary.json").read_text())
    assert summary["experiment"] == json.loads(Path("out/experiment.json").read_text())
    table.write_text(ROWS.replace("0.9", "0.8"))
    before = Path("out/experiment.json").read_bytes()
    capsys.readouterr()

    assert main(["learn", "--resume", "--cycles", "300", "-o", "out"]) == 2
    assert "rows.csv: error[V406]: the table has changed" in capsys.readouterr().err
    assert Path("out/experiment.json").read_bytes() == before

    table.write_text(ROWS)
    assert main(["learn", "--resume", "--cycles", "300", "-o", "out"]) == 0


def test_the_class_of_a_table_can_not_be_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    Path("rows.csv").write_text(ROWS)

    assert main(["learn", "rows.csv", "--with", "target=does", "--with", "without=does"]) == 2
    assert "'does' is the class (target), so it can't be left out" in capsys.readouterr().err


def test_a_declared_range_that_a_column_has_not_is_told_with_its_name(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("rows.csv").write_text(
        ROWS.replace("far", "far,always").replace(",go", ",1,go").replace(",stop", ",1,stop")
    )

    asked = ["learn", "rows.csv", "--cycles", "200"]
    assert main(asked) == 0
    assert main([*asked, "--set", "range_is=declared"]) == 2
    told = capsys.readouterr().err
    assert "range_is=declared: error[V342]: 'always' has no range: it is 1 in all rows" in told
