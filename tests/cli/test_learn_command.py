"""`specc learn` as a user runs it: results, files, what it refuses, and what it lists."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lcs.problems.classes import checkerboard
from lcs.problems.registry import PROBLEMS, WORLDS
from lcs.saving import load
from specc.cli import main
from specc.cli.learn import LearnerName
from specc.learning.drawing import fresh
from specc.learning.learners import ALL

QUICK = ["--cycles", "800", "--tests", "500"]


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def result(capsys: pytest.CaptureFixture[str]) -> Any:
    """What standard output holds, as JSON."""
    return json.loads(capsys.readouterr().out)


def test_without_a_folder_only_results_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["learn", "checkerboard_3x3", *QUICK]) == 0

    out = capsys.readouterr().out
    assert out.startswith("checkerboard_3x3 by alcsr: a run of 800 cycles\n")
    assert "of 500 fresh problems" in out
    assert list(Path().iterdir()) == []


def test_a_folder_holds_curves_figures_learners_and_the_summary(kept: Path) -> None:
    names = {path.relative_to(kept).as_posix() for path in kept.rglob("*") if path.is_file()}

    assert names >= {
        "experiment.json", "summary.txt", "summary.json", "learning.svg", "population.svg",
        *(
            f"seed_{seed}/{name}"
            for seed in (0, 1)
            for name in ("checkpoint.npz", "course.npz", "curve.csv", "learner.npz")
        ),
    }  # fmt: skip


def test_the_figures_of_the_summary_follow_from_the_files_beside_it(kept: Path) -> None:
    for run in json.loads((kept / "summary.json").read_text())["runs"]:
        folder = kept / f"seed_{run['seed']}"
        with (folder / "curve.csv").open() as file:
            rows = list(csv.DictReader(file))
        course = np.load(folder / "course.npz")
        is_test = course["kind"] == 0

        assert run["cycles"] == len(course["kind"]) == 1_000
        assert run["tried"] == 1_000 - len(rows) == (~is_test).sum()
        right = [int(row["right"]) for row in rows]
        assert right == (course["action"] == course["right"])[is_test].tolist()
        assert run["performance"] == np.mean(right)
        assert float(rows[-1]["performance"]) == pytest.approx(np.mean(right[-50:]))
        assert (run["rules"], run["most_rules"]) == (course["rules"][-1], course["rules"].max())
        assert run["births"] - run["deaths"] == run["rules"]
        assert len(load(folder / "learner.npz").rules()) == run["rules"]


def test_fresh_problems_where_an_action_has_no_rule_count_as_wrong(tmp_path: Path) -> None:
    board = checkerboard(3)
    asked = ["checkerboard_3x3", *QUICK, "--cycles", "150", "--runs", "2", "-o", str(tmp_path)]
    assert main(["learn", *asked]) == 0
    for run in json.loads((tmp_path / "summary.json").read_text())["runs"]:
        table = load(tmp_path / f"seed_{run['seed']}" / "learner.npz").rules()
        x, classes = fresh(board, run["seed"], 500)
        x = np.clip(x, table.low, table.high)[:, None]  # at the ends of what was learnt from
        is_end = (x == table.upper) & (table.upper == table.high)
        holds = ((table.lower <= x) & ((x < table.upper) | is_end)).all(axis=2)
        votes = holds * table.weight
        by_action = np.arange(2)[:, None] == table.action
        heard = votes @ by_action.T
        expected = (votes * table.prediction) @ by_action.T / np.where(heard > 0.0, heard, 1.0)
        is_known = (heard > 0.0).all(axis=1)

        assert 0.0 < run["uncovered"] == np.mean(~is_known)
        # Of actions that are expected to earn the same, one is taken at random.
        is_open = is_known & (np.abs(expected[:, 0] - expected[:, 1]) < 1e-6)
        is_right = is_known & ~is_open & (expected.argmax(axis=1) == classes)
        assert is_right.mean() <= run["accuracy"] <= (is_right | is_open).mean()
        assert (is_right | is_open | ~is_known).mean() > run["accuracy"]


def test_equal_seeds_give_equal_results_and_others_do_not(
    kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["learn", "checkerboard_3x3", "--cycles", "1000", "--tests", "500", "--seed", "1"]
    assert main([*asked, "--format", "json"]) == 0
    [again] = result(capsys)["runs"]
    one, other = json.loads((kept / "summary.json").read_text())["runs"]

    assert timeless(again) == timeless(other)
    assert timeless(again) != timeless(one)


def timeless(run: dict[str, Any]) -> dict[str, Any]:
    """A run's figures without those of the clock."""
    return {name: value for name, value in run.items() if name not in {"seconds", "per_second"}}


