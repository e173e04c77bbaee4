"""What was planted is what is named; the whole table is in tests/study/diagnosis.py.

Logs that come late, the Husky's among them, are in tests/specc/test_fit.py.
"""

import re
from pathlib import Path

import pytest

import specc
from tests.study.diagnosis import Row, diagnosed, is_right, named, program_of, rows
from verifier.report.diagnosis import CandidateKind, Told
from verifier.traces.read import read_trace

SCITOS = Path(__file__).parents[3] / "specs" / "recordings" / "scitos" / "wall_following.csv"
SOME = (
    "nothing",
    "dead zone 4 cm",
    "distance in millimetres",
    "x seen 0.1 too high",
)
CHOSEN = [next(row for row in rows() if row.planted == planted) for planted in SOME]


@pytest.mark.parametrize("row", CHOSEN, ids=lambda row: row.planted)
def test_what_was_planted_is_named(row: Row) -> None:
    found = diagnosed(program_of(row.spec), row.made(11))

    assert is_right(row, found), named(found)


def test_of_a_faithful_robot_nothing_is_named_where_the_verdict_is_open() -> None:
    """This drive sees too little for a PASS, so that everything is tried."""
    (row,) = (row for row in rows() if (row.planted, row.spec) == ("nothing", "drive"))

    found = diagnosed(program_of(row.spec), row.made(2))

    assert found.told is Told.NO_DIFFERENCE
    assert not any(each.is_taken for each in found.candidates)


def test_a_field_that_bends_otherwise_is_no_matter_of_numbers() -> None:
    """A turn rate that is cut beyond 0.3 rad/s: no number of the spec explains it."""
    (row,) = (row for row in rows() if row.planted == "saturation 0.3 rad/s")

    assert diagnosed(program_of(row.spec), row.made(5)).told is Told.STRUCTURE_DIFFERS


def test_a_turn_rate_that_is_off_in_one_region_is_told_with_its_border() -> None:
    """0.4 rad/s more wherever the wall is further away than 0.85 m."""
    (row,) = (row for row in rows() if "beyond 0.85 m" in row.planted)

    found = diagnosed(program_of(row.spec), row.made(1))

    (taken,) = (each for each in found.candidates if each.is_taken)
    offset, border = taken.numbers
    assert taken.kind is CandidateKind.REGION
    assert taken.applies_to == ("heading", "distance")
    assert "rad/s higher where distance is above 0.8" in taken.sentence
    assert offset.interval.low < 0.4 < offset.interval.high
    assert border.value == pytest.approx(0.85, abs=0.01)
    assert found.told is Told.STRUCTURE_DIFFERS


def test_what_departs_clearly_but_may_is_told_with_its_size() -> None:
    """The SCITOS keeps to its tolerance by a little more than a half of it."""
    program = specc.load_program(SCITOS.parents[2] / "keep_left.yaml")

    found = diagnosed(program, read_trace(SCITOS, program, "auto"))

    assert found.told is Told.NO_DIFFERENCE
    assert found.candidates == ()
    assert re.match(r"left departs by 0\.0\d+ m, which 0\.1 m allow", found.sentences[0])
