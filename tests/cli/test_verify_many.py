"""`specc verify` of many recordings: a table, one report, one exit status."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import specc.verifying.runs
from specc.cli import entry, main
from specc.verifying.trace import verify_by
from tests.verifier.test_report_formats import SCHEMA, faults
from verifier.report.report import Verdict

SPECS = Path(__file__).parents[2] / "specs"
VDP = str(SPECS / "van_der_pol.yaml")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three robots made by scipy: one faithful, one far off, and one that is seen too briefly."""
    folder = tmp_path_factory.mktemp("recordings")
    _record(folder / "good.csv", mu=1.0, seconds=60.0)
    _record(folder / "bad.csv", mu=2.0, seconds=60.0)
    _record(folder / "short.csv", mu=1.0, seconds=1.0)
    for seed, start in enumerate([(1.9, 0.2), (0.3, -0.2), (-1.5, 2.0), (-0.2, 0.5), (1.0, -2.2)]):
        _record(folder / f"brief{seed}.csv", mu=1.0, seconds=8.0, start=start, seed=seed)
    (folder / "torn.csv").write_text("")
    return folder


@pytest.fixture(autouse=True)
def recordings(recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for path in recorded.iterdir():
        shutil.copy(path, path.name)


def _record(
    path: Path,
    mu: float,
    seconds: float,
    start: tuple[float, float] = (1.0, 0.0),
    seed: int = 1,
) -> None:
    times = np.arange(0.0, seconds, 0.05)
    found = solve_ivp(
        lambda _, s: [s[1], mu * (1.0 - s[0] ** 2) * s[1] - s[0]],
        (0.0, times[-1]),
        list(start),
        t_eval=times,
        rtol=1e-9,
        atol=1e-9,
    )
    noise = 0.01 * np.random.default_rng(seed).standard_normal(found.y.shape)
    rows = np.column_stack([times, (found.y + noise).T, np.ones(len(times))])
    path.write_text("t,x,v,mu\n" + "\n".join(",".join(map(str, row)) for row in rows))


def verify(*arguments: str) -> int:
    return main(["verify", "--spec", VDP, "--quick", *arguments])


@pytest.mark.parametrize(
    ("traces", "status"),
    [
        (("good.csv", "good.csv"), 0),
        (("good.csv", "short.csv"), 0),
        (("short.csv", "short.csv"), 4),
        (("short.csv", "good.csv", "bad.csv"), 1),
        (("bad.csv", "torn.csv", "good.csv"), 2),
        (("nowhere.mcap", "good.csv"), 2),
    ],
)
def test_one_fail_counts_and_else_the_verdict_on_all_together(
    traces: tuple[str, ...], status: int
) -> None:
    assert verify(*traces) == status


def test_brief_recordings_decide_together_and_the_reports_say_so(
    capsys: pytest.CaptureFixture[str],
) -> None:
    brief = [f"brief{seed}.csv" for seed in range(5)]
    assert [verify(name) for name in brief] == [4] * 5
    capsys.readouterr()
    outputs = [part for name in ("r.json", "r.xml") for part in ("-o", name)]

    assert verify(*brief, *outputs) == 0

    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("5 recordings together  PASS") for line in lines)
    assert lines[-1] == "PASS  5 recordings: 5 inconclusive"
    record = json.loads(Path("r.json").read_text())
    assert record["verdict"] == "pass"
    assert [each["verdict"] for each in record["together"]] == ["pass"]
    assert record["together"][0]["recordings"] == brief
    assert faults(record, SCHEMA) == []
    suites = ET.fromstring(Path("r.xml").read_text())  # noqa: S314  our own
    assert (suites.attrib["failures"], suites.attrib["errors"]) == ("0", "0")
    assert [suite.attrib["name"] for suite in suites] == ["5 recordings together", *brief]
    assert all(int(suite.attrib["skipped"]) > 0 for suite in suites[1:])


def test_what_one_recording_leaves_open_is_a_note_where_all_decide(
    capsys: pytest.CaptureFixture[str],
) -> None:
    verify(*[f"brief{seed}.csv" for seed in range(5)], "--format", "github")

    assert "::warning" not in capsys.readouterr().out


def test_the_bar_tells_how_many_bytes_of_a_recording_are_read() -> None:
    told: list[tuple[int, int]] = []

    outcomes = specc.verifying.runs.verify_each(
        ["good.csv"], VDP, depth="verdict", reading=lambda done, whole: told.append((done, whole))
    )

    assert len(list(outcomes)) == 1
    assert told
    assert all(0 <= done <= whole for done, whole in told)


def test_recordings_of_two_specs_are_not_put_together() -> None:
    other = Path("other.yaml")
    other.write_text(Path(VDP).read_text() + "\n# the same, but another file\n")
    one = specc.verifying.runs.verify_together(["good.csv", "brief1.csv"], VDP, depth="verdict")
    mixed = [
        *one.outcomes[:1],
        *specc.verifying.runs.verify_each(["brief1.csv"], other, depth="verdict"),
    ]

    runs = specc.verifying.runs.runs_of(mixed)

    assert len(one.pools) == 1
    assert one.verdict is Verdict.PASS
    assert runs.pools == ()
    assert runs.verdict is Verdict.INCONCLUSIVE


@pytest.mark.parametrize("given", [None, "3"])
def test_threads_of_blas_are_one_unless_the_user_says_otherwise(given: str | None) -> None:
    program = "import os; from specc.cli import main; main(['--version']); "
    program += "print(*(os.environ[n] for n in ('OPENBLAS_NUM_THREADS', 'MKL_NUM_THREADS')))"
    kept = {name: value for name, value in os.environ.items() if not name.endswith("_THREADS")}
    kept |= {} if given is None else {"OPENBLAS_NUM_THREADS": given}

    told = subprocess.run(
        [sys.executable, "-c", program], env=kept, capture_output=True, text=True, check=True
    )

    assert told.stdout.split()[-2:] == [given or "1", "1"]