def test_constants_and_what_the_problem_is_made_with_can_be_set(
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = ["learn", "multiplexer_6", *QUICK, "--learner", "thesis", "--format", "json"]
    asked += ["--with", "thresholds=0.25,0.75", "--with", "flipped=0.1", "--explore", "0.5"]
    for setting in ("mutation_is=always", "readings.corpse_rate=shrunk", "range_is=declared"):
        asked += ["--set", setting]
    assert main(asked) == 0
    found = result(capsys)

    assert found["experiment"]["settings"] == {
        "mutation_is": "always",
        "readings.corpse_rate": "shrunk",
        "range_is": "declared",
        "explore": "0.5",
    }
    # Where an action is unknown a cycle learns, so tests are half of all at most, but for chance.
    assert 400 - 60 < found["runs"][0]["tried"] < 800


def test_a_table_is_learnt_and_tested_on_rows_it_has_not_seen(
    capsys: pytest.CaptureFixture[str],
) -> None:
    x = np.random.default_rng(0).random((200, 2))
    rows = [f"{i},{a:.3f},{b:.3f},{'go' if a > 0.5 else 'stop'}" for i, (a, b) in enumerate(x)]
    Path("rows.csv").write_text("\n".join(["t,near,far,does", *rows]) + "\n")

    assert main(["learn", "rows.csv", "--with", "without=t", *QUICK, "--format", "json"]) == 0
    [run] = result(capsys)["runs"]

    assert run["fresh"] == 50
    assert run["accuracy"] > 0.7


def test_rows_of_a_table_are_called_so_and_shown_again_and_again(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("rows.csv").write_text("near,does\n" + "0.1,go\n0.9,stop\n0.2,go\n0.7,stop\n" * 5)

    assert main(["learn", "rows.csv", *QUICK]) == 0
    out = capsys.readouterr().out
    assert "of 5 rows kept to test on" in out
    assert "showings of rows a second" in out
    assert " showings)" in out
    assert "problems" not in out
    assert " cases" not in out


def test_a_run_of_one_cycle_is_told_as_one_and_without_warnings(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["learn", "checkerboard_3x3", "--cycles", "1", "--tests", "1", "-o", "out"]) == 0
    out, err = capsys.readouterr()

    assert "a run of 1 cycle\n" in out
    assert "of 1 fresh problem;" in out
    assert "1 cycles" not in out
    assert "Warning" not in err
    assert not Path("out/seed_0/areas.svg").exists()


@pytest.mark.parametrize(
    ("asked", "code", "said"),
    [
        (["multiplxer_6"], "V401", "did you mean 'multiplexer_6'?"),
        (["nothing_like_it"], "V401", "`specc learn --list` lists them"),
        (["experiment_1", "--set", "mutat=1"], "V341", "did you mean 'mutate'?"),
        (["experiment_1", "--set", "damaged=1"], "V341", "did you mean 'damaged_"),
        (["experiment_1", "--set", "mutate=often"], "V342", "'often' is no number"),
        (["experiment_1", "--set", "mutate=nan"], "V342", "'nan' is not finite"),
        (["experiment_1", "--set", "corpses=2.5"], "V342", "'2.5' is no whole number"),
        (["experiment_1", "--set", "mutate=-1"], "V342", "-1 is negative"),
        (["experiment_1", "--set", "explore=1.5"], "V342", "explore is from 0 to 1"),
        (["experiment_1", "-l", "thesis", "--set", "sprouts=4"], "V342", "set remembers"),
        (["experiment_1", "-l", "xcsr", "--set", "theta_mna=9"], "V342", "theta_mna"),
        (["experiment_1", "--set", "order=die"], "V342", "write die_fight_breed or"),
        (["experiment_1", "--with", "flips=0.1"], "V341", "there are thresholds, flipped"),
        (["experiment_1", "--with", "flipped=2"], "V402", "write one from 0 to 1"),
        (["scitos_2", "--with", "tested=9"], "V402", "tested is 1 to 4"),
        (["puddels"], "V401", "did you mean 'puddles'?"),
        (["gridworld", "--with", "noise=2"], "V402", "write one from 0 to 0.2"),
        (["gridworld", "--with", "flipped=0.1"], "V341", "there is noise"),
        (["gridworld", "--set", "discount=2"], "V342", "discount is from 0 to 1"),
        (["gridworld", "--set", "fed=0"], "V342", "fed is 1 or more"),
        (["gridworld", "--set", "season=3"], "V341", "steps has no constant 'season'"),
        (["gridworld", "-l", "xcsr"], "V342", "write --learner steps"),
        (["experiment_1", "-l", "steps"], "V342", "write --learner alcsr or"),
    ],
)  # fmt: skip
def test_what_can_not_be_learnt_is_told_with_what_to_write(
    asked: list[str], code: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["learn", *asked, "-o", "out"]) == 2

    told = capsys.readouterr().err
    assert f"error[{code}]" in told
    assert said in told
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ([], "PROBLEM is missing"),
        (["--resume"], "name the folder"),
        (["experiment_1", "--explore", "0.5", "--set", "explore=0.4"], "leave one out"),
        (["experiment_1", "--set", "mutate"], "write mutate=VALUE (got"),
        (["experiment_1", "--cycles", "1e5"], "--cycles: write a whole number"),
        (["experiment_1", "--cycles", "0"], "--cycles: the least is 1"),
        (["experiment_1", "--explore", "2"], "--explore: the most is 1"),
        (["experiment_1", "--learner", "xcs"], "'xcs' is not one of"),
        (["nowhere.csv"], "nowhere.csv: no such file"),
    ],
)
def test_a_wrong_use_of_the_command_is_told(
    asked: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["learn", *asked]) == 2
    assert said in capsys.readouterr().err


def test_a_mistake_in_a_table_is_told_with_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    Path("rows.csv").write_text("distance,does\n1,go\nnear,stop\n2,go\n3,go\n")

    assert main(["learn", "rows.csv"]) == 2
    assert (
        "rows.csv: error[V402]: line 3: 'distance' is 'near', where most rows have a number; "
        "leave the row out, or write a finite number" in capsys.readouterr().err
    )


def test_everything_that_can_be_written_is_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["learn", "--list"]) == 0
    text = capsys.readouterr().out
    assert main(["learn", "--list", "--format", "json"]) == 0
    found = result(capsys)

    assert found["problems"].keys() == PROBLEMS.keys()
    assert found["worlds"].keys() == WORLDS.keys()
    assert found["learners"].keys() == ALL.keys() == {each.value for each in LearnerName}
    for name in (*found["problems"], *found["worlds"], *found["learners"], *found["constants"]):
        assert f"  {name} " in text
    for problem in (*found["problems"].values(), *found["worlds"].values()):
        for name in problem["with"]:
            assert f"  {name} " in text
