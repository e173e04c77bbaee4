"""`specc learn` in worlds of several steps: results, files, and that stopping changes nothing."""

import csv
import json
import os
import shutil
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lcs.problems.optimum import fewest_steps
from lcs.problems.steps import gridworld
from lcs.saving import as_bytes, load
from specc.cli import main
from specc.learning.drawing import followed, starts
from specc.learning.experiment import Experiment, config_of, problem_of
from specc.learning.learning import AnyRun, learnt_from
from specc.learning.resuming import taken_up
from specc.learning.teaching_worlds import WorldTeacher

SETTINGS = {"first": "500", "memories": "900", "families": "2", "generations": "2"}


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def result(capsys: pytest.CaptureFixture[str]) -> Any:
    """What standard output holds, as JSON."""
    return json.loads(capsys.readouterr().out)


def test_the_figures_of_the_summary_follow_from_the_files_beside_it(walked: Path) -> None:
    record = json.loads((walked / "summary.json").read_text())
    for run in record["runs"]:
        folder = walked / f"seed_{run['seed']}"
        with (folder / "curve.csv").open() as file:
            rows = list(csv.DictReader(file))
        learner = load(folder / "learner.npz")
        begun = starts(gridworld(), run["seed"], 50)
        went = learner.follow(gridworld(), begun, followed(run["seed"]))

        assert run["episodes"] == len(rows) == 60
        assert run["steps"] == went.steps.mean() == pytest.approx(float(rows[-1]["best_steps"]))
        assert run["returns"] == pytest.approx(went.returns.mean())
        assert run["reached"] == went.reached.mean()
        assert run["optimal_steps"] == fewest_steps(begun).mean()
        assert run["tried"] == learner.land.seen[0]
        assert run["boxes"] == len(learner.bodies.lower) == int(rows[-1]["boxes"])
        first = next(i for i, row in enumerate(rows) if int(row["boxes"]) > 1)
        assert run["first_grown"] == first + 1
        course = np.load(folder / "course.npz")
        assert course["steps"].tolist() == [int(row["steps"]) for row in rows]


def test_the_best_actions_are_tested_where_they_change_and_nowhere_else(walked: Path) -> None:
    course = np.load(walked / "seed_0" / "course.npz")
    changed = np.diff(course["best_steps"]) != 0.0

    assert changed.any()
    assert np.all(np.diff(course["boxes"])[changed] != 0)


def test_a_folder_holds_curves_figures_rules_learners_and_the_summary(walked: Path) -> None:
    names = {path.relative_to(walked).as_posix() for path in walked.rglob("*") if path.is_file()}

    assert names >= {"experiment.json", "summary.txt", "summary.json", "learning.svg"} | {
        f"seed_0/{name}"
        for name in ("policy.svg", "rules.svg", "rules.txt", "rules.csv", "rules.json")
    }
    told = (walked / "summary.txt").read_text()
    assert told.startswith("gridworld by the learner steps: a run of 60 episodes\n")
    assert "(true in " in (walked / "seed_0" / "rules.txt").read_text()


def test_json_and_episodes_and_what_is_not_known_yet(capsys: pytest.CaptureFixture[str]) -> None:
    quick = ["learn", "puddles", "-n", "2", "--tests", "3", "--with", "noise=0"]
    assert main([*quick, "--format", "json"]) == 0
    found = result(capsys)
    assert main(quick) == 0
    told = capsys.readouterr().out

    assert found["experiment"]["learner"] == "steps"
    [run] = found["runs"]
    assert run["first_grown"] is None
    assert run["thinned"]["rules"] == 0
    assert "a run of 2 episodes" in told
    assert "nothing is known, and all actions are taken at random" in told
    assert "cycle" not in told


def learnt(folder: str, episodes: int, seed: int = 0) -> AnyRun:
    """A run that is kept in a folder, after so many episodes."""
    asked = Experiment("puddles", {}, "steps", SETTINGS, episodes, (seed,), 5)
    world = problem_of(asked)
    runs = learnt_from(
        asked,
        world,
        config_of(asked, world),
        Path(folder),
        tell=lambda _what, _done, _of: None,
        shall_stop=lambda: False,
    )
    assert isinstance(runs, tuple)
    [run] = runs
    return run


def bits(run: AnyRun) -> list[bytes]:
    """The learner, and every column of the course."""
    course = run.so_far()
    columns = [getattr(course, name).tobytes() for name in course.__slots__]
    return [as_bytes(run.learner.state()), *columns]


@settings(max_examples=6, deadline=None)
@given(st.lists(st.integers(1, 25), min_size=1, max_size=4), st.integers(0, 5))
def test_resumed_anywhere_equals_uninterrupted(
    tmp_path_factory: pytest.TempPathFactory, parts: list[int], seed: int
) -> None:
    folder = tmp_path_factory.mktemp("resumed")
    whole = learnt(str(folder / "whole"), sum(parts), seed)
    done = 0
    for part in parts:
        done += part
        resumed = learnt(str(folder / "parts"), done, seed)

    assert bits(resumed) == bits(whole)
    assert bits(taken_up(folder / "parts" / f"seed_{seed}" / "checkpoint.npz")) == bits(whole)


def test_ctrl_c_keeps_what_was_learnt_and_says_how_it_goes_on(
    walked: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    advance, calls = WorldTeacher.advance, []

    def interrupted(teacher: WorldTeacher, run: AnyRun, most: int) -> float:
        calls.append(run)
        if len(calls) > 1:  # after kernels were loaded
            os.kill(os.getpid(), signal.SIGINT)
        return advance(teacher, run, min(most, 37))

    record = json.loads((walked / "experiment.json").read_text())
    Path("out").mkdir()
    Path("out/experiment.json").write_text(json.dumps(record))
    with monkeypatch.context() as patched:
        patched.setattr(WorldTeacher, "advance", interrupted)
        assert main(["learn", "--resume", "-o", "out"]) == 130
    assert "interrupted after 37 of 60 episodes" in capsys.readouterr().err

    assert main(["learn", "--resume", "-o", "out"]) == 0
    for name in ("learner.npz", "course.npz", "curve.csv", "rules.csv", "policy.svg"):
        assert Path("out/seed_0", name).read_bytes() == (walked / "seed_0" / name).read_bytes()


def test_going_on_is_refused_with_words_of_a_world(
    walked: Path, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(walked, "out")
    assert main(["learn", "--resume", "--episodes", "9", "-o", "out"]) == 2
    told = capsys.readouterr().err
    assert "9 episodes are fewer than the 60" in told
    assert "write more --episodes" in told
    assert main(["learn", "--resume", "--seed", "9", "-o", "out"]) == 2
    assert "only --episodes can be said anew" in capsys.readouterr().err

    shutil.copy(kept / "seed_0" / "checkpoint.npz", "out/seed_0/checkpoint.npz")
    assert main(["learn", "--resume", "-o", "out"]) == 2
    assert "error[V404]: this checkpoint is of another learner" in capsys.readouterr().err
