"""Arbiters that are no rules against logs: planted constants found again; code; many logs."""

from pathlib import Path

import numpy as np
import pytest

import specc
from compiler.architecture.arbiters import compile_arbiter
from runtime.arbitration.build import arbiter_of
from runtime.arrays import Array
from runtime.user_code import load_callee
from spec_schema.diagnostics import SpecError
from specc.cli import main
from specc.verifying.runs import verify_together
from specc.verifying.trace import Verification
from verifier.report.arbitration import Arbitration, ThresholdStanding
from verifier.report.report import Verdict

HEAD = """
specc: 1
kind: arbiter
name: {name}
reads: {{ahead: {{unit: m, domain: [0, 2]}}}}
constants: {{near: {{value: {near}, unit: m}}}}
choices: [flee, go]
by: {by}
agreement: {{share: 0.9}}
trace: {{ahead: ahead, choice: choice}}
"""
KINDS = {
    "rules": "{rules: [{choose: flee, when: ahead < near}, {choose: go}]}",
    "weights": '{weights: {flee: "exp(-ahead / near)", go: "1 - exp(-ahead / near)"}}',
    "competition": (
        '{competition: {advantage: {flee: "tanh((near - ahead) / near)", go: "0.3"},'
        " suppresses: {flee: {go: 2}}, time: 0.1 s, noise: 0.05}}"
    ),
    "plan": "{plan: modes.yaml}",
    "module": '{module: "deciding:choose"}',
}
MODES = """
specc: 1
kind: behavior
name: modes
state:
  ahead: {unit: m, domain: [0, 2], role: sensed, relates: {agent: front, environment: thing}}
  haste: {unit: "1", domain: [0, 1], role: driven, relates: {agent: pace, environment: thing}}
  doing: {kind: discrete, values: [flee, go], role: both, relates: {agent: aim, environment: thing}}
constants:
  near: {value: NEAR, unit: m}
  far: {value: 1, unit: m}
  pace: {value: 0.1, unit: 1/(m*s)}
field:
  modes:
    of: doing
    each:
      go: {formula: {haste: -pace * ahead}, leave: [{when: ahead <= near, to: flee}]}
      flee: {formula: {haste: pace * ahead}, leave: [{when: ahead >= far, to: go}]}
"""
CODE = """
def choose(reads, time):
    return {"flee": 1.0, "go": 0.0} if reads["ahead"] < NEAR else {"flee": 0.0, "go": 1.0}
"""


def spec_of(folder: Path, kind: str, near: float) -> Path:
    """An arbiter of that kind."""
    folder.mkdir(exist_ok=True)
    (folder / "modes.yaml").write_text(MODES.replace("NEAR", str(near)))
    (folder / "deciding.py").write_text(CODE.replace("NEAR", str(near)))
    path = folder / "arbiter.yaml"
    path.write_text(HEAD.format(name=kind, near=near, by=KINDS[kind]))
    return path


def log_of(spec: Path, log: Path, count: int = 900, seed: int = 4) -> Path:
    """What a robot with that arbiter decides while something comes and goes."""
    rng = np.random.default_rng(seed)
    course = np.zeros(count)
    for i in range(1, count):
        course[i] = 0.9 * course[i - 1] + rng.normal(scale=0.2)
    ahead: Array = np.clip(0.7 + course, 0.02, 1.98).round(3)
    robot = compile_arbiter(spec).arbiter
    running = arbiter_of(robot, robot.name, 0.1, lambda text: load_callee(text, spec.parent))
    running.reset(0)
    rows = []
    for i, value in enumerate(ahead.tolist()):
        numbers = running.decide(np.array([value]), 0.1 * i)
        chosen = robot.choices[int(np.argmax(numbers))] if numbers.max() > 0.0 else ""
        rows.append(f"{0.1 * i:.1f},{value},{chosen}")
    log.write_text("\n".join(["t,ahead,choice", *rows, ""]))
    return log


def section(found: Verification) -> Arbitration:
    """What it says of decisions."""
    assert found.examination.arbitration is not None
    return found.examination.arbitration


@pytest.mark.parametrize("kind", ["weights", "competition", "plan"])
def test_a_faithful_robot_agrees_in_every_decision(tmp_path: Path, kind: str) -> None:
    spec = spec_of(tmp_path, kind, 0.5)

    found = specc.verify(log_of(spec, tmp_path / "log.csv"), spec)

    assert section(found).share.value == 1.0
    assert found.report.verdict is Verdict.PASS


