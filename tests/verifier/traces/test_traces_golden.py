"""Logs that can't be used for a spec, and what is said: pairs in `tests/golden/bad_logs`.

The first line of each spec names its log. After a change of a message:
`pytest tests/verifier/traces/test_traces_golden.py --bless`, and read the diff.
"""

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from compiler.compile_file import compile_file
from spec_schema.diagnostics import SpecError
from verifier.traces.read import read_trace

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "tests" / "golden" / "bad_logs"
BAD = sorted(FOLDER.glob("*.yaml"))
HEAD = re.compile(r"# log: (?P<log>\S+)(?:  clock: (?P<clock>\w+))?(?P<strict>  strict)?\n")

CSV = "t,x,y,broken,action\n" + "".join(f"{i / 10},{i},{i},nan,go\n" for i in range(20))


@pytest.fixture
def logs(workshop: Any, make: Any) -> Path:
    """The folder with the logs that the specs name."""
    notes = [
        workshop.cdr("/odom", 5.0 + i, workshop.odometry(5.0 + i, x=float(i))) for i in range(20)
    ]
    notes += [make.said("/other", 5.0 + i, y=float(i)) for i in range(20)]
    notes += [make.note("/proto", 5.0, b"\x08\x01", "flatbuffer", "made.Y", "flatbuffer")]
    notes += [make.note("/custom", 5.0, bytes(12), "cdr")]
    workshop.mcap(notes, "drive.mcap", silent=("/silent",))
    whole = workshop.mcap(notes[:20], "corrupt.mcap", chunk_size=1 << 20)
    # Its only chunk holds all messages; the index behind it still knows the topic.
    workshop.text(whole.read_bytes().replace(b"base", b"esab"), "corrupt.mcap")
    workshop.mcap([], "silent.mcap", silent=("/odom",))
    workshop.text("", "empty.mcap")
    workshop.text(b"\x89PNG\r\n\x1a\n" + bytes(50), "picture.png")
    workshop.text(CSV, "drive.csv")
    workshop.text(CSV.replace("t,x", "u,x"), "untimed.csv")
    workshop.text("t,x,y\n" + "".join(f"{i},{i},{i}\n" for i in range(20)) + "20,2", "torn.csv")
    workshop.text(CSV.split("\n", 1)[1], "headless.csv")
    folder: Path = workshop.folder
    return folder


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_log_that_cannot_be_used_is_explained(
    path: Path,
    logs: Path,
    expect: Callable[[Path, str], None],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shutil.copy(path, logs)
    monkeypatch.chdir(logs)
    head = HEAD.match(path.read_text(encoding="utf-8"))
    assert head is not None
    compiled = compile_file(Path(path.name), lambda *_: None)

    clock: Any = head["clock"] or "auto"
    with pytest.raises(SpecError) as caught:
        read_trace(Path(head["log"]), compiled.program, clock, strict=bool(head["strict"]))

    expect(path.with_suffix(".expected"), f"{caught.value}\n")


def test_every_code_has_a_bad_log() -> None:
    sources = (ROOT / "verifier" / "traces").rglob("*.py")
    raised = {code for path in sources for code in re.findall(r'"(V3\d\d)"', path.read_text())}
    shown = {
        code
        for path in FOLDER.glob("*.expected")
        for code in re.findall(r"\[(V3\d\d)\]", path.read_text(encoding="utf-8"))
    }

    assert raised == shown


def test_every_expected_text_has_its_log() -> None:
    assert {path.stem for path in FOLDER.glob("*.expected")} == {path.stem for path in BAD}
