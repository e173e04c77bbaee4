"""Books beside recordings: which modules are done, which fail, and which lack data."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from runtime.recording.scenario_run import recorded_run
from specc.book.export import export_book
from specc.book.folder import read_book
from specc.cli import main
from specc.loading import compile_scenario_spec
from specc.scenarios.simulating import simulate_scenario
from specc.verifying.book_verdict import verify_book
from tests.specc.book_scenes import FILES, SCENARIO, laid_down

MAPPING = """
trace:
  bearing: {path: light_angle, unit: deg}
  gain: knob
"""
"""Where things stand in logs of the builder's own: what the book's spec does not say."""


def quiet(_what: str, _done: int, _of: int) -> None:
    pass


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = laid_down(tmp_path_factory.mktemp("books"))
    (folder / "mapped.yaml").write_text(FILES["face.yaml"] + MAPPING)
    return folder


@pytest.fixture(scope="module")
def book(home: Path) -> Path:
    export_book(home / SCENARIO, home / "book", quiet, with_pdf=False)
    return home / "book"


def runs_of(
    home: Path, name: str, turn: str, when: str = "far > near", count: int = 3
) -> list[Path]:
    """Runs of a robot that turns, or decides, by another spec, from several places."""
    folder = laid_down(home / name)
    face, eager = folder / "face.yaml", folder / "arbiters" / "eager.yaml"
    face.write_text(FILES["face.yaml"].replace("is: gain * sin(bearing)", f"is: {turn}"))
    eager.write_text(FILES["arbiters/eager.yaml"].replace("far > near", when))
    found = []
    for k, heading in enumerate((-150, -110, -70, 10, 40, 170)[:count]):
        place = f"[{0.5 + 0.5 * k} m, 0.6 m, {heading} deg]"
        scenario = folder / "turning.yaml"
        scenario.write_text(FILES["turning.yaml"].replace("[1 m, 1 m, 90 deg]", place))
        made = replace(compile_scenario_spec(scenario).scenario, duration=8.0)
        path = folder / f"run_{k}.mcap"
        path.write_bytes(recorded_run(simulate_scenario(made).run))
        found.append(path)
    return found


def logs_of(home: Path, book: Path, name: str, gain: float) -> list[Path]:
    """The test procedure in the book, driven by a robot whose gain is so many times the one set.

    Of theta' = -g sin(theta) tan(theta / 2) falls by exp(-g t): a closed form. The builder logs
    degrees, and under names of its own.
    """
    module = next(m for m in read_book(book).modules if m.node == "index")
    assert module.trial.procedure is not None
    procedure, rng, found = module.trial.procedure, np.random.default_rng(3), []
    (home / name).mkdir()
    for k, drive in enumerate(procedure.drives * max(d.repeats for d in procedure.drives)):
        half, now, rows = np.tan(drive.start["bearing"] / 2.0), 0.0, []
        for stage in drive.stages:
            knob = stage.held["gain"]
            for tick in np.arange(round(stage.seconds * procedure.rate)) / procedure.rate:
                angle = 2.0 * np.arctan(half * np.exp(-gain * knob * tick))
                noisy = np.degrees(angle + 0.01 * rng.standard_normal())
                rows.append(f"{now + tick:.6f},{noisy:.6f},{knob:.6f}")
            half *= np.exp(-gain * knob * stage.seconds)
            now += stage.seconds
        path = home / name / f"log_{k}.csv"
        path.write_text("\n".join(["time,light_angle,knob", *rows]) + "\n")
        found.append(path)
    return found


@pytest.fixture(scope="module")
def faithful(home: Path) -> list[Path]:
    return runs_of(home, "faithful", "gain * sin(bearing)", count=6)


def told(book: Path, traces: list[Path], spec: Path | None = None) -> dict[str, str]:
    """The standing of each module."""
    verdict = verify_book(book, traces, spec, depth="verdict")
    return {each.piece.place.node: str(each.standing) for each in verdict.modules}


def test_a_faithful_robot_fails_in_no_module(book: Path, faithful: list[Path]) -> None:
    standings = told(book, faithful)
    assert standings["index"] == "done"
    assert "fails" not in standings.values()


@pytest.mark.parametrize(
    ("name", "turn", "when", "named"),
    [
        ("weak", "0.3 * gain * sin(bearing)", "far > near", "index"),
        ("reversed", "-gain * sin(bearing)", "far > near", "index"),
        ("hasty", "gain * sin(bearing)", "far < near", "choose"),
    ],
)
def test_the_sabotaged_module_is_named_and_no_other(
    book: Path, home: Path, name: str, turn: str, when: str, named: str
) -> None:
    standings = told(book, runs_of(home, name, turn, when))
    assert [node for node, standing in standings.items() if standing == "fails"] == [named]


def test_logs_of_the_procedure_under_other_names_decide_about_the_module(
    book: Path, home: Path
) -> None:
    standings = told(book, logs_of(home, book, "procedure", 1.0), home / "mapped.yaml")
    assert standings == {"index": "done", "choose": "lacks data"}


def test_logs_of_a_robot_with_half_the_gain_fail(
    book: Path, home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    logs = logs_of(home, book, "slow", 0.5)[:12]
    assert told(book, logs, home / "mapped.yaml") == {"index": "fails", "choose": "lacks data"}
    arguments = [str(book), *map(str, logs[:6]), "--spec", str(home / "mapped.yaml")]
    assert main(["verify", *arguments, "--format", "json"]) == 1
    record = json.loads(capsys.readouterr().out)
    assert record["counts"] == {
        "fails": 1, "lacks data": 1, "done": 0, "promises nothing": 0, "unusable": 0
    }  # fmt: skip


def test_what_no_recording_holds_is_told_with_what_to_record(
    book: Path, home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    logs = logs_of(home, book, "part", 1.0)[:1]
    status = main(["verify", str(book), str(logs[0]), "--spec", str(home / "mapped.yaml")])
    said = " ".join(capsys.readouterr().out.split())
    assert status == 4
    assert "choose lacks data no recording holds it" in said
    assert "show the arbiter these" in said
    assert "LACKS DATA 2 modules: " in said


def test_a_recording_of_something_else_is_refused(
    book: Path, home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = logs_of(home, book, "other", 1.0)[0]
    other = home / "other.yaml"
    other.write_text((FILES["face.yaml"] + MAPPING).replace("name: face", "name: nose"))
    assert main(["verify", str(book), str(log), "--spec", str(other)]) == 2
    said = capsys.readouterr()
    assert "V440" in said.out + said.err
    assert "eager, face" in said.out + said.err


def test_a_book_without_recordings_is_told_so(
    book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(book)]) == 2
    assert "V441" in capsys.readouterr().err


def test_reports_of_a_book_say_the_same_as_the_terminal(
    book: Path, home: Path, faithful: list[Path], capsys: pytest.CaptureFixture[str]
) -> None:
    page, suite, record = (home / f"report.{kind}" for kind in ("html", "xml", "json"))
    outputs = [a for file in (page, suite, record) for a in ("-o", str(file))]
    main(["verify", str(book), str(faithful[0]), *outputs])
    said = capsys.readouterr().out
    found = json.loads(record.read_text())
    assert found["standing"] == ("done" if "DONE " in said else "lacks data")
    assert {each["node"] for each in found["modules"]} == {"index", "choose"}
    assert "Every module" in page.read_text()
    for name in ("index", "choose"):
        assert f'<testsuite name="{name}"' in suite.read_text()
