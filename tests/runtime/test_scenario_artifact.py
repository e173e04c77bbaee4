"""The artifact of a scenario: it runs as the scenario does, and nothing in it can be altered."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from compiler.world.scenario import compile_scenario
from runtime.container import ArtifactError, Member, join, split
from runtime.run import run
from runtime.scenario_artifact import from_bytes, is_scenario, to_bytes
from specc.cli import main
from tests.runtime.first_light import FILE, first_light, whole


@pytest.fixture(scope="module")
def data() -> bytes:
    return to_bytes(whole())


def test_what_is_read_back_runs_as_the_scenario_does(data: bytes) -> None:
    read = dataclasses.replace(from_bytes(data), duration=1.0, seed=3)

    assert run(read).digest == run(first_light(1.0)).digest
    assert read.requirements == whole().requirements


def test_compiled_again_it_has_the_same_bytes(data: bytes) -> None:
    again = compile_scenario(FILE, lambda _what, _done, _of: None).scenario

    assert to_bytes(again) == data
    assert to_bytes(from_bytes(data)) == data
    assert is_scenario(data)


def test_more_heights_than_can_be_told_apart_are_refused() -> None:
    made = whole()
    thing = made.world.things[0]
    stairs = tuple(
        dataclasses.replace(thing, name=f"s{i}", low=2.0 * i, high=2.0 * i + 1.0) for i in range(33)
    )
    world = dataclasses.replace(made.world, things=stairs)

    with pytest.raises(ArtifactError, match="more ranges of height"):
        to_bytes(dataclasses.replace(made, world=world))


def test_two_robots_share_one_architecture() -> None:
    (robot,) = whole().robots
    two = dataclasses.replace(whole(), robots=(robot, dataclasses.replace(robot, name="s")))

    made = to_bytes(two)

    assert [name for name, _ in split(memoryview(made))][1:] == ["architectures/0.specc"]
    assert [one.name for one in from_bytes(made).robots] == ["r", "s"]


def test_what_was_cut_or_altered_is_refused(data: bytes) -> None:
    chance = np.random.default_rng(5)
    for _ in range(60):
        at = int(chance.integers(len(data)))
        altered = bytearray(data)
        altered[at] ^= 1 << int(chance.integers(8))
        for wrong in (data[:at], bytes(altered)):
            with pytest.raises(ArtifactError):
                from_bytes(wrong)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        (b'"architecture": 0', b'"architecture": 1', "lacks the architecture of 'r'"),
        (b'"step": 0.0', b'"step": 0.9', "no multiple of the step"),
        (b'"duration": 60.0', b'"duration": -6.0', "no step or no duration"),
        (b'"format": 2', b'"format": 1', "this version reads 2"),
    ],
)
def test_a_document_that_does_not_fit_is_refused(
    data: bytes, old: bytes, new: bytes, why: str
) -> None:
    document, *others = split(memoryview(data))
    changed = bytes(document.content).replace(old, new)
    assert changed != document.content

    with pytest.raises(ArtifactError, match=why):
        from_bytes(join([Member(document.name, memoryview(changed)), *others]))


def test_compiled_and_simulated_it_leaves_the_same_recording(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)

    assert main(["compile", str(FILE)]) == 0
    from_spec = main(["simulate", str(FILE), "-d", "0.2", "-o", "a.mcap"])
    assert main(["simulate", "first_light.specc", "-d", "0.2", "-o", "b.mcap"]) == from_spec
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()

    assert main(["portrait", "first_light.specc"]) == 2
    assert main(["wiring", "first_light.specc"]) == 2
    assert main(["compile", "first_light.specc"]) == 2
    told = capsys.readouterr().err
    assert "artifact of a scenario, and that of a behavior belongs here" in told
    assert "artifact of a scenario, and that of an architecture belongs here" in told
    assert "compiled already" in told


def test_what_is_compiled_with_something_else_says_with_what(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    specs = FILE.parents[1]
    monkeypatch.chdir(tmp_path)

    assert main(["compile", str(specs / "worlds" / "office.yaml")]) == 2
    assert "a world, which is compiled with the scenario" in capsys.readouterr().err
    assert main(["compile", str(specs / "architectures" / "find_light.yaml"), "--dump"]) == 0
    assert "control modules, level 1" in capsys.readouterr().out
    assert main(["simulate", str(specs / "architectures" / "find_light.yaml")]) == 2
    assert "runs in a scenario" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
