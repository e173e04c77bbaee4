"""Arbiters and logs that do not fit, and what is said: pairs in `tests/golden/bad_arbiter_logs`.

A case is a spec whose first line names its log. After a change of a message:
`pytest --bless` on this file, and read the diff.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

import specc
from spec_schema.diagnostics import SpecError
from verifier.report.examination_text import examination_text

FOLDER = Path(__file__).parents[2] / "golden" / "bad_arbiter_logs"
BAD = sorted(FOLDER.glob("*.yaml"))


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_what_does_not_fit_is_explained(
    path: Path, expect: Callable[[Path, str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(FOLDER)
    log = path.read_text(encoding="utf-8").splitlines()[0].removeprefix("# log: ")

    try:
        found = specc.verify(log, path.name)
    except SpecError as error:
        told = str(error)
    else:
        told = examination_text(found.examination).rpartition("\n\n")[0]
    expect(path.with_suffix(".expected"), f"{told}\n")


def test_every_expected_text_has_its_spec() -> None:
    assert {path.stem for path in FOLDER.glob("*.expected")} == {path.stem for path in BAD}
