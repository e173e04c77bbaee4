"""A first spec says of each variable what it is; it checks, and a verdict can be made with it."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from compiler.check import check
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import SpecError
from spec_schema.load import load
from specc.first_spec import beginnings
from specc.first_spec.sets import FIRST
from specc.first_spec.written import spec_for
from specc.verifying.trace import verify
from verifier.traces.inventory import FieldInfo, Inventory, TopicInfo, inspect
from verifier.traces.trace import Loss

TIMES = [0.05 * i for i in range(600)]


def angle(turns: float, half: float) -> float:
    return (turns + 0.5) % 1.0 * 2.0 * half - half


def first_spec(folder: Path, columns: Mapping[str, Callable[[float], object]]) -> Path:
    """The path of the spec for a CSV log of these columns; it has no mistakes."""
    log, spec = folder / "run.csv", folder / "run.yaml"
    rows: list[list[object]] = [
        ["time", *columns],
        *([t, *(of(t) for of in columns.values())] for t in TIMES),
    ]
    log.write_text("\n".join(",".join(map(str, row)) for row in rows))
    spec.write_text(spec_for(inspect(log), "run"))
    assert check(spec) == ()
    return spec


def behavior(path: Path) -> BehaviorSpec:
    spec = load(path).spec
    assert isinstance(spec, BehaviorSpec)
    return spec


BASE: dict[str, Callable[[float], object]] = {
    "x": math.cos,
    "y": math.sin,
    "theta": lambda t: angle(t / (2 * math.pi) + 0.25, math.pi),
    "v_cmd": lambda t: 1.0 if t < 20 else 0.5,
    "mode": lambda t: int(t / 10),
}


def test_a_base_in_columns_has_an_angle_a_command_and_a_mode(tmp_path: Path) -> None:
    spec = behavior(path := first_spec(tmp_path, BASE))

    assert list(spec.state) == ["x", "y", "heading", "mode"]
    assert {name: str(state.kind) for name, state in spec.state.items()} == {
        "x": "continuous",
        "y": "continuous",
        "heading": "periodic",
        "mode": "discrete",
    }
    assert list(spec.control) == ["speed"]
    text = path.read_text()
    assert "speed: v_cmd" in text
    assert "it jumps by a turn 5 times" in text
    assert "by its name a command" in text
    assert str(verify(tmp_path / "run.csv", path, depth="verdict").report.verdict)


def test_a_turn_rate_in_degrees_turns_a_heading_in_degrees(tmp_path: Path) -> None:
    columns = {
        **BASE,
        "theta": lambda t: angle(t / (2 * math.pi) + 0.25, 180.0),
        "omega": lambda _t: math.degrees(1.0),
        "v_cmd": lambda _t: 1.0,
    }
    path = first_spec(tmp_path, columns)

    report = verify(tmp_path / "run.csv", path, depth="verdict").report
    assert "unit: deg/s" in path.read_text()
    assert all(each.declared.departure < 0.02 for each in report.variables)


@pytest.mark.parametrize(
    ("column", "entry"),
    [
        (lambda t: ["idle", "go", "stop"][int(t) % 3], "door: door"),
        (lambda t: ["Ready!", "go"][int(t) % 2], "'Ready!': ready"),
        (lambda t: 1 + int(t) % 2, "offset: -1"),
    ],
)
def test_what_takes_a_few_values_is_discrete(
    column: Callable[[float], object], entry: str, tmp_path: Path
) -> None:
    path = first_spec(tmp_path, {"level": math.sin, "door": column})

    assert str(behavior(path).state["door"].kind) == "discrete"
    assert entry in path.read_text()
    assert not verify(tmp_path / "run.csv", path, depth="verdict").report.losses


@pytest.mark.parametrize(
    "column", [lambda t: int(100 * t), lambda t: 0.5 * (int(t) % 3), lambda t: 40 * (int(t) % 3)]
)
def test_other_numbers_are_not(column: Callable[[float], object], tmp_path: Path) -> None:
    path = first_spec(tmp_path, {"level": math.sin, "door": column})

    assert str(behavior(path).state["door"].kind) == "continuous"


def test_a_sawtooth_that_is_no_turn_is_no_angle(tmp_path: Path) -> None:
    path = first_spec(tmp_path, {"level": lambda t: t % 1.0, "heat": lambda t: 50 * (t % 3.0)})

    assert {str(state.kind) for state in behavior(path).state.values()} == {"continuous"}


def test_commands_come_before_what_the_robot_measures() -> None:
    pose = ["position.x", "position.y", "orientation.@yaw"]
    fields = {
        "/cmd_vel": ["linear.x", "angular.z"],
        "/goal_pose": [f"pose.{end}" for end in pose],
        "/odom": [f"pose.pose.{end}" for end in pose],
        "/wheels": ["twist.linear.x", "twist.angular.z"],
    }
    topics = tuple(
        TopicInfo(name, "", "cdr", 9, 10.0, 1.0, tuple(measured(f"{name}.{e}") for e in ends), "")
        for name, ends in fields.items()
    )
    found = Inventory("run.mcap", "MCAP", 0.0, 1.0, 36, 1000, "", topics, (), ())

    text = spec_for(found, "run")

    assert "x: /odom.pose.pose.position.x" in text
    assert "speed: /cmd_vel.linear.x" in text
    assert "turn: /cmd_vel.angular.z" in text


def measured(path: str) -> FieldInfo:
    return FieldInfo(path, 0.0, -1.0, 1.0, ())


def test_a_log_in_which_nothing_changes_is_told(tmp_path: Path) -> None:
    log = tmp_path / "run.csv"
    log.write_text("t,x\n0,1\n1,1\n2,1\n")

    with pytest.raises(SpecError, match=r"(?s)V344.*no number that changes"):
        spec_for(inspect(log), "run")


def test_a_log_without_a_readable_message_is_told_with_what_was_lost() -> None:
    losses = (Loss("torn chunk", 2, "at byte 40"),)
    found = Inventory("run.mcap", "MCAP", 0.0, 0.0, 0, 1000, "", (), losses, ())

    with pytest.raises(SpecError, match=r"(?s)V306.*no message.*torn chunk: 2 \(at byte 40\)"):
        spec_for(found, "run")


@pytest.mark.parametrize("template", FIRST)
def test_the_first_spec_of_each_kind_stands_in_one_folder_and_has_no_mistakes(
    tmp_path: Path, template: str
) -> None:
    own = beginnings.from_template(template, "own")
    files = {"own.yaml": own, **beginnings.companions(template)}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")

    spec = load(tmp_path / "own.yaml").spec
    kind = "scenario" if template == "training" else template
    assert (spec.kind, spec.name) == (kind, "own")
    untrained = {"S390"} if template == "training" else set()
    for name in files:
        assert {found.code for found in check(tmp_path / name)} <= untrained


def test_the_first_scenario_brings_each_kind_that_it_takes(tmp_path: Path) -> None:
    for name, text in beginnings.companions("scenario").items():
        (tmp_path / name).write_text(text, encoding="utf-8")

    kinds = {load(path).spec.kind for path in tmp_path.iterdir()}
    assert kinds == {"architecture", "arbiter", "behavior", "body", "world"}


def test_templates_of_every_kind_are_listed_and_one_that_is_not_there_is_guessed() -> None:
    listed = {line.split()[0] for line in beginnings.list_templates().splitlines()}

    assert set(FIRST) < listed
    with pytest.raises(SpecError, match="scenario"):
        beginnings.from_template("scenaro", "own")
