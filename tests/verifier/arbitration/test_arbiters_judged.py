"""A robot's decisions against an arbiter's spec: a real robot, planted faults, and laws."""

import csv
import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import specc
from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter
from runtime.arbitration.rules import Rules
from runtime.arrays import Array
from spec_schema.diagnostics import SpecError
from specc.reported import findings_in
from specc.verifying.trace import Verification
from verifier.arbitration.choosing import rule_chooser
from verifier.arbitration.comparisons import infix, opened
from verifier.arbitration.decisions import Decisions
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.reader import CHOICE
from verifier.arbitration.refitting import roundest
from verifier.arbitration.saying import reasons_of
from verifier.arbitration.shares import share_of, slowness_of
from verifier.report.arbitration import Arbitration, ThresholdStanding
from verifier.report.report import Interval, Verdict
from verifier.traces.trace import TICKS, Series, Trace

ROOT = Path(__file__).parents[3]
SPEC = ROOT / "specs/arbiters/keep_left_arbiter.yaml"
LOG = ROOT / "specs/recordings/scitos/wall_following.csv"


def scitos(folder: Path, near: float) -> Verification:
    """The recording of the SCITOS by the spec with another `near`."""
    path = folder / "arbiter.yaml"
    path.write_text(SPEC.read_text().replace("value: 0.4945", f"value: {near}"))
    return specc.verify(LOG, path)


def section(found: Verification) -> Arbitration:
    """What it says of decisions."""
    assert found.examination.arbitration is not None
    return found.examination.arbitration


def test_three_thresholds_explain_every_decision_of_a_physical_robot() -> None:
    found = specc.verify(LOG, SPEC)

    assert found.report.verdict is Verdict.PASS
    assert section(found).share.agreeing == section(found).share.decisions == 5456
    actions = [row["action"] for row in csv.DictReader(LOG.read_text().splitlines())]
    assert section(found).changes == sum(a != b for a, b in pairwise(actions))
    assert f"over {section(found).changes} changes of choice" in found.report.reasons[0]


def test_an_interval_that_ends_just_below_what_is_required_does_not_read_as_met() -> None:
    made = section(specc.verify(LOG, SPEC))
    just = replace(made.share, interval=Interval(0.97998, 1.0))

    (told,), _ = reasons_of(replace(made, share=just, changes=1), Verdict.INCONCLUSIVE)

    assert "over 1 change of choice (95 % interval 97.998 % to 100 %); 98 % is required" in told


def test_the_spec_of_the_robot_agrees_row_by_row_as_counted_apart() -> None:
    rows = list(csv.DictReader(LOG.read_text().splitlines()))
    agree = 0
    for row in rows:
        front, left = float(row["front"]), float(row["left"])
        slight = "Slight-Right-Turn" if left < 0.55 else "Move-Forward"
        other = "Slight-Left-Turn" if left > 0.9 else slight
        agree += row["action"] == ("Sharp-Right-Turn" if front <= 0.9 else other)

    assert (agree, len(rows)) == (5080, 5456)


def test_a_threshold_that_is_wrong_fails_and_the_diagnosis_says_which_and_where(
    tmp_path: Path,
) -> None:
    found = scitos(tmp_path, 0.55)
    near = next(t for t in section(found).thresholds if t.name == "near")

    assert found.report.verdict is Verdict.FAIL
    assert section(found).share.agreeing == 5080
    assert (near.interval.low, near.interval.high) == (0.494, 0.495)
    assert near.fitted == pytest.approx(0.4945)
    assert near.standing is ThresholdStanding.MOVED
    expected = "near is 0.494 to 0.495 m (spec 0.55 m): with that, all 5456 decisions agree"
    assert expected in found.report.reasons
    assert section(found).unexplained == 0


def test_a_rounded_threshold_passes_and_what_it_is_is_said_all_the_same(tmp_path: Path) -> None:
    found = scitos(tmp_path, 0.5)

    assert found.report.verdict is Verdict.PASS
    assert section(found).share.agreeing == 5411
    assert any("0.494 to 0.495 m" in each for each in section(found).sentences)


def test_every_form_of_report_tells_the_threshold(tmp_path: Path) -> None:
    found = scitos(tmp_path, 0.55)
    for kind in ("html", "json", "txt", "xml", "sarif"):
        specc.write_report(found, tmp_path / f"report.{kind}")
        assert "0.494" in (tmp_path / f"report.{kind}").read_text()

    record = json.loads((tmp_path / "report.json").read_text())
    assert record["arbitration"]["agreement"]["agreeing"] == 5080
    rules = [str(each.rule) for each in findings_in(found)]
    assert rules[:2] == ["decisions-differ", "threshold"]


