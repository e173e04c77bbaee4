"""Recordings whose attachments or pictures of light were altered: told, and never a traceback."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from runtime.recording.foxglove import classes
from runtime.recording.nodes import CLOSE
from runtime.recording.scenario_run import recorded_run
from runtime.recording.tables import Field
from runtime.run import run
from spec_schema.diagnostics import SpecError
from specc.scenarios.replaying import replayed
from specc.verifying.recording import verify_run
from tests.runtime.first_light import first_light
from tests.specc.altered_recordings import Content, content_of, replaced, without, written
from verifier.architectures.log import open_run

SCENARIO = "first_light.scenario.json"
HAPPENED = "first_light.happened.json"
FIRST = ("requirements", 0, "formula")
WINDOW = (*FIRST, 1)


@pytest.fixture(scope="module")
def content(tmp_path_factory: pytest.TempPathFactory) -> Content:
    """The beginning of a run, with the light on the floor."""
    path = tmp_path_factory.mktemp("altered") / "run.mcap"
    path.write_bytes(recorded_run(run(first_light(0.3), light_every=0.2)))
    return content_of(path)


def codes(path: Path) -> tuple[str, str]:
    """What verify says of a recording, and what replay; empty where they use it."""
    found = []
    for use in (lambda: verify_run(path, depth="verdict"), lambda: replayed(path)):
        try:
            use()
            found.append("")
        except SpecError as error:
            found.append(error.diagnostics[0].code)
    return found[0], found[1]


def altered(content: Content, path: Path, name: str, data: bytes) -> Path:
    """The recording with another attachment of that name."""
    return written(content, path, {**content.attachments, name: data})


def test_what_is_written_again_as_it_was_is_used(content: Content, tmp_path: Path) -> None:
    assert codes(written(content, tmp_path / "x.mcap", content.attachments)) == ("", "")


@pytest.mark.parametrize(
    ("at", "value"),
    [
        (("step",), 0.0),
        (("step",), -1.0),
        (("step",), float("nan")),
        (("step",), 1e-300),
        (("step",), 0.0037),
        (("step",), 1e300),
        (("duration",), 1e300),
        (("duration",), 0.0),
        (("seed",), 1.5),
        (("beginnings",), [1]),
        (("about",), None),
        (("robots",), {"r": 1}),
        (("world", "arena"), []),
        (("world", "lights", 0, "on"), "nobody"),
        (("world", "lights", 0, "pose", "x"), 1e300),
        (("world", "things"), [{}]),
        (FIRST, []),
        ((*FIRST, 0, "margin"), None),
        ((*FIRST, 0, "margin"), "add add"),
        ((*FIRST, 0, "margin"), "r.clearance 1e999 sub"),
        ((*FIRST, 0, "operator"), "and"),
        ((*WINDOW, "operator"), "until"),
        ((*WINDOW, "operator"), "predicate"),
        ((*WINDOW, "first"), -5.0),
        ((*WINDOW, "first"), float("inf")),
        ((*WINDOW, "last"), -1.0),
        (("requirements", 0, "scale"), 0.0),
    ],
)
def test_what_no_scenario_says_is_told_as_damage(
    content: Content, tmp_path: Path, at: tuple[Any, ...], value: Any
) -> None:
    data = replaced(content.attachments[SCENARIO], at, value)

    assert codes(altered(content, tmp_path / "x.mcap", SCENARIO, data)) == ("V332", "V332")


def test_two_formulas_in_one_requirement_are_told_as_damage(
    content: Content, tmp_path: Path
) -> None:
    formula = json.loads(content.attachments[SCENARIO])["requirements"][0]["formula"]
    data = replaced(content.attachments[SCENARIO], FIRST, formula * 2)

    assert codes(altered(content, tmp_path / "x.mcap", SCENARIO, data)) == ("V332", "V332")


@pytest.mark.parametrize("key", ["step", "world", "requirements", "robots", "beginnings"])
def test_a_document_that_lacks_something_is_told_as_damage(
    content: Content, tmp_path: Path, key: str
) -> None:
    data = without(content.attachments[SCENARIO], (key,))

    assert codes(altered(content, tmp_path / "x.mcap", SCENARIO, data)) == ("V332", "V332")


@pytest.mark.parametrize("data", [b"[]", b"", b"\xff", b"[" * 20_000, b'{"format": 1}'])
def test_what_is_no_document_is_told_as_damage(
    content: Content, tmp_path: Path, data: bytes
) -> None:
    assert codes(altered(content, tmp_path / "x.mcap", SCENARIO, data)) == ("V332", "V332")
    assert codes(altered(content, tmp_path / "y.mcap", HAPPENED, data)) == ("", "V332")


def test_a_requirement_on_a_quantity_that_is_not_there_is_told_by_both(
    content: Content, tmp_path: Path
) -> None:
    data = content.attachments[SCENARIO].replace(b"r.clearance", b"r.clarence!")

    assert codes(altered(content, tmp_path / "x.mcap", SCENARIO, data)) == ("V394", "V394")


def test_an_architecture_under_another_name_is_told_by_both(
    content: Content, tmp_path: Path
) -> None:
    attachments = dict(content.attachments)
    attachments["q.specc"] = attachments.pop("r.specc")
    verified, replay = codes(written(content, tmp_path / "x.mcap", attachments))

    assert verified == "V394"
    assert replay in {"V332", "V394"}


def grid(**changes: Any) -> Callable[[bytes], bytes]:
    """A message of the light with other values."""

    def changed(data: bytes) -> bytes:
        made = classes()["Grid"].FromString(data)
        for key, value in changes.items():
            setattr(made, key, value)
        return bytes(made.SerializeToString())

    return changed


def narrow(data: bytes) -> bytes:
    """Cells without a width."""
    made = classes()["Grid"].FromString(data)
    made.cell_size.x = 0.0
    return bytes(made.SerializeToString())


@pytest.mark.parametrize(
    "light",
    [
        lambda data: data[: len(data) // 2],
        lambda data: b"\xff" * len(data),
        lambda _: b"",
        grid(column_count=0),
        grid(column_count=7919),
        grid(data=b""),
        grid(data=b"\xff" * 4, column_count=1),
        narrow,
    ],
)
def test_a_picture_of_light_that_was_altered_is_told(
    content: Content, tmp_path: Path, light: Callable[[bytes], bytes]
) -> None:
    path = written(content, tmp_path / "x.mcap", content.attachments, light)

    with pytest.raises(SpecError) as caught:
        replayed(path)
    assert [each.code for each in caught.value.diagnostics] == ["V332"]


def test_pictures_of_light_of_two_sizes_are_told(content: Content, tmp_path: Path) -> None:
    seen = []

    def shorter(data: bytes) -> bytes:
        seen.append(data)
        made = classes()["Grid"].FromString(data)
        rows = len(made.data) // made.row_stride - (len(seen) > 1)
        return grid(data=made.data[: rows * made.row_stride])(data)

    path = written(content, tmp_path / "x.mcap", content.attachments, shorter)

    assert codes(path) == ("", "V332")


def test_a_step_that_stamps_do_not_follow_moves_none_of_them(
    content: Content, tmp_path: Path
) -> None:
    path = written(content, tmp_path / "x.mcap", content.attachments)
    topic, fields = f"/r/{CLOSE}", [Field("clearance")]
    step = first_light().step

    told, own, other = (
        open_run(path, {topic: fields}, each).columns(topic, fields)[0]
        for each in (0.0, step, 2.0 * step)
    )
    assert own.tolist() == (np.arange(told.size) * step).tolist()
    assert other == pytest.approx(told, abs=1.1e-9)
