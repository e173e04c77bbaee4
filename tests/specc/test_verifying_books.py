"""Books beside recordings: which modules are done, which fail, and which lack data."""

import json
import math
import re
from dataclasses import replace
from html import unescape
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest

from runtime.program import Program
from runtime.recording.scenario_run import recorded_run
from specc.book.export import export_book
from specc.book.folder import read_book
from specc.book.loading import load_book
from specc.cli import main
from specc.loading import compile_scenario_spec
from specc.scenarios.simulating import simulate_scenario
from specc.verifying.book_matching import spec_held
from specc.verifying.book_modules import pieces_of
from specc.verifying.book_record import book_record
from specc.verifying.book_verdict import verify_book
from tests.specc.book_scenes import FILES, SCENARIO, laid_down
from verifier.fidelity.judging.outside import own_binding
from verifier.traces.read import read_trace

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
        "fails": 1, "lacks data": 1, "done": 0, "promises nothing": 0, "unusable": 0, "left out": 0
    }  # fmt: skip


def test_what_no_recording_holds_is_told_with_what_to_record(
    book: Path, home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    logs = logs_of(home, book, "part", 1.0)[:1]
    status = main(["verify", str(book), str(logs[0]), "--spec", str(home / "mapped.yaml")])
    said = " ".join(capsys.readouterr().out.split())
    assert status == 4
    assert "nothing is recorded of choose: what to record stands in the book" in said
    assert "pages/choose.html" in said
    assert "show the arbiter these" not in said
    assert said.endswith("1 of 2 modules done, 0 fail, 1 lacks data")


def test_the_procedure_of_what_nobody_recorded_is_printed_on_request(
    book: Path, home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log, mapped = logs_of(home, book, "asked", 1.0)[0], str(home / "mapped.yaml")
    main(["verify", str(book), str(log), "--spec", mapped, "--procedures"])
    said = " ".join(capsys.readouterr().out.split())
    assert "choose lacks data no recording holds it" in said
    assert "show the arbiter these" in said
    assert "nothing is recorded of" not in said


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
    assert found["standing"] == "lacks data"
    assert {each["node"] for each in found["modules"]} == {"index", "choose"}
    told = page.read_text()
    assert "Every module" in told
    assert said.strip().splitlines()[-1] in told
    assert "lacks data</span>" in told
    assert "inconclusive</span>" not in told.partition("<article")[0]
    for name in ("index", "choose"):
        assert f'<testsuite name="{name}"' in suite.read_text()


def plain(log: Path, to: Path) -> Path:
    """A log under the book's own names and in its units, somewhere else."""
    rows = [line.split(",") for line in log.read_text().splitlines()[1:]]
    own = [f"{t},{np.radians(float(angle)):.6f},{knob}" for t, angle, knob in rows]
    to.parent.mkdir(parents=True, exist_ok=True)
    to.write_text("\n".join(["time,bearing,gain", *own]) + "\n")
    return to


def test_logs_under_the_books_names_need_no_project_file(
    book: Path, home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    logs = [plain(log, tmp_path / "runs" / log.name) for log in logs_of(home, book, "plain", 1.0)]
    verdict = verify_book(book, logs, depth="verdict")
    assert {e.piece.place.node: str(e.standing) for e in verdict.modules} == {
        "index": "done",
        "choose": "lacks data",
    }
    found = book_record(verdict)["modules"]
    assert isinstance(found, list)
    assert "its columns are those of face: bearing, gain" in found[0]["recordings"][0]["found_by"]


def test_only_some_modules_may_be_judged(
    book: Path, home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    logs = [plain(log, tmp_path / "runs" / log.name) for log in logs_of(home, book, "only", 1.0)]
    arguments = ["verify", str(book), *map(str, logs), "--quick", "--only"]
    assert main([*arguments, "index"]) == 0
    assert capsys.readouterr().out.endswith("1 of 1 module done, 0 fail, 0 lack data, 1 left out\n")
    assert main([*arguments, "turner.choose"]) == 4
    assert "0 of 1 module done, 0 fail, 1 lacks data" in capsys.readouterr().out
    assert main([*arguments, "indx"]) == 2
    said = capsys.readouterr().err
    assert "V444" in said
    assert "did you mean 'index'?" in said


def test_a_module_recorded_with_others_may_be_judged_alone(
    book: Path, faithful: list[Path]
) -> None:
    verdict = verify_book(book, faithful[:1], depth="verdict", only=["choose"])
    assert [each.piece.place.node for each in verdict.modules] == ["choose"]
    assert verdict.modules[0].members
    assert verdict.left_out == 1


def test_a_log_that_holds_no_modules_names_is_told_what_is_missing(
    book: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.csv").write_text("time,far,decided\n0,1,calm\n0.1,1,calm\n")
    assert main(["verify", str(book), "run.csv"]) == 2
    said = " ".join("".join(capsys.readouterr()).split())
    assert "V442" in said
    assert "of eager, the nearest, choice is missing" in said
    assert "columns: time, far, decided" in said


def test_of_several_modules_that_fit_the_files_name_decides(
    book: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    header = "time,bearing,gain,far,choice\n"
    rows = "".join(f"{0.1 * k:.1f},0.1,1,3,eager\n" for k in range(60))
    for name in ("run.csv", "face_1.csv", "choose-2.csv"):
        (tmp_path / name).write_text(header + rows)
    loaded = load_book(book)
    pieces = [p for made, _ in loaded.architectures for p in pieces_of(made)]
    assert spec_held(loaded, Path("face_1.csv"), pieces).program.name == "face"
    assert spec_held(loaded, Path("choose-2.csv"), pieces).program.name == "eager"
    assert main(["verify", str(book), "run.csv"]) == 2
    said = capsys.readouterr()
    assert "V443" in said.out + said.err
    _, _, snippet = (said.out + said.err).partition("that is meant:\n")
    Path("specc.yaml").write_text(dedent("\n".join(snippet.splitlines()[:6])))
    main(["verify", str(book), "run.csv", "--only", "index"])
    assert "since 'run.csv' names it in specc.yaml" in capsys.readouterr().err


def test_of_two_specs_of_one_name_each_module_is_judged_by_its_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = laid_down(tmp_path / "two")
    lazy = FILES["face.yaml"].replace("-gain * sin(bearing)", "-0.5 * gain * sin(bearing)")
    (folder / "lazy.yaml").write_text(lazy)
    robot = FILES["robots/turner.yaml"].replace("name: turner", "name: idler")
    (folder / "robots" / "idler.yaml").write_text(robot.replace("face.yaml", "lazy.yaml"))
    first = "  r: {architecture: robots/turner.yaml, at: [1 m, 1 m, 90 deg]}\n"
    second = "  s: {architecture: robots/idler.yaml, at: [2 m, 1 m, 90 deg]}\n"
    (folder / SCENARIO).write_text(FILES[SCENARIO].replace(first, first + second))
    export_book(folder / SCENARIO, folder / "book", quiet, with_pdf=False)
    log = tmp_path / "face_1.csv"
    times = np.arange(0.0, 20.0, 0.05)
    lines = [f"{t:.2f},{2.0 * math.exp(-t):.6f},1.5" for t in times]
    log.write_text("\n".join(["time,bearing,gain", *lines]) + "\n")

    assert main(["verify", str(folder / "book"), str(log)]) == 2
    told = capsys.readouterr().out
    assert "V443" in told
    assert "the names of face (specs/face.yaml) and face (specs/lazy.yaml)" in told

    own = folder / "book" / "specs" / "lazy.yaml"
    main(["verify", str(folder / "book"), str(log), "--spec", str(own), "--format", "json"])
    told = json.loads(capsys.readouterr().out)
    judged = [each for each in told["modules"] if each["recordings"]]
    assert [each["architecture"] for each in judged] == ["idler"]


def test_several_specs_are_refused(
    book: Path, home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mapped = str(home / "mapped.yaml")
    assert main(["verify", str(book), "x.csv", "--spec", mapped, "--spec", mapped]) == 2
    assert "--spec: name one spec" in capsys.readouterr().err


def test_the_example_in_the_book_is_a_recording_of_its_module(book: Path, tmp_path: Path) -> None:
    page = unescape(re.sub("<[^>]+>", "", (book / "pages" / "building.html").read_text()))
    found = re.search(r"time,bearing,gain\n(?:[0-9.,e-]+\n)+", page)
    assert found is not None
    (tmp_path / "run.csv").write_text(found.group())
    loaded = load_book(book)
    pieces = [p for made, _ in loaded.architectures for p in pieces_of(made)]
    program = spec_held(loaded, tmp_path / "run.csv", pieces).program
    assert isinstance(program, Program)
    assert program.name == "face"
    bearing = read_trace(tmp_path / "run.csv", program).series["bearing"]
    slope = -1.5 * np.sin(bearing.values[:-1])
    assert np.diff(bearing.values) / np.diff(bearing.times) == pytest.approx(slope, rel=1e-3)
    assert "time, far, choice" in page


def test_a_log_under_the_specs_own_names_need_not_stand_where_its_author_had_it(
    book: Path, tmp_path: Path
) -> None:
    (tmp_path / "run.csv").write_text("time,bearing,gain\n0,0.1,1\n0.1,0.1,1\n")
    loaded = load_book(book)
    pieces = [p for made, _ in loaded.architectures for p in pieces_of(made)]
    face = next(p for p in pieces if isinstance(p.spec, Program))
    assert isinstance(face.spec, Program)
    elsewhere = own_binding(face.spec.states[0], "light_angle")
    bound = replace(face, spec=replace(face.spec, bindings=(elsewhere,)))
    found = spec_held(loaded, tmp_path / "run.csv", [bound]).program
    assert found.bindings == ()
