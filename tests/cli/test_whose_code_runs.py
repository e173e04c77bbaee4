"""Whose code runs: a spec's Python leaves a mark where it is imported, and who may leave one."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from specc.cli import main

BODY = """
specc: 1
kind: body
name: disc
shape: {circle: 12 cm}
mass: 3 kg
friction: 0.2
drive: {differential: {track: 20 cm, speed: 0.5 m/s, turn: 3 rad/s}}
rest: {base.speed: stop}
sensors:
  ahead: {senses: range, reach: 2 m, width: 60 deg, rays: 3, every: 50 ms}
  odom: {senses: odometry, every: 50 ms}
"""
BEHAVIOR = """
specc: 1
kind: behavior
name: creep
state:
  v:
    unit: m/s
    domain: [-0.5, 0.5]
    role: both
    relates: {agent: middle of the base, environment: the floor}
  room:
    unit: m
    domain: [0, 2]
    role: sensed
    hold: 1
    relates: {agent: front of the base, environment: what is ahead}
field:
  module: {call: "sly:field", over: [v, room]}
table: {tolerance: {v: 1e-3 m/s^2}}
realizes: {v: base.speed as set-point}
fidelity: {tolerance: {v: 1 cm/s}, horizon: 1 s}
expect: [one attractor]
"""
ARCHITECTURE = """
specc: 1
kind: architecture
name: sneaks
body: disc.yaml
nodes:
  creep:
    behavior: creep.yaml
    period: 50 ms
    sense: {room: ahead.range, v: {from: odom.speed, outside: clip}}
  hurry:
    behavior: creep.yaml
    period: 50 ms
    sense: {room: ahead.range, v: {from: odom.speed, outside: clip}}
  mood:
    module: "sly:mood"
    period: 1 s
    sense: {room: ahead.range}
    tells: {courage: m}
  choose:
    arbiter: decides.yaml
    period: 50 ms
    sense: {room: {from: mood.courage, outside: clip}}
    choices: {go: [creep]}
channels:
  base.speed: {function: "sly:mix"}
"""
ARBITER = """
specc: 1
kind: arbiter
name: decides
reads: {room: {unit: m, domain: [0, 2]}}
choices: [go]
by: {module: "sly:choose"}
"""
WORLD = """
specc: 1
kind: world
name: room
arena: {box: [3 m, 3 m]}
"""
SCENARIO = """
specc: 1
kind: scenario
name: run
world: room.yaml
robots: {r: {architecture: sneaks.yaml, at: [1, 1]}}
duration: 2 s
"""
CODE = """
from pathlib import Path

Path(__file__).with_name("mark").touch()


def field(v, room):
    return {"v": room - 1.0 - v}


def mood(reads, time):
    return {"courage": 1.0}


def choose(reads, time):
    return "go"


def mix(wants):
    return sum(wants.values()) / len(wants)