def test_the_table_has_a_row_for_each_and_says_why_one_did_not_pass(
    capsys: pytest.CaptureFixture[str],
) -> None:
    verify("good.csv", "bad.csv", "torn.csv")

    lines = capsys.readouterr().out.splitlines()
    rows = {line.split()[0]: line for line in lines[:4]}
    assert "PASS" in rows["good.csv"]
    assert "FAIL" in rows["bad.csv"]
    assert "exceeded" in rows["bad.csv"]
    assert "can't be used" in rows["torn.csv"]
    assert any(line.strip().startswith("bad.csv, FAIL: ") for line in lines[5:])
    assert any(line.strip().startswith("torn.csv can't be used: ") for line in lines[5:])
    assert lines[-1] == "FAIL  3 recordings: 1 fail, 1 pass, 1 can't be used"


def test_one_report_holds_all_recordings(capsys: pytest.CaptureFixture[str]) -> None:
    wanted = ["r.html", "r.json", "r.txt", "r.junit.xml", "r.sarif"]
    outputs = [part for name in wanted for part in ("-o", name)]

    assert verify("good.csv", "bad.csv", "torn.csv", *outputs) == 2

    record = json.loads(Path("r.json").read_text())
    assert record["verdict"] == "fail"
    assert record["counts"] == {
        "fail": 1,
        "inconclusive": 0,
        "pass": 1,
        "not_judged": 0,
        "unusable": 1,
    }
    assert [run["trace"]["source"] for run in record["runs"]] == ["good.csv", "bad.csv", "torn.csv"]
    assert record["runs"][2]["diagnostics"][0]["code"].startswith("V3")
    suites = ET.fromstring(Path("r.junit.xml").read_text())  # noqa: S314  our own
    names = ["2 recordings together", "good.csv", "bad.csv", "torn.csv"]
    assert [suite.attrib["name"] for suite in suites] == names
    sarif = json.loads(Path("r.sarif").read_text())
    traces = {result["properties"]["trace"] for result in sarif["runs"][0]["results"]}
    assert traces == {"2 recordings together", "bad.csv", "torn.csv"}
    page = Path("r.html").read_text()
    assert page.count("<article") == 3
    assert 'href="#run-1"' in page
    assert 'id="run-1"' in page
    assert 'href="#together-1"' in page
    assert 'id="together-1"' in page
    assert Path("r.txt").read_text().count("sha256") == 3
    capsys.readouterr()


def test_annotations_come_at_the_lines_of_the_spec(capsys: pytest.CaptureFixture[str]) -> None:
    assert verify("good.csv", "bad.csv", "--format", "github") == 1

    lines = capsys.readouterr().out.splitlines()
    assert lines
    assert all(line.startswith(("::error ", "::warning ", "::notice ")) for line in lines)
    assert any(f"file={VDP},line=" in line and "bad.csv: x departs" in line for line in lines)
    assert not any("good.csv" in line for line in lines if line.startswith("::error"))


def test_a_spec_that_cannot_be_used_is_told_once(capsys: pytest.CaptureFixture[str]) -> None:
    Path("wrong.yaml").write_text(
        Path(VDP).read_text().replace("kind: behavior", "kind: behaviour")
    )

    assert main(["verify", "good.csv", "bad.csv", "--spec", "wrong.yaml"]) == 2
    told = capsys.readouterr().err
    assert told.count("wrong.yaml:") >= 1
    assert told.count("error[") == 1


def test_a_mistake_is_an_annotation_where_annotations_are_asked_for(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert verify("torn.csv", "--format", "github") == 2
    assert capsys.readouterr().out.startswith("::error file=torn.csv,title=V3")


def test_an_interrupted_call_tells_what_was_done(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(specc.verifying.runs, "verify_by", _interrupted_at("bad.csv"))

    assert verify("good.csv", "bad.csv", "short.csv", "-o", "r.json") == 130

    told = capsys.readouterr()
    assert "interrupted: 1 of 3 recordings were judged" in told.err
    assert "PASS" in told.out
    assert len(json.loads(Path("r.json").read_text())["runs"]) == 1


def test_a_call_that_is_interrupted_at_once_ends_like_any_other(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(specc.verifying.runs, "verify_by", _interrupted_at("good.csv"))
    monkeypatch.setattr("sys.argv", ["specc", "verify", "good.csv", "bad.csv", "--spec", VDP])

    with pytest.raises(SystemExit) as ended:
        entry()

    assert ended.value.code == 130
    assert "interrupted" in capsys.readouterr().err


def _interrupted_at(name: str) -> Callable[..., object]:
    def judge(trace: Path, *arguments: object, **named: object) -> object:
        if trace.name == name:
            raise KeyboardInterrupt
        return verify_by(trace, *arguments, **named)  # type: ignore[arg-type]  # passed on

    return judge


def test_the_spec_is_compiled_once(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    real = specc.verifying.runs.program_for_verify

    def counted(path: Path, **named: bool) -> object:
        calls.append(path)
        return real(path, **named)

    monkeypatch.setattr(specc.verifying.runs, "program_for_verify", counted)
    outcomes: Iterator[object] = specc.verifying.runs.verify_each(
        ["good.csv", "bad.csv"], VDP, depth="verdict"
    )

    assert len(list(outcomes)) == 2
    assert calls == [Path(VDP)]