@pytest.mark.parametrize("kind", ["weights", "competition"])
def test_a_planted_constant_is_found_again(tmp_path: Path, kind: str) -> None:
    robot = spec_of(tmp_path / "robot", kind, 0.5)
    spec = spec_of(tmp_path / "spec", kind, 0.9)

    found = specc.verify(log_of(robot, tmp_path / "log.csv", count=600), spec)

    assert found.report.verdict is Verdict.FAIL
    (near,) = section(found).thresholds
    assert (near.name, near.standing) == ("near", ThresholdStanding.MOVED)
    assert near.interval.low <= 0.5 <= near.interval.high
    assert near.interval.high - near.interval.low < 0.1
    assert section(found).unexplained < 0.02 * section(found).share.decisions
    assert any("near is 0." in each and "(spec 0.9 m)" in each for each in found.report.reasons)


def test_a_plan_with_another_number_fails(tmp_path: Path) -> None:
    robot = spec_of(tmp_path / "robot", "plan", 0.5)
    spec = spec_of(tmp_path / "spec", "plan", 0.2)

    found = specc.verify(log_of(robot, tmp_path / "log.csv", count=3000), spec)

    assert found.report.verdict is Verdict.FAIL
    assert "robot chooses flee" in " ".join(found.report.reasons)


def test_an_arbiter_that_is_code_is_judged_where_that_is_allowed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = spec_of(tmp_path / "robot", "module", 0.5)
    spec = spec_of(tmp_path / "spec", "module", 0.9)
    log = log_of(robot, tmp_path / "log.csv")

    with pytest.raises(SpecError) as error:
        specc.verify(log, robot)
    assert error.value.diagnostics[0].code == "V336"
    assert specc.verify(log, robot, allow_code=True).report.verdict is Verdict.PASS
    assert specc.verify(log, spec, allow_code=True).report.verdict is Verdict.FAIL
    assert main(["verify", str(log), "--spec", str(robot), "--allow-code"]) == 0
    capsys.readouterr()
    (robot.parent / "deciding.py").write_text("def choose(reads, time):\n    return 1 / 0\n")
    with pytest.raises(SpecError) as broken:
        specc.verify(log, robot, allow_code=True)
    assert broken.value.diagnostics[0].code == "V382"


def test_logs_that_are_short_decide_together(tmp_path: Path) -> None:
    spec = spec_of(tmp_path, "rules", 0.5)
    spec.write_text(spec.read_text().replace("share: 0.9", "share: 0.98"))
    logs = [log_of(spec, tmp_path / f"{i}.csv", count=125, seed=i) for i in range(8)]

    runs = verify_together(logs, spec)

    alone = [specc.verify(log, spec) for log in logs]
    assert all(each.report.verdict is Verdict.INCONCLUSIVE for each in alone)
    (pool,) = runs.pools
    assert pool.report.verdict is Verdict.PASS
    assert runs.verdict is Verdict.PASS
    together = pool.examination.arbitration
    assert together is not None
    assert (together.share.agreeing, together.share.decisions) == (1000, 1000)
    (near,) = together.thresholds
    ends = [section(each).thresholds[0].interval for each in alone]
    assert near.interval.low == max(each.low for each in ends)
    assert near.interval.high == min(each.high for each in ends)


def test_a_log_that_is_there_twice_counts_once(tmp_path: Path) -> None:
    spec = spec_of(tmp_path, "rules", 0.5)
    logs = [log_of(spec, tmp_path / f"{i}.csv", count=125, seed=i) for i in range(2)]
    copy = tmp_path / "copy.csv"
    copy.write_bytes(logs[0].read_bytes())

    (pool,) = verify_together([*logs, copy], spec).pools

    assert pool.examination.arbitration is not None
    assert pool.examination.arbitration.share.decisions == 250
    assert pool.report.reasons[-1] == f"{copy} is left out: it is there twice"
    (only,) = verify_together([logs[0], copy], spec).pools
    assert only.examination.arbitration is not None
    assert only.examination.arbitration.share.decisions == 125
    assert only.report.trace.source == "1 recording"


def test_logs_of_robots_that_differ_contradict_one_another(tmp_path: Path) -> None:
    spec = spec_of(tmp_path / "spec", "rules", 0.5)
    robots = [spec_of(tmp_path / f"robot{near}", "rules", near) for near in (0.4, 0.7)]
    logs = [log_of(robot, tmp_path / f"{i}.csv") for i, robot in enumerate(robots)]

    (pool,) = verify_together(logs, spec).pools

    assert pool.report.verdict is Verdict.FAIL
    assert any("contradict one another about near" in each for each in pool.report.reasons)


def test_a_log_that_is_too_short_says_how_long_would_do(tmp_path: Path) -> None:
    spec = spec_of(tmp_path, "rules", 0.5)
    spec.write_text(spec.read_text().replace("share: 0.9", "share: 0.98"))
    short = specc.verify(log_of(spec, tmp_path / "short.csv", count=250), spec)

    (advice,) = short.report.advice
    wanted = int(advice.split(" decisions")[0].removeprefix("about "))
    assert 250 < wanted < 3000
    long = specc.verify(log_of(spec, tmp_path / "long.csv", count=2 * wanted), spec)
    assert long.report.verdict is Verdict.PASS