def test_a_project_names_the_arbiter_of_its_logs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "a.csv").write_bytes(LOG.read_bytes())
    (tmp_path / "arbiter.yaml").write_bytes(SPEC.read_bytes())
    text = "specc: 1\nkind: project\nname: p\nspecs: []\ntraces: {'runs/*.csv': arbiter.yaml}\n"
    (tmp_path / "specc.yaml").write_text(text.replace("specs: []", "specs: [arbiter.yaml]"))
    monkeypatch.chdir(tmp_path)

    assert specc.verify("runs/a.csv").report.verdict is Verdict.PASS


# --- planted: robots whose arbiter is known

TWO = """
specc: 1
kind: arbiter
name: two
reads:
  ahead: {{unit: m, domain: [0, 3]}}
constants:
  near: {{value: {near}, unit: m}}
  margin: {{value: 0.2, unit: m}}
choices: [flee, go]
by:
  rules:
    - {{choose: flee, when: ahead < near, until: ahead > near + margin{lasts}}}
    - {{choose: go}}
trace: {{ahead: ahead, choice: choice}}
"""


def arbiter(folder: Path, near: float = 0.6, lasts: str = "") -> tuple[Arbiter, Path]:
    """Two choices with hysteresis."""
    path = folder / f"two_{near}.yaml"
    path.write_text(TWO.format(near=near, lasts=f", lasts: {lasts}" if lasts else ""))
    return compile_arbiter(path).arbiter, path


def log_of(
    robot: Arbiter, folder: Path, late: int = 0, wrong: float = 0.0, count: int = 4000
) -> Path:
    """A robot that decides by the runtime's own rules, while something comes and goes ahead."""
    rng = np.random.default_rng(5)
    drift = np.cumsum(rng.normal(size=count))
    ahead = (
        0.8
        + 0.55 * np.sin(0.07 * np.arange(count) + 0.2 * drift)
        + rng.normal(scale=0.03, size=count)
    )
    rules = Rules(robot)
    rules.reset(0)
    times = np.arange(count) * 0.1
    chosen = [
        int(np.argmax(rules.decide(np.array([a]), t))) for a, t in zip(ahead, times, strict=True)
    ]
    chosen = [chosen[max(0, i - late)] for i in range(count)]
    flipped = rng.random(count) < wrong
    names = [robot.choices[c if not f else 1 - c] for c, f in zip(chosen, flipped, strict=True)]
    path = folder / "log.csv"
    rows = [f"{t:.1f},{a:.6f},{c}" for t, a, c in zip(times, ahead, names, strict=True)]
    path.write_text("\n".join(["t,ahead,choice", *rows, ""]))
    return path


def test_hysteresis_is_carried_along(tmp_path: Path) -> None:
    robot, path = arbiter(tmp_path)
    found = specc.verify(log_of(robot, tmp_path), path)

    assert found.report.verdict is Verdict.PASS
    assert section(found).share.value == 1.0


def test_a_threshold_inside_a_hysteresis_is_refitted(tmp_path: Path) -> None:
    robot, _ = arbiter(tmp_path, near=0.5)
    _, path = arbiter(tmp_path, near=0.6)
    found = specc.verify(log_of(robot, tmp_path), path)
    near = next(t for t in section(found).thresholds if t.comparison == "ahead < near")

    assert found.report.verdict is Verdict.FAIL
    assert near.standing is ThresholdStanding.MOVED
    assert near.interval.low <= 0.5 <= near.interval.high
    assert near.interval.high - near.interval.low < 0.05


def test_a_robot_that_decides_late_is_told_by_how_much(tmp_path: Path) -> None:
    robot, path = arbiter(tmp_path)
    found = specc.verify(log_of(robot, tmp_path, late=3), path)

    assert section(found).delay == 3
    assert any("0.3 s (3 samples) after" in each for each in section(found).sentences)
    assert section(found).unexplained == 0


def test_decisions_by_chance_stay_unexplained(tmp_path: Path) -> None:
    robot, path = arbiter(tmp_path)
    found = specc.verify(log_of(robot, tmp_path, wrong=0.1), path)

    assert found.report.verdict is Verdict.FAIL
    assert section(found).delay == 0
    assert section(found).unexplained == pytest.approx(400, rel=0.25)
    assert all(t.standing is not ThresholdStanding.MOVED for t in section(found).thresholds)


def test_a_threshold_that_no_reading_comes_near_is_not_told(tmp_path: Path) -> None:
    _, path = arbiter(tmp_path)
    rows = [f"{0.1 * i:.1f},{2.0 + 0.1 * np.sin(i):.4f},go" for i in range(600)]
    log = tmp_path / "far.csv"
    log.write_text("\n".join(["t,ahead,choice", *rows, ""]))

    found = section(specc.verify(log, path))

    assert {t.standing for t in found.thresholds} == {ThresholdStanding.UNTOLD}


