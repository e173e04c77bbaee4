"""Explanations that leave the same trace: which one is edited, and when none is."""

import math
from pathlib import Path

import pytest

import specc
from spec_schema.editing.edits import NewNumber
from specc.fitting.aims import Aim, Aims, named
from specc.fitting.explanations import Explanation
from specc.fitting.fit_text import fit_text
from specc.fitting.fitted import Outcome
from specc.fitting.moves import Move
from specc.fitting.pooling import pooled
from specc.fitting.weighing import Weighed, as_good, passed_over
from verifier.report.report import Verdict

TANK = """specc: 1
kind: behavior
name: tank
state:
  temp: {unit: K, domain: [280, 360], role: both, relates: {agent: water, environment: zero}}
  heater:
    {kind: discrete, values: [off, heating], role: both, relates: {agent: relay, environment: grid}}
control:
  room: {unit: K, domain: [270, 310], default: 293}
constants:
  loss: {value: 0.05, unit: 1/s}
  power: {value: 3, unit: K/s}
  low: {value: 320, unit: K}
  high: {value: 330, unit: K}
field:
  modes:
    of: heater
    each:
      off: {formula: {temp: -loss*(temp - room)}, leave: [{when: temp <= low, to: heating}]}
      heating: {formula: {temp: power - loss*(temp - room)}, leave: [{when: temp >= high, to: off}]}
fidelity: {tolerance: {temp: 0.5 K}, horizon: 3 s}
trace:
  temp: temp
  heater: heater
  room: {constant: 293}
"""


def tank(path: Path, *, loss: float = 0.05, seen: float = 0.0) -> Path:
    """60 s at 20 Hz of a tank between 320 and 330 K, whose thermometer reads `seen` too much.

    Exact: towards 293 K, and 3/loss above it while heated, by exp(-loss dt) a step of 1 ms.
    """
    keep, temp, heated, rows = math.exp(-0.001 * loss), 325.0, True, ["t,temp,heater"]
    for i in range(60_000):
        if i % 50 == 0:
            noise = 0.05 * math.sqrt(2.0) * math.sin(1.7 * i * i)
            rows.append(f"{i / 1000},{temp + seen + noise},{'heating' if heated else 'off'}")
        rest = 293.0 + (3.0 / loss if heated else 0.0)
        temp = rest + (temp - rest) * keep
        heated = temp < 330.0 if heated else temp <= 320.0
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    return path


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "tank.yaml"
    path.write_text(TANK, encoding="utf-8")
    return path


def test_one_sensor_that_reads_too_much_is_no_three_numbers_that_moved(
    tmp_path: Path, spec: Path
) -> None:
    """2 K too much everywhere looks like a room, a low and a high 2 K higher: 3 edits, not 1."""
    found = specc.fit(tank(tmp_path / "run.csv", seen=2.0), spec)

    [move] = found.moves
    assert (found.outcome, move.name) == (Outcome.MOVED, "offset of temp")
    assert float(move.new.removesuffix(" K")) == pytest.approx(-2.0, abs=0.06)
    assert found.after[0].verdict is Verdict.PASS
    assert any("3 edits (room, low and high)" in said for said in found.instead)
    assert "what explains it less well" in fit_text(found)


def test_a_declared_value_stays_where_another_number_explains_as_well(
    tmp_path: Path, spec: Path
) -> None:
    """A loss 10 % higher looks like a colder room in one narrow range of temperatures."""
    found = specc.fit(tank(tmp_path / "run.csv", loss=0.055), spec, anyway=True)

    [move] = found.moves
    assert move.name == "loss"
    assert float(move.new) == pytest.approx(0.055, abs=0.0003)


def way(label: str, edits: int, gain: float, left: str = "", *, declared: bool = False) -> Weighed:
    moves = tuple(
        Move(f"{label}{k}", "1", "2", "", f"{label}{k}", "", NewNumber(("constants", label), "2"))
        for k in range(edits)
    )
    explained = Explanation(label, f"{label} is so", (), gain, "", declared)
    return Weighed(explained, moves, (), (left,) if left else ())


def labels(found: tuple[Weighed, ...]) -> list[str]:
    return [each.explanation.label for each in found]


def test_what_leaves_something_is_out_then_edits_count_then_held_out_windows() -> None:
    three, one = way("three", 3, 90.0), way("one", 1, 80.0)
    near, far = way("near", 1, 78.0), way("far", 1, 60.0)
    open_ = way("open", 1, 99.0, left="temp would still depart")

    assert labels(as_good([three, one, near, far, open_])) == ["one", "near"]
    assert labels(as_good([three, open_])) == ["three"]
    assert as_good([open_]) == ()
    assert len(passed_over([three, one, far, open_], one)) == 3


def test_what_the_spec_declares_for_the_log_comes_last() -> None:
    assert labels(as_good([way("room", 1, 80.0, declared=True), way("loss", 1, 79.0)])) == [
        "loss",
        "room",
    ]


def test_recordings_of_two_robots_are_told_by_name() -> None:
    """One that agrees with the spec has a say: the others need another number than it."""
    kp = Aim(("constants", "kp", "value"), "kp", 17.6, 0.2, "1/s^2", 1.0, "")
    same = Aim(kp.path, "kp", 16.05, 0.2, "1/s^2", 1.0, "")
    told = [named(Aims((kp,)), "b.csv"), named(Aims((kp,)), "c.csv")]

    assert not pooled(told).contradicts
    found = pooled([named(Aims((), witnesses=(same,)), "a.csv"), *told])

    assert found.contradicts
    assert "2 groups (16.1 in a.csv; 17.6 in b.csv and c.csv)" in found.choices[0]
    assert found.aims[0].value == pytest.approx(17.6)  # type: ignore[union-attr]
