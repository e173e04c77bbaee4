"""A file that can't be read as a spec is told of wherever it is named, in the words of its own."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from compiler.architecture.compile import compile_architecture, wire_architecture
from compiler.check import check
from compiler.world.scenario import compile_scenario
from runtime.progress import in_silence
from spec_schema.diagnostics import Diagnostic, SpecError

PARTS = Path(__file__).parents[2] / "golden" / "bad" / "parts"

FAULTS: dict[str, Callable[[str], str]] = {
    "another kind": lambda text: text.replace("\nkind: ", "\nkind: robot_"),
    "no text": lambda _text: "",
    "no mapping": lambda _text: "- 1\n",
    "a key missing": lambda text: "".join(
        line for line in text.splitlines(keepends=True) if not line.startswith("name:")
    ),
    "an unknown key": lambda text: f"{text}\ncolour: red\n",
}
SHAPES = {
    "round": lambda text: text.replace("circle:", "round:", 1),
    "diff": lambda text: text.replace("differential:", "diff:", 1),
}
NAMED = {
    "body": "courier.yaml",
    "behavior": "seek.yaml",
    "arbiter": "safe_first.yaml",
    "architecture": "find_light.yaml",
    "world": "office.yaml",
}


def refused(make: Callable[[], object]) -> tuple[Diagnostic, ...]:
    with pytest.raises(SpecError) as caught:
        make()
    return caught.value.diagnostics


def told(found: tuple[Diagnostic, ...]) -> set[tuple[str, str]]:
    return {(each.code, each.message) for each in found}


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("kind", NAMED)
def test_a_file_s_mistakes_are_told_by_each_that_names_it(
    tmp_path: Path, kind: str, fault: str
) -> None:
    come_through(tmp_path, NAMED[kind], FAULTS[fault])


@pytest.mark.parametrize("fault", SHAPES)
def test_a_body_s_own_mistakes_are_told_by_each_that_names_it(tmp_path: Path, fault: str) -> None:
    come_through(tmp_path, NAMED["body"], SHAPES[fault])


def come_through(folder: Path, name: str, spoil: Callable[[str], str]) -> None:
    shutil.copytree(PARTS, folder, dirs_exist_ok=True)
    file, scenario = folder / name, folder / "first_light.yaml"
    architecture = folder / "find_light.yaml"
    file.write_text(spoil(file.read_text("utf-8")), "utf-8")
    own = told(check(file))

    assert own, "the file is sound"
    assert own <= told(check(scenario))
    assert own <= told(refused(lambda: compile_scenario(scenario, in_silence)))
    if file != folder / "office.yaml":
        assert own <= told(check(architecture))
        assert own <= told(refused(lambda: wire_architecture(architecture)))
        assert own <= told(refused(lambda: compile_architecture(architecture, in_silence)))


DOUBTS = {
    "courier.yaml": ("lamp: {senses: light", "lamp: {senses: light, height: 50 cm", "S338"),
    "find_light.yaml": ("period: 100 ms", "period: 33.3 ms", "S355"),
}


@pytest.mark.parametrize("name", DOUBTS)
def test_a_doubt_is_told_once_by_each_that_names_the_file(tmp_path: Path, name: str) -> None:
    shutil.copytree(PARTS, tmp_path, dirs_exist_ok=True)
    file, scenario = tmp_path / name, tmp_path / "first_light.yaml"
    architecture = tmp_path / "find_light.yaml"
    sound, doubtful, code = DOUBTS[name]
    file.write_text(file.read_text("utf-8").replace(sound, doubtful), "utf-8")
    one = "robots: {r: {architecture: find_light.yaml, at: [3, 1]}"
    text = scenario.read_text("utf-8").replace(one, one + one[8:].replace("{r:", ", other:", 1))
    scenario.write_text(text.replace("at: [3, 1]}, other", "at: [1, 1]}, other"), "utf-8")

    told_of = [
        check(scenario),
        check(architecture),
        compile_scenario(scenario, in_silence).warnings,
        compile_architecture(architecture, in_silence).warnings,
        wire_architecture(architecture).warnings,
    ]

    assert [[each.code for each in found].count(code) for found in told_of] == [1] * 5
