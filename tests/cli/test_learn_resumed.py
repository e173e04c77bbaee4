"""Experiments that are interrupted, killed, resumed and made longer give the bits of one run."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lcs.saving import as_bytes
from spec_schema.diagnostics import SpecError
from specc.cli import main
from specc.cli.interrupts import postponed
from specc.learning import running
from specc.learning.experiment import Experiment, config_of, problem_of
from specc.learning.learning import learnt_from
from specc.learning.resuming import taken_up
from specc.learning.teaching_problems import ProblemTeacher
from specc.learning.warming import is_warm, warm

COMMAND = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "from specc.learning import running\n"
    "running.KEPT_EVERY = 0.1\n"
    "from specc.cli import entry; entry()"
)
BOARD = ["learn", "checkerboard_3x3", "--tests", "500"]


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def started(*arguments: str) -> "subprocess.Popen[str]":
    """The command in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", COMMAND, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def learnt(folder: str, cycles: int) -> Path:
    """The folder in which a run is kept, after so many cycles."""
    board = Experiment("checkerboard_3x3", {}, "alcsr", {}, cycles, (0,), 1)
    problem = problem_of(board)
    learnt_from(
        board,
        problem,
        config_of(board, problem),
        Path(folder),
        tell=lambda _what, _done, _of: None,
        shall_stop=lambda: False,
    )
    return Path(folder)


def equal(one: Path, other: Path) -> bool:
    """Whether two folders keep the same learner, the same course, and as many cycles."""
    kept = [np.load(folder / "seed_0" / "checkpoint.npz") for folder in (one, other)]
    return all(
        each.tobytes() == kept[1][name].tobytes()
        for name, each in kept[0].items()
        if name != "seconds"
    )


def done_in(folder: Path) -> int:
    """How many cycles the checkpoint of seed 0 has."""
    path = folder / "seed_0" / "checkpoint.npz"
    return int(np.load(path)["done"]) if path.exists() else 0


def wait_for(happens: Callable[[], bool], run: "subprocess.Popen[str]") -> None:
    """Until it has happened; a process that ends before has failed."""
    end = time.monotonic() + 120.0
    while not happens():
        assert run.poll() is None, run.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
def test_ctrl_c_and_kill_lose_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    if not is_warm("alcsr"):
        warm("alcsr")
    out = Path("out")
    run = started(*BOARD, "--cycles", "10000000", "-o", "out")
    wait_for(lambda: done_in(out) > 0, run)
    run.kill()
    run.communicate()
    killed = done_in(out)

    run = started("learn", "--resume", "-o", "out")
    wait_for(lambda: done_in(out) > killed, run)
    run.send_signal(signal.SIGINT)
    _, told = run.communicate(timeout=30)
    done = done_in(out)

    assert run.returncode == 130
    assert told == (
        f"interrupted after {done:,} of 10,000,000 cycles\n"
        "all of it is kept; go on with: specc learn --resume -o out\n"
    )
    record = json.loads((out / "experiment.json").read_text())
    (out / "experiment.json").write_text(json.dumps({**record, "cycles": done + 1_234}))
    assert main(["learn", "--resume", "-o", "out"]) == 0
    assert f"a run of {done + 1_234:,} cycles" in capsys.readouterr().out
    assert equal(out, learnt("whole", done + 1_234))


def test_a_run_in_small_pieces_is_that_in_large_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    one = learnt("one", 3_300)
    monkeypatch.setattr(running, "ATTENTION", 1e-9)

    assert equal(one, learnt("other", 3_300))


def test_a_run_that_is_done_goes_on_to_more_cycles() -> None:
    learnt("one", 2_345)

    assert equal(learnt("one", 4_000), learnt("whole", 4_000))


def test_what_else_is_learnt_would_be_noticed() -> None:
    assert not equal(learnt("one", 2_000), learnt("other", 2_001))


