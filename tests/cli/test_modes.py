"""Behaviors with modes at the command line: run, recorded, judged, and their claims."""

import json
from pathlib import Path

import pytest

from specc.cli import main

SPECS = Path(__file__).parents[2] / "specs"
PATROL = str(SPECS / "patrol.yaml")
LOGGED = """
fidelity: {tolerance: {x: 0.05 m, v: 0.05 m/s}, horizon: 1 s}
trace: {x: x, v: v, going: going, x1: x1, x2: x2, v1: v1, v2: v2}
"""
ZENO = """
specc: 1
kind: behavior
name: without_hysteresis
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: line}}
  to: {kind: discrete, values: [left, right], role: both, relates: {agent: base, environment: line}}
constants:
  pace: {value: 0.5, unit: m/s}
field:
  modes:
    of: to
    each:
      left: {formula: {x: -pace}, leave: [{when: x <= 0, to: right}]}
      right: {formula: {x: pace}, leave: [{when: x >= 0, to: left}]}
"""


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_a_run_names_its_modes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", PATROL, "-d", "20", "--start", "v=0.5"]) == 0

    text = capsys.readouterr().out
    assert text.splitlines()[-1] == "  going changed 3 times"
    assert text.splitlines()[-2].split() == ["going", "forward", "back"]


def test_a_run_as_json_says_when_modes_changed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", PATROL, "-d", "10", "--start", "v=0.5", "-f", "json"]) == 0

    [first, second] = json.loads(capsys.readouterr().out)["switches"]
    assert first == {"t": pytest.approx(3.0), "from": "forward", "to": "back"}
    assert second == {"t": pytest.approx(9.0), "from": "back", "to": "forward"}


@pytest.mark.parametrize("run", [["run.csv", "--spec", "patrol.yaml"], ["run.mcap"]])
def test_a_recorded_patrol_passes_although_its_velocity_jumps(
    run: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("patrol.yaml").write_text(Path(PATROL).read_text(encoding="utf-8") + LOGGED)
    assert main(["simulate", "patrol.yaml", "-d", "60", "--set", "v1=0.7", "-o", run[0]]) == 0
    capsys.readouterr()

    assert main(["verify", *run]) == 0

    assert "going changes" in capsys.readouterr().out


def test_two_modes_without_a_distance_are_doubted_and_chatter(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("zeno.yaml").write_text(ZENO)

    assert main(["check", "zeno.yaml"]) == 0
    assert capsys.readouterr().err.count("warning[S258]") == 2

    main(["simulate", "zeno.yaml", "-d", "5", "--start", "x=1"])
    assert "switches without end at t = 2 s, between left and right" in capsys.readouterr().out
