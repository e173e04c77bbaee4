"""Procedures in a book: legs that people and programs can follow, examples that run as printed."""

import csv
import io
import re
import subprocess
import sys
from pathlib import Path

import pytest

from runtime.program import Program, Unit
from specc.book.chapters import Block, Bullets, Paragraph, Table
from specc.book.export import export_book
from specc.book.loading import load_book
from specc.book.trials import Trial
from specc.book.words.faithful import faithful_section
from specc.book.words.legs import as_rows, legs_of, legs_table
from specc.book.words.source import words_above
from specc.book.words.testing import procedure_section
from specc.loading import load_program
from tests.specc.book_scenes import ARCHITECTURE, laid_down
from verifier.procedure.behavior import procedure_of
from verifier.procedure.model import Drive, Procedure, Signal, Stage
from verifier.procedure.robot import Robot

SPECS = Path(__file__).parents[2] / "specs"
METRE, NONE = Unit("m", 1.0), Unit("1", 1.0)
SIGNALS = (
    Signal("heading", Unit("rad", 1.0), 0.01, (), is_set=False, is_sensed=False),
    Signal("left", METRE, 0.005, (), is_set=False, is_sensed=True),
    Signal("side", NONE, 0.0, ("to_left", "to_right"), is_set=False, is_sensed=False),
    Signal("gain", NONE, 0.0, (), is_set=True, is_sensed=False),
)
DRIVES = (
    Drive(
        {"heading": -1.0, "left": 0.2, "side": 1.0},
        (Stage(1.5, {"left": 1.7, "gain": 2.0}), Stage(1.5, {"left": 1.7, "gain": 3.0})),
        4,
    ),
    Drive(
        {"heading": 0.5, "left": 1.0, "side": 0.0},
        (Stage(1.5, {"left": 1.0, "gain": 2.0}), Stage(1.0, {"left": 1.0, "gain": 2.0})),
        4,
    ),
)
PLAIN = Procedure("turn", 0.5, 40.0, DRIVES, SIGNALS, (), 0.0, None, (), None)


@pytest.fixture(scope="module")
def avoid() -> Program:
    return load_program(SPECS / "avoid.yaml", allow_code=False)


@pytest.fixture(scope="module")
def rehearsed(avoid: Program) -> Procedure:
    return procedure_of(avoid, Robot(0.05, 0.05, {"creep": (0.0,)}))


def said(blocks: tuple[Block, ...]) -> str:
    told = []
    for block in blocks:
        match block:
            case Paragraph(text=text):
                told.append(text)
            case Bullets(items=items):
                told.extend(items)
            case Table(rows=rows):
                told.extend(" ".join(row) for row in rows)
            case _:
                pass
    return "\n".join(told)


def test_legs_tell_when_what_is_brought_where() -> None:
    table = legs_table(PLAIN)
    assert table.titles == ("run", "time", "`heading`", "`left`", "`side`", "`gain`")
    assert table.rows == (
        ("1", "0 to 1.5 s", "starts -1 rad", "0.2 m → 1.7 m", "starts to_right", "2"),
        ("", "1.5 to 3 s", "…", "1.7 m", "…", "3"),
        ("2", "0 to 2.5 s", "starts 0.5 rad", "1 m", "starts to_left", "2"),
    )


def test_legs_in_which_nothing_is_changed_are_one() -> None:
    first, second = (legs_of(PLAIN, drive) for drive in DRIVES)
    assert [(leg.begin, leg.end) for leg in first] == [(0.0, 1.5), (1.5, 3.0)]
    assert [(leg.begin, leg.end) for leg in second] == [(0.0, 2.5)]


def test_rows_for_programs_say_the_same() -> None:
    rows = list(csv.DictReader(io.StringIO(as_rows(PLAIN).decode())))
    assert [row["time"] for row in rows if row["run"] == "1"] == ["0", "1.5", "3"]
    assert [row["left"] for row in rows if row["run"] == "1"] == ["0.2", "1.7", "1.7"]
    assert [row["gain"] for row in rows if row["run"] == "1"] == ["2", "3", "3"]
    assert [row["side"] for row in rows] == ["to_right", "", "", "to_left", ""]
    assert {row["repeats"] for row in rows} == {"4"}


def test_a_page_tells_how_often_what_may_be_fed_in_and_how_a_mode_is_entered(
    avoid: Program, rehearsed: Procedure
) -> None:
    told = said(
        procedure_section(avoid, Trial(rehearsed, None, ""), "data/avoid.procedure.csv").blocks
    )
    count, repeats = len(rehearsed.drives), rehearsed.drives[0].repeats
    assert f"{count * repeats} recordings" in told
    assert "one motion through all its legs" in told
    assert "`left`, `right`" in re.sub(" and ", ", ", told)
    assert "may be fed to the behavior" in told
    assert "`heading`: never fed in" in told
    assert "`to_right` from `to_left` by `right ≥ left + sure`" in told


def test_a_page_tells_by_how_much_changes_of_mode_may_be_late(
    avoid: Program, rehearsed: Procedure
) -> None:
    told = said(faithful_section(avoid, Trial(rehearsed, None, "")).blocks)
    assert "Fewer than 3 changes of a kind decide nothing" in told
    assert rehearsed.rehearsal is not None
    for way in rehearsed.rehearsal.ways:
        assert f"`{way.source}` to `{way.target}`" in told
    assert {(way.source, way.target) for way in rehearsed.rehearsal.ways} == {
        ("to_left", "to_right"),
        ("to_right", "to_left"),
    }
    # 0.1 rad over the difference of the two turn rates, each between 0.5 and 2 rad/s.
    assert all(0.1 / 4.0 < way.allowed < 0.1 / 1.0 for way in rehearsed.rehearsal.ways)


def test_what_an_author_says_above_a_key_is_found() -> None:
    text = "# head\na: 1\n\n# of this\n# and that\nfidelity:\n  horizon: 1 s\n"
    assert words_above(text, "fidelity:") == ("of this and that",)
    assert words_above(text, "a:") == ("head",)
    assert words_above(text, "b:") == ()


def test_examples_on_pages_run_as_printed(tmp_path: Path) -> None:
    home = laid_down(tmp_path)
    export_book(home / ARCHITECTURE, home / "made", lambda *_: None, with_pdf=False)
    page = (home / "made/pages/module.index.html").read_text(encoding="utf-8")
    found = [
        text for text in re.findall(r"<pre[^>]*>(.*?)</pre>", page, re.DOTALL) if "value(" in text
    ]
    assert found
    for text in found:
        plain = re.sub(r"<[^>]+>", "", text).replace("&#34;", '"').replace("&quot;", '"')
        call, _, result = plain.strip().splitlines()[-1].partition("  # ")
        code = "\n".join([*plain.strip().splitlines()[:-1], f"print({call})"])
        ran = subprocess.run(
            [sys.executable, "-c", code],
            cwd=home / "made/data",
            capture_output=True,
            text=True,
            check=True,
        )
        assert float(ran.stdout) == pytest.approx(float(result.split()[0]), rel=1e-4)


def test_the_manifest_lists_the_rows_of_a_procedure(tmp_path: Path) -> None:
    home = laid_down(tmp_path)
    export_book(home / ARCHITECTURE, home / "made", lambda *_: None, with_pdf=False)
    book = load_book(home / "made").book
    module = next(each for each in book.modules if each.kind == "behavior")
    assert module.data[-1].endswith(".procedure.csv")
    assert module.data[-1] in {file.path for file in book.files}