def test_resuming_writes_what_had_no_time_to_be_written(kept: Path) -> None:
    shutil.copytree(kept, "out")
    (Path("out") / "summary.json").unlink()

    assert main(["learn", "--resume", "--cycles", "1200", "-o", "out"]) == 0
    record = json.loads((Path("out") / "summary.json").read_text())

    assert record["experiment"]["cycles"] == record["runs"][0]["cycles"] == 1_200


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ([*BOARD, "-o", "out"], "`specc learn --resume -o out` goes on with it"),
        (["learn", "--resume", "--cycles", "900", "-o", "out"], "900 cycles are fewer"),
        (["learn", "--resume", "-o", "empty"], "there is nothing to resume"),
        (["learn", "--resume", "--seed", "1", "-o", "out"], "as it was begun: only --cycles"),
        (["learn", "experiment_1", "--resume", "-o", "out"], "goes on with the checkerboard_3x3"),
    ],
)
def test_a_folder_is_begun_once_and_resumed_as_it_was_begun(
    asked: list[str], said: str, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(kept, "out")

    assert main(asked) == 2
    assert said in capsys.readouterr().err
    assert (Path("out") / "experiment.json").read_bytes() == (kept / "experiment.json").read_bytes()


@pytest.mark.parametrize("damage", ["cut", "empty", "other", "record"])
def test_what_is_damaged_is_told_and_not_a_traceback(
    damage: str, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(kept, "out")
    file = Path("out/seed_0/checkpoint.npz")
    if damage == "record":
        file = Path("out/experiment.json")
        file.write_text("{}")
    elif damage == "other":
        np.savez(file, done=np.array(3))
    else:
        file.write_bytes(file.read_bytes()[: 5_000 if damage == "cut" else 0])

    assert main(["learn", "--resume", "-o", "out"]) == 2
    told = capsys.readouterr().err
    assert re.search(rf"{file}: error\[V404\]: this ", told)
    assert "help" in told


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        ({"learner": "xcs"}, "no learner is named 'xcs'"),
        ({"cycles": "many"}, "'cycles' has 'many'"),
        ({"tests": None}, "'tests' has None"),
        ({"seeds": [0.5]}, "'seeds' has 0.5"),
        ({"seeds": []}, "'seeds' is empty"),
        ({"given": []}, "this is no experiment"),
        ({"settings": {"explore": 0.5}}, "0.5 is no text"),
        ({"problem": 3}, "3 is no text"),
    ],
)
def test_a_record_that_does_not_fit_is_told_with_what_does_not(
    edit: dict[str, object], said: str, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = json.loads((kept / "experiment.json").read_text())
    Path("experiment.json").write_text(json.dumps(record | edit))

    assert main(["learn", "--resume", "-o", "."]) == 2
    told = capsys.readouterr().err
    assert "experiment.json: error[V404]: " in told
    assert said in told


def test_a_checkpoint_with_a_bit_changed_anywhere_is_refused_or_the_same(kept: Path) -> None:
    content = (kept / "seed_0" / "checkpoint.npz").read_bytes()
    same, path = (
        as_bytes(taken_up(kept / "seed_0" / "checkpoint.npz").learner.state()),
        Path("c.npz"),
    )
    refused = 0
    for at in np.linspace(0, len(content) - 1, 150).astype(int):
        path.write_bytes(content[:at] + bytes([content[at] ^ 0x10]) + content[at + 1 :])
        try:
            found = taken_up(path)
        except SpecError:
            refused += 1
        else:
            assert as_bytes(found.learner.state()) == same
    assert refused > 100


def test_ctrl_c_without_a_folder_says_that_nothing_was_kept(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    if not is_warm("alcsr"):
        warm("alcsr")
    advance, calls = ProblemTeacher.advance, []

    def interrupted(*given: Any) -> float:
        calls.append(given)
        if len(calls) > 1:  # after kernels were loaded
            os.kill(os.getpid(), signal.SIGINT)
        return advance(*given)

    monkeypatch.setattr(ProblemTeacher, "advance", interrupted)

    assert main([*BOARD, "--cycles", "1000"]) == 130
    out, err = capsys.readouterr()
    assert out == ""
    assert err == (
        "interrupted after 100 of 1,000 cycles\n"
        "nothing was kept, since no folder was named: -o FOLDER\n"
    )


def test_an_interruption_that_is_postponed_is_heard_and_then_all_is_as_before() -> None:
    with postponed() as wanted:
        assert not wanted.is_set()
        os.kill(os.getpid(), signal.SIGINT)
        assert wanted.is_set()
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
