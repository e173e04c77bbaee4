"""Bad specs and what is said about them: one mistake, one pair of files in `tests/golden/bad`.

After a change of a message: `pytest tests/test_golden_bad.py --bless`, and read the diff.
"""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from compiler.check import check
from compiler.compile_file import compile_file
from spec_schema.behavior import BehaviorSpec
from spec_schema.diagnostics import Diagnostic, Severity, SpecError, render
from spec_schema.load import load

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "tests" / "golden" / "bad"
BAD = sorted(FOLDER.glob("*.yaml"))
CODE = re.compile(r'"(S\d\d\d)"')
BLAME = re.compile(r"\b[Ii]nvalid\b|\b[Pp]lease\b|[Pp]ydantic|Spec\b|\bdict|\btuple")

# Codes that no file in the folder can show, and the test that shows them.
ELSEWHERE = {
    "S011": "not UTF-8: tests/spec_schema/test_load.py",
    "S012": "larger than 1 MiB: tests/spec_schema/test_load.py",
    "S015": "no such file: tests/spec_schema/test_load.py",
    "S016": "more than 100 mistakes: tests/spec_schema/test_load.py",
    "S131": "an empty text is refused as S110 first: tests/spec_schema/test_expressions_parse.py",
    "S268": "takes a judge: tests/compiler/test_sketch_fields.py",
    "S200": "a project is no behavior: tests/compiler/test_compile.py",
}


def is_behavior(path: Path) -> bool:
    """Whether the spec is compiled by itself."""
    return isinstance(load(path).spec, BehaviorSpec)


def diagnose(path: Path) -> tuple[Diagnostic, ...]:
    """Everything that is wrong with the spec."""
    found = check(path)
    if any(diagnostic.severity is Severity.ERROR for diagnostic in found) or not is_behavior(path):
        return found
    try:
        return compile_file(path, lambda _what, _done, _of: None, allow_code=True).warnings
    except SpecError as error:
        return error.diagnostics


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_bad_spec_is_explained(
    path: Path, expect: Callable[[Path, str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(FOLDER)

    found = diagnose(Path(path.name))

    assert found, "nothing was found wrong"
    expect(path.with_suffix(".expected"), f"{render(found)}\n")


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_no_message_blames_or_leaks_our_insides(path: Path) -> None:
    for found in diagnose(path):
        text = f"{found.message} {found.help}"
        assert not BLAME.search(text)
        assert not found.message.endswith(".")
        assert found.message[0] == found.message[0].lower()


def test_every_code_has_a_bad_spec() -> None:
    folders = (ROOT / "spec_schema", ROOT / "compiler")
    files = [path for folder in folders for path in folder.rglob("*.py")]
    sources = [path.read_text(encoding="utf-8") for path in files]
    raised = {code for text in sources for code in CODE.findall(text)}
    shown = {
        code
        for path in FOLDER.glob("*.expected")
        for code in re.findall(r"\[(S\d\d\d)\]", path.read_text(encoding="utf-8"))
    }

    assert raised - shown == set(ELSEWHERE)


def test_every_expected_text_has_its_spec() -> None:
    assert {path.stem for path in FOLDER.glob("*.expected")} == {path.stem for path in BAD}
