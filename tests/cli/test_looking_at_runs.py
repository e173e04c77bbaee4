"""`specc simulate --poster --animate --watch` and `specc replay`, as a user calls them."""

import json
import re
from pathlib import Path

import pytest
from PIL import Image

import specc
from specc.cli import main

FIRST_LIGHT = "specs/scenarios/first_light.yaml"


@pytest.fixture(autouse=True)
def _no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two seconds of a run: recorded, as a poster, and as a film."""
    folder = tmp_path_factory.mktemp("run")
    told = ["-o", "run.mcap", "--poster", "run.svg", "--animate", "run.gif"]
    paths = [str(folder / each) if "." in each else each for each in told]

    assert main(["simulate", FIRST_LIGHT, "-d", "2", "--speed", "4", *paths]) in {0, 4}
    return folder


def words(svg: Path) -> list[str]:
    """What the poster says: matplotlib notes each text above its outlines."""
    return re.findall(r"<!-- (.*?) -->", svg.read_text(encoding="utf-8"))


def test_a_run_leaves_a_recording_a_poster_and_a_film_and_nothing_else(made: Path) -> None:
    assert {path.name for path in made.iterdir()} >= {"run.mcap", "run.svg", "run.gif"}
    assert not [path for path in made.iterdir() if path.name.endswith(".part")]
    with Image.open(made / "run.gif") as film:
        assert getattr(film, "n_frames", 0) == 7  # 2 s at 4 times the speed, 12 in a second
    assert any(
        "2 s of simulated time, seed 7. Acting: seek" in text for text in words(made / "run.svg")
    )


def test_a_recording_gives_the_same_poster_without_a_run(made: Path) -> None:
    again = made / "again.svg"

    assert main(["replay", str(made / "run.mcap"), "--poster", str(again)]) == 0

    assert words(again) == words(made / "run.svg")
    assert len(again.read_bytes()) == pytest.approx(len((made / "run.svg").read_bytes()), abs=200)


def test_of_a_blend_all_act_and_looking_again_at_a_violation_is_no_failure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, poster = str(tmp_path / "run.mcap"), str(tmp_path / "run.svg")
    assert main(["simulate", "specs/scenarios/light_dynamics.yaml", "-d", "1", "-o", path]) == 1
    assert "avoid, seek and wander act all at once; their shares" in capsys.readouterr().out

    assert main(["replay", path, "--poster", poster]) == 0
    assert "1 of 1 requirement violated" in capsys.readouterr().out
    assert main(["simulate", FIRST_LIGHT, "-d", "1"]) in {0, 4}
    assert "in a blend" not in capsys.readouterr().out


def test_python_draws_what_the_command_draws(made: Path, tmp_path: Path) -> None:
    specc.draw_run(made / "run.mcap", tmp_path / "run.svg")
    specc.film_run(made / "run.mcap", tmp_path / "run.gif", speed=4)

    assert words(tmp_path / "run.svg") == words(made / "run.svg")
    with Image.open(tmp_path / "run.gif") as film:
        assert getattr(film, "n_frames", 0) == 7


def test_watching_changes_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    told = ["simulate", FIRST_LIGHT, "-d", "1", "--format", "json"]

    main(told)
    alone = json.loads(capfd.readouterr().out)
    main([*told, "--watch", "--speed", "50"])
    out, err = capfd.readouterr()
    watched = json.loads(out)

    assert watched["state_hash"] == alone["state_hash"]
    assert watched["took"] is None
    assert {k: v for k, v in watched.items() if k not in {"took", "real_time_factor"}} == {
        k: v for k, v in alone.items() if k not in {"took", "real_time_factor"}
    }
    assert "1 s  r: x " in err
    assert "\x1b" not in err


@pytest.mark.parametrize(
    ("option", "name", "known"),
    [
        ("--poster", "run.jpg", ".svg, .png, .pdf"),
        ("--animate", "run.avi", ".gif, .mp4"),
        ("-o", "run.csv", ".mcap"),
    ],
)
def test_wrong_endings_are_refused_before_the_run(
    option: str,
    name: str,
    known: str,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("specc.scenarios.simulating.run", None)  # a run would fail

    assert main(["simulate", FIRST_LIGHT, option, name]) == 2

    assert f"known are {known}" in capfd.readouterr().err


def test_an_mp4_without_ffmpeg_is_refused_before_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("specc.scenarios.simulating.run", None)

    assert main(["simulate", FIRST_LIGHT, "--animate", "run.mp4"]) == 2

    assert "install ffmpeg, or write run.gif" in capfd.readouterr().err


def test_a_behavior_alone_has_no_poster(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "specs/van_der_pol.yaml", "--poster", "x.svg"]) == 2

    assert "`specc portrait` draws a behavior" in " ".join(capfd.readouterr().err.split())


def test_what_is_no_recording_of_a_scenario_is_not_replayed(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "alone.mcap"
    assert main(["simulate", "specs/van_der_pol.yaml", "-d", "1", "-o", str(path)]) == 0
    capfd.readouterr()

    assert main(["replay", str(path)]) == 2

    assert "error[V393]: this is not the recording of a scenario" in capfd.readouterr().err


def test_a_recording_that_does_not_exist_is_told_as_that(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["replay", str(tmp_path / "none.mcap")]) == 2

    assert "error[V301]: there is no such file" in capfd.readouterr().err


def test_a_replay_on_a_pipe_is_lines_and_what_was_required(
    made: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["replay", str(made / "run.mcap")]) == 0

    out, err = capfd.readouterr()
    assert err.splitlines()[-1].startswith("2 s  r: x ")
    assert "first_light: " in out
    assert "always r.clearance > 5 mm" in out
