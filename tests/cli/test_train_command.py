"""`specc train`: what it leaves, what it refuses, and that nothing is lost when it is killed."""

import json
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from specc.cli import main
from specc.loading import load_scenario
from specc.training.checkpoint import taken_up
from specc.training.compaction import Trials
from specc.training.folder import Begun, begin_in
from specc.training.race import Racer
from specc.training.settings import Settings
from tests.specc.training_scenes import FILES, SMALL, equal, written_in

RESUME = ["train", "--resume", "-o", "out"]
MORE = Settings(episodes=44, first=3, each=3, mended=2, varied=1, tried_in=3, rules=3, patience=9)


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def begun(folder: str = "out", settings: Settings = SMALL, held_out: int = 2) -> Path:
    """A folder in which a small training is begun, of a scenario in this one."""
    path = written_in(Path())
    begin_in(Path(folder), Begun(str(path), settings, held_out), load_scenario(path).scenario)
    return Path(folder)


def test_what_was_learnt_is_left_told_and_written(capsys: pytest.CaptureFixture[str]) -> None:
    out = begun()

    assert main(RESUME) == 0
    told = capsys.readouterr()
    assert told.out == (out / "summary.txt").read_text()
    for words in (
        "pen: alcsr learnt how r.choose decides",
        "in 2 worlds held out",
        "what was learnt ",
        "choices at random ",
        "- to decide by 1 rule and not by the vote of",
        "rule 1: ",
        ", where ahead ",
        ", otherwise",
        "decisions a second",
        "the world alone ",
        " s of trials",
    ):
        assert words in told.out
    assert "generation 2: " in told.err
    assert "wrote choose.yaml, summary.txt, summary.json, curves.svg into out" in told.err
    assert (out / "curves.svg").read_text().startswith("<?xml")
    record = json.loads((out / "summary.json").read_text())
    assert [each["episodes"] for each in record["generations"]] == [6, 20]
    assert sum(record["speed"][part] for part in ("world", "control", "rewards", "learning")) == (
        pytest.approx(1.0)
    )
    assert min(record["ended"][part] for part in ("racing", "plain", "judging")) > 0.0
    text, learnt = FILES["choose.yaml"], (out / "choose.yaml").read_text()
    assert learnt.splitlines()[:8] == text.splitlines()[:8]
    assert learnt.endswith("agreement: {share: 0.9}   # of its decisions\n")
    assert Path("choose.yaml").read_text() == text

    assert main([*RESUME, "--write", "--format", "json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert Path("choose.yaml").read_text() == learnt
    assert again["generations"] == record["generations"]
    assert main(RESUME) == 0
    assert (out / "choose.yaml").read_text() == learnt
    assert "the arbiter as it was" not in capsys.readouterr().out


def test_a_finished_training_is_told_again_and_lives_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = begun()
    assert main(RESUME) == 0
    told = capsys.readouterr().out
    changed = FILES["choose.yaml"].replace("# Who acts in the pen.", "# Who acts there.")
    Path("choose.yaml").write_text(changed)
    monkeypatch.setattr("specc.training.workers.Workers.lived", None)

    assert main([*RESUME, "--write"]) == 0
    again = capsys.readouterr()
    assert again.out == told
    assert "this training is finished; its results are in out" in again.err
    learnt = (out / "choose.yaml").read_text()
    assert Path("choose.yaml").read_text() == learnt.replace("acts in the pen.", "acts there.")


def test_of_a_finished_training_only_what_was_learnt_is_written(
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = begun(held_out=0)
    assert main(RESUME) == 0
    learnt, before = (out / "choose.yaml").read_text(), Path("choose.yaml").read_text()

    by_hand = FILES["choose.yaml"].replace("alcsr: {}", "rules: [{choose: go}]")
    (out / "choose.yaml").write_text(by_hand)
    assert main([*RESUME, "--write"]) == 2
    assert "choose.yaml: error[V412]: this is not what the training left" in capsys.readouterr().err
    assert Path("choose.yaml").read_text() == before

    (out / "choose.yaml").write_text(learnt.replace(", wrong: 0", ""))
    assert main([*RESUME, "--write"]) == 0
    assert Path("choose.yaml").read_text() == learnt

    (out / "curves.svg").unlink()
    assert main(RESUME) == 0
    assert (out / "curves.svg").exists()


def test_an_arbiter_that_had_rules_is_judged_beside(capsys: pytest.CaptureFixture[str]) -> None:
    path = written_in(Path())
    rules = "alcsr: {otherwise: turn, rules: [{choose: go, when: ahead > 0.5}]}"
    Path("choose.yaml").write_text(FILES["choose.yaml"].replace("alcsr: {}", rules))
    begin_in(Path("out"), Begun(str(path), SMALL, 2), load_scenario(path).scenario)

    assert main(RESUME) == 0
    assert re.search(r"the arbiter as it was +1 +100 %", capsys.readouterr().out)


def test_a_training_that_is_killed_and_resumed_learns_what_one_in_peace_does() -> None:
    out, peace = begun(settings=MORE, held_out=0), begun("peace", settings=MORE, held_out=0)
    command = [sys.executable, "-c", "from specc.cli import entry; entry()", *RESUME, "-j", "2"]
    run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    end = time.monotonic() + 120.0
    while not (out / "checkpoint.npz").exists():
        assert run.poll() is None, run.communicate()
        assert time.monotonic() < end
        time.sleep(0.01)
    time.sleep(np.random.default_rng().uniform(0.0, 0.6))
    run.kill()
    run.communicate(timeout=30)  # until its processes are gone, too: they write to this pipe
    done = len(taken_up(out / "checkpoint.npz").generations)

    assert main(RESUME) == 0
    assert main(["train", "--resume", "-o", "peace"]) == 0
    assert 1 <= done <= 4
    assert (out / "choose.yaml").read_bytes() == (peace / "choose.yaml").read_bytes()
    kept, same = taken_up(out / "checkpoint.npz"), taken_up(peace / "checkpoint.npz")
    pairs = zip(kept.generations, same.generations, strict=True)
    assert all(equal(one.rules, other.rules) for one, other in pairs)


def test_ctrl_c_says_how_it_goes_on(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_given: object, **_named: object) -> None:
        raise KeyboardInterrupt

    begun()
    monkeypatch.setattr("specc.training.challengers.policy_of", interrupted)

    assert main(RESUME) == 130
    assert capsys.readouterr().err.endswith(
        "interrupted in the first generation\n"
        "none of it is kept yet; go on with: specc train --resume -o out\n"
    )


def test_ctrl_c_in_the_end_says_that_all_was_lived(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_given: object, **_named: object) -> None:
        raise KeyboardInterrupt

    out = begun()
    monkeypatch.setattr("specc.training.result.compacted", interrupted)

    assert main(RESUME) == 130
    assert re.search(
        r"interrupted in the end, after all \d\d episodes\n"
        r"these are kept; go on with: specc train --resume -o out\n\Z",
        capsys.readouterr().err,
    )
    assert not (out / "choose.yaml").exists()


def test_what_trials_said_is_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    out, peace = begun(settings=MORE, held_out=0), begun("peace", settings=MORE, held_out=0)
    asked, last, said = 0, 0, Trials._is_as_good

    def counted(trials: Trials, changed: Racer, now: Racer, floor: float) -> bool:
        nonlocal asked
        asked += 1
        if asked == last:
            raise KeyboardInterrupt
        return said(trials, changed, now, floor)

    monkeypatch.setattr(Trials, "_is_as_good", counted)
    assert main(["train", "--resume", "-o", "peace"]) == 0
    trials, asked, last = asked, 0, 3
    assert main(RESUME) == 130
    assert len(json.loads((out / "trials.json").read_text())["trials"]) == 2
    asked, last = 0, -1
    assert main(RESUME) == 0

    assert asked == trials - 2
    assert (out / "choose.yaml").read_bytes() == (peace / "choose.yaml").read_bytes()
    one, other = (json.loads((each / "summary.json").read_text()) for each in (out, peace))
    assert (one["final"], one["compaction"]) == (other["final"], other["compaction"])
    assert not (out / "trials.json").exists()


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        '{"of": [1, 2, 29], "winner": 0}',
        '{"of": [1, 2, 29], "winner": 2, "trials": []}',
        '{"of": [1, 2, 29], "winner": -1, "trials": []}',
        '{"of": [1, 2, 29], "winner": 0, "trials": ""}',
        '{"of": [1, 2, 29], "winner": 0, "trials": [1]}',
    ],
)
def test_trials_that_can_not_be_read_are_refused(
    text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (begun() / "trials.json").write_text(text)

    assert main(RESUME) == 2
    assert "trials.json: error[V412]: this is no list of trials" in capsys.readouterr().err


def test_a_scenario_that_trains_nothing_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    path = written_in(Path())
    path.write_text(FILES["pen.yaml"].partition("train:")[0])

    assert main(["train", "pen.yaml"]) == 2
    assert "pen.yaml: error[V410]: this scenario trains nothing" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("asked", "code"),
    [
        (["train", "pen.yaml", "-o", "out"], "V411"),
        (["train", "--resume", "-o", "empty"], "V411"),
        (["train", "pen.yaml", "-o", "choose.yaml"], "V414"),
        (["train", "pen.yaml", "-o", "."], "V414"),
        (["train", "--resume", "-o", "damaged"], "V412"),
    ],
)
def test_a_folder_that_does_not_fit_is_refused(
    asked: list[str], code: str, capsys: pytest.CaptureFixture[str]
) -> None:
    begun()
    record = json.loads((begun("damaged") / "training.json").read_text())
    record["settings"]["each"] = "many"
    (Path("damaged") / "training.json").write_text(json.dumps(record))

    assert main(asked) == 2
    assert f"error[{code}]" in capsys.readouterr().err


def test_a_scenario_that_changed_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    begun()
    Path("pen.yaml").write_text(FILES["pen.yaml"].replace("0.03", "0.04"))

    assert main(RESUME) == 2
    told = capsys.readouterr().err
    assert "pen.yaml: error[V413]: pen.yaml changed since the training was begun" in told


def test_a_training_goes_on_from_anywhere(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = begun(held_out=0).absolute()
    scenario = Path("pen.yaml").absolute()
    Path("elsewhere").mkdir()
    monkeypatch.chdir("elsewhere")
    assert main(["train", str(scenario), "--resume", "-o", str(out)]) == 0
    assert (out / "choose.yaml").exists()

    written_in(Path())
    assert main(["train", "pen.yaml", "--resume", "-o", str(out)]) == 2
    assert "goes on with the training of ../pen.yaml" in " ".join(capsys.readouterr().err.split())


def test_an_arbiter_into_which_no_rules_can_be_written_is_refused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    written_in(Path())
    text = FILES["choose.yaml"].replace("by:   # no rules yet\n  alcsr: {}", '"by": {"alcsr": {}}')
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    Path("choose.yaml").write_text("{" + ", ".join(_flow(lines)) + "}\n")

    assert main(["train", "pen.yaml"]) == 2
    assert "choose.yaml: error[V415]" in capsys.readouterr().err


def _flow(lines: list[str]) -> list[str]:
    """The arbiter in one line of YAML."""
    plain = [line.partition("  #")[0] for line in lines]
    place = plain.index("reads:")
    read = plain[place + 1].strip()
    return [*plain[:place], f"reads: {{{read}}}", *plain[place + 2 :]]


def test_an_arbiter_that_decides_in_each_step_of_the_world_is_refused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = written_in(Path())
    Path("pen_robot.yaml").write_text(FILES["pen_robot.yaml"].replace("400 ms", "200 ms"))
    path.write_text(FILES["pen.yaml"].replace("step: 20 ms", "step: 200 ms"))

    assert main(["train", "pen.yaml"]) == 2
    assert "error[S392]: 'r.choose' decides every 200 ms, and so does" in capsys.readouterr().err


def test_a_reward_without_end_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    path = written_in(Path())
    path.write_text(FILES["pen.yaml"].replace("5 * fast", "5 * fast / (room - room)"))

    assert main(["train", "pen.yaml", "-n", "6"]) == 2
    told = capsys.readouterr().err
    assert "pen.yaml: error[V416]: r.choose can't learn from this: the reward of decision" in told


def test_episodes_that_are_over_as_they_begin_are_refused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = written_in(Path())
    path.write_text(FILES["pen.yaml"].replace("r.clearance < 1 mm", "r.clearance > -1 m"))

    assert main(["train", "pen.yaml", "-n", "6"]) == 2
    told = capsys.readouterr().err
    assert "pen.yaml: error[V418]: each of 2 episodes was over as it began" in told


def test_what_is_resumed_is_not_said_anew(capsys: pytest.CaptureFixture[str]) -> None:
    begun()

    assert main([*RESUME, "--episodes", "100"]) == 2
    assert "leave out what else is said" in capsys.readouterr().err