"""


@pytest.fixture(scope="module")
def specs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The specs, their artifacts and recordings: of the behavior alone, and of the scenario."""
    folder = tmp_path_factory.mktemp("sly")
    texts = {
        "disc": BODY,
        "creep": BEHAVIOR,
        "sneaks": ARCHITECTURE,
        "room": WORLD,
        "run": SCENARIO,
        "decides": ARBITER,
    }
    for name, text in texts.items():
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    (folder / "sly.py").write_text(CODE, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        assert main(["simulate", "creep.yaml", "-o", "alone.mcap"]) == 0
        assert main(["simulate", "run.yaml", "--allow-code", "-o", "run.mcap"]) == 0
        assert main(["compile", "run.yaml", "--allow-code", "-o", "run.specc"]) == 0
        assert main(["compile", "creep.yaml", "-o", "creep.specc"]) == 0
    return folder


@pytest.fixture
def mark(specs: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The file that is there once the code has run."""
    monkeypatch.chdir(specs)
    left = specs / "mark"
    left.unlink(missing_ok=True)
    yield left
    left.unlink(missing_ok=True)


REFUSED = [
    "compile sneaks.yaml",
    "compile run.yaml",
    "compile sneaks.yaml --dump",
    "simulate run.yaml",
    "verify run.mcap --spec sneaks.yaml",
    "verify run.mcap --spec run.yaml",
    "verify run.mcap --spec creep.yaml",
    "verify run.mcap --spec run.yaml --allow-code",
    "verify alone.mcap --spec creep.yaml",
    "verify alone.mcap --spec creep.yaml --allow-code",
    "fit alone.mcap --spec creep.yaml",
    "fit alone.mcap",
    "check --claims creep.yaml",
]
IDLE = [
    "check creep.yaml",
    "check sneaks.yaml",
    "check run.yaml",
    "check sneaks.yaml --notes --format json",
    "wiring sneaks.yaml",
    "wiring sneaks.yaml --format json",
    "simulate creep.specc",
    "portrait creep.specc --set room=1",
    "compare creep.specc creep.specc",
    "verify alone.mcap",
    "verify run.mcap",
    "verify run.mcap --spec creep.specc",
    "verify run.mcap --spec run.specc",
    "replay run.mcap --poster poster.svg",
    "init again --from alone.mcap -o again.yaml",
]
RUN = [
    "compile creep.yaml",
    "compile sneaks.yaml --allow-code",
    "compile run.yaml --allow-code",
    "simulate run.yaml --allow-code",
    "simulate run.specc --allow-code",
    "simulate creep.yaml",
    "portrait creep.yaml --set room=1",
    "compare creep.yaml creep.specc",
    "check --claims --allow-code creep.yaml",
]


@pytest.mark.parametrize("command", REFUSED)
def test_code_that_is_not_allowed_is_refused_with_a_way_out(
    command: str, mark: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(command.split()) == 2

    told = capsys.readouterr().err
    assert "error[V336]" in told
    assert "creep.yaml:18:3" in told
    assert "help: " in told
    assert not mark.exists()


@pytest.mark.parametrize("command", IDLE)
def test_nothing_runs_where_nothing_needs_to(command: str, mark: Path) -> None:
    assert main(command.split()) in {0, 1, 4}
    assert not mark.exists()


def test_nodes_that_are_code_are_none_the_safer_in_an_artifact(
    mark: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "run.specc"]) == 2
    told = capsys.readouterr().err
    assert "error[V382]: sly:mood is code (sly.py), which is run only with --allow-code" in told
    assert not mark.exists()


def test_simulate_looks_for_code_beside_an_artifact_and_in_no_folder_that_it_names(
    specs: Path, mark: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    away = tmp_path / "run.specc"
    compiled = ["compile", str(specs / "run.yaml"), "--allow-code", "-o", str(away)]
    assert main(compiled) == 0  # which names the folder of the specs in full
    mark.unlink()
    simulate = ["simulate", str(away), "--duration", "0.1 s", "--allow-code"]

    assert main(simulate) == 2
    assert "sly can't be imported" in capsys.readouterr().err
    assert not mark.exists()

    (tmp_path / "sly.py").write_text(CODE, encoding="utf-8")
    assert main(simulate[:-1]) == 2
    assert f"sly:mood is code ({tmp_path / 'sly.py'})" in capsys.readouterr().err
    assert not (tmp_path / "mark").exists()

    assert main(simulate) in {0, 4}
    assert (tmp_path / "mark").exists()
    assert not mark.exists()


@pytest.mark.parametrize("command", RUN)
def test_code_that_is_meant_runs(command: str, mark: Path) -> None:
    assert main(command.split()) in {0, 4}
    assert mark.exists()


def test_verify_looks_for_code_beside_the_recording_and_in_no_folder_that_it_names(
    mark: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    away = tmp_path / "run.mcap"
    away.write_bytes((mark.parent / "run.mcap").read_bytes())
    verify = ["verify", str(away), "--quick", "--allow-code"]

    assert main(verify) in {0, 1, 4}
    assert "sly can't be imported" in "".join(capsys.readouterr())
    assert not mark.exists()

    (tmp_path / "sly.py").write_text(CODE, encoding="utf-8")
    assert main(verify[:-1]) in {0, 1, 4}
    told = "".join("".join(capsys.readouterr()).split())
    assert "".join(f"sly:choose is code ({tmp_path / 'sly.py'})".split()) in told
    assert not (tmp_path / "mark").exists()

    assert main(verify) in {0, 1, 4}
    assert (tmp_path / "mark").exists()
    assert not mark.exists()


def test_verify_takes_code_beside_an_artifact_that_is_named(mark: Path, tmp_path: Path) -> None:
    artifact = tmp_path / "run.specc"
    artifact.write_bytes((mark.parent / "run.specc").read_bytes())
    verify = ["verify", "run.mcap", "--quick", "--allow-code", "--spec"]

    assert main([*verify, str(artifact)]) in {0, 1, 4}
    assert not mark.exists()
    assert main([*verify, "run.specc"]) in {0, 1, 4}
    assert mark.exists()