def test_a_log_without_the_choice_is_refused(tmp_path: Path) -> None:
    _, path = arbiter(tmp_path)
    log = tmp_path / "log.csv"
    log.write_text("t,ahead\n0,1\n1,1\n")

    with pytest.raises(SpecError) as error:
        specc.verify(log, path)
    assert [each.code for each in error.value.diagnostics] == ["V303"]


# --- laws

RULES = st.sampled_from(["", "0.25 s", "0.6 s"])


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(0, 1.5), min_size=2, max_size=60), RULES)
def test_what_is_chosen_is_what_the_runtime_chooses(
    tmp_path_factory: pytest.TempPathFactory, ahead: list[float], lasts: str
) -> None:
    spec, _ = arbiter(tmp_path_factory.mktemp("law"), lasts=lasts)
    runs = Rules(spec)
    runs.reset(0)
    times = np.arange(len(ahead)) * 0.1
    expected = [
        int(np.argmax(runs.decide(np.array([a]), t))) for a, t in zip(ahead, times, strict=True)
    ]
    constants = [np.full(times.size, constant.value) for constant in spec.constants]
    register: Array = np.stack([np.array(ahead), *constants], axis=1)
    judged = np.ones(times.size, dtype=np.bool_)
    decisions = Decisions(times, register, np.zeros(times.size, dtype=np.int64), judged, ())

    assert rule_chooser(spec, opened(spec))(decisions).tolist() == expected


def test_comparisons_are_found_on_either_side_and_written_as_read(tmp_path: Path) -> None:
    spec, _ = arbiter(tmp_path)

    assert [each.text for each in opened(spec).comparisons] == [
        "ahead < near",
        "ahead > near + margin",
    ]
    assert infix(opened(spec).comparisons[1].side) == "near + margin"


@pytest.mark.parametrize("stay", [0.0, 0.9])
def test_intervals_of_shares_hold_the_true_share_as_often_as_they_say(stay: float) -> None:
    """Of 300 logs whose disagreements come in runs of 1 / (1 - stay) decisions."""
    rng = np.random.default_rng(1)
    held, true, count = 0, 0.93, 3000
    for _ in range(300):
        fresh = rng.random(count) > stay
        drawn = rng.random(count) < true
        last = np.maximum.accumulate(np.where(fresh, np.arange(count), 0))
        interval = share_of(drawn[last], 1.0, 0.95).interval
        held += interval.low <= true <= interval.high

    assert held / 300 >= 0.91


def test_slowness_is_that_of_an_autoregressive_course() -> None:
    rng = np.random.default_rng(2)
    course = np.zeros(100_000)
    for i in range(1, course.size):
        course[i] = 0.8 * course[i - 1] + rng.normal()

    assert slowness_of(course) == pytest.approx((1 + 0.8) / (1 - 0.8), rel=0.1)
    assert slowness_of(rng.normal(size=10_000)) == pytest.approx(1.0, abs=0.1)


@given(st.floats(-5, 5), st.floats(1e-3, 2))
def test_a_round_number_lies_within(low: float, width: float) -> None:
    assert low < roundest((low, low + width), 1.0, low + 0.5 * width) < low + width


@pytest.mark.parametrize("moves", [False, True])
def test_an_arbiter_whose_threshold_is_set_by_another_is_judged_by_what_was_set(
    *, moves: bool
) -> None:
    arbiter = compile_arbiter(ROOT / "specs/arbiters/who_moves.yaml").arbiter
    chance = np.random.default_rng(1)
    times = np.arange(0.0, 200.0, 0.1)
    ahead = np.abs(np.cumsum(0.05 * chance.standard_normal(times.size))) % 1.0
    near = np.where(moves & (times % 20.0 > 10.0), 0.45, 0.3)
    wide = np.full(times.size, 2.0)
    rules = Rules(arbiter)
    rows = np.column_stack([ahead, wide, wide, near])
    chosen = [
        int(np.argmax(rules.decide(row, time))) for row, time in zip(rows, times, strict=True)
    ]
    columns = {"ahead": ahead, "left": wide, "right": wide, "near": near, CHOICE: chosen}
    series = {
        name: Series(name, times, np.asarray(each, float), name, TICKS)
        for name, each in columns.items()
    }

    found = judge_arbiter(arbiter, Trace("log", series, {}, 0.0, (), ())).section.share

    assert 0 < sum(chosen) < times.size
    assert found.agreeing == found.decisions == times.size
