"""`specc check` of architectures: what was proved, in the words of `specc compile`."""

import json
from pathlib import Path

import pytest

from specc.cli import main

SPECS = Path(__file__).parents[2] / "specs"
FIND = str(SPECS / "architectures" / "find_light.yaml")
LAYERS = str(SPECS / "architectures" / "light_subsumption.yaml")
SCENARIO = str(SPECS / "scenarios" / "first_light.yaml")


def told(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    """The lines on standard error."""
    assert main(["check", *arguments]) == 0
    return capsys.readouterr().err.splitlines()


def test_check_tells_of_an_architecture_what_compile_tells(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compile", FIND, "-o", str(tmp_path / "find.specc")]) == 0
    *compiled, wrote = capsys.readouterr().err.splitlines()
    *checked, verdict = told(capsys, FIND)

    assert checked == compiled
    assert any(line.startswith("base.turn exclusive: ") for line in checked)
    assert wrote.startswith("wrote ")
    assert verdict.startswith("1 spec without mistakes; `specc compile` makes the tables")


def test_of_a_scenario_the_proofs_of_its_architectures_are_told(
    capsys: pytest.CaptureFixture[str],
) -> None:
    proofs = [line for line in told(capsys, FIND) if " exclusive: " in line]

    assert told(capsys, SCENARIO)[:-1] == [f"find_light: {line}" for line in proofs]


def test_of_many_files_nothing_is_told_but_where_it_is_wanted(
    capsys: pytest.CaptureFixture[str],
) -> None:
    behaviors = [str(SPECS / f"{name}.yaml") for name in ("van_der_pol", "avoid", "back_off")]

    [verdict] = told(capsys, *behaviors, LAYERS)
    assert verdict.startswith("4 specs without mistakes; `specc compile` makes the tables")
    assert "light_subsumption: base.turn priority" in told(capsys, FIND, LAYERS)
    assert "base.turn priority" in told(capsys, *behaviors, LAYERS, "--notes")
    assert told(capsys, LAYERS, "--no-notes") == ["1 spec without mistakes"]


def test_json_is_a_list_of_mistakes_until_more_is_wanted(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["check", FIND, "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out) == []
    assert main(["check", FIND, "--notes", "--format", "json"]) == 0
    record = json.loads(capsys.readouterr().out)

    assert record["mistakes"] == []
    [found] = record["architectures"]
    assert (found["name"], found["spec"]) == ("find_light", FIND)
    assert found["channels"] == {"base.speed": "exclusive", "base.turn": "exclusive"}
    assert set(found["proofs"]) == {"base.speed", "base.turn"}


def test_annotations_are_of_mistakes_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", FIND, "--notes", "--format", "github"]) == 0
    assert capsys.readouterr() == ("", "")
