"""CSV files: which column is the time, what is torn, what is text."""

from typing import Any

import numpy as np
import pytest

from runtime.program import Kind
from spec_schema.diagnostics import SpecError
from verifier.traces.files.csv_time import find_clock
from verifier.traces.read import read_trace

ROWS = "".join(f"{0.1 * i:.1f},{i},{'go' if i % 2 else 'stop'}\n" for i in range(20))


@pytest.mark.parametrize(
    ("header", "cells", "seconds", "said"),
    [
        ("t", ["0.0", "0.5"], [0.0, 0.5], "seconds"),
        ("Time [s]", ["1", "2"], [1.0, 2.0], "as its name says"),
        ("time_ms", ["0", "20"], [0.0, 0.02], "milliseconds"),
        ("timestamp_us", ["0", "20"], [0.0, 2e-5], "microseconds"),
        ("stamp_ns", ["0", "20"], [0.0, 2e-8], "nanoseconds"),
        (
            "%time",
            ["1432235498025043000", "1432235498125043000"],
            [1432235498.025043, 1432235498.125043],
            "nanoseconds",
        ),
        (
            "timestamp",
            ["1432235498025", "1432235498125"],
            [1432235498.025, 1432235498.125],
            "milliseconds",
        ),
        (
            "timestamp",
            ["1432235498.025", "1432235498.125"],
            [1432235498.025, 1432235498.125],
            "seconds",
        ),
        ("__time", ["1432235498025043"], [1432235498.025043], "microseconds"),
        ("field.header.stamp", ["1432235498025043000"], [1432235498.025043], "nanoseconds"),
        ("sample_ns", ["5"], [5e-9], "nanoseconds"),
    ],
)
def test_the_time_column_is_found_and_its_unit_said(
    header: str, cells: list[str], seconds: list[float], said: str
) -> None:
    clocked = find_clock({"x": ["1"] * len(cells), header: cells})

    assert clocked is not None
    assert clocked.column == header
    assert (clocked.times * 1e-9).tolist() == pytest.approx(seconds, abs=1e-9, rel=1e-15)
    assert said in clocked.note
    assert f"'{header}'" in clocked.note


def test_seconds_and_nanoseconds_in_two_columns_are_added() -> None:
    columns = {"header.stamp.sec": ["5", "6"], "header.stamp.nanosec": ["500000001", "0"]}

    clocked = find_clock(columns)

    assert clocked is not None
    assert clocked.times.tolist() == [5_500_000_001, 6_000_000_000]


def test_nanoseconds_since_1970_are_read_exactly() -> None:
    clocked = find_clock({"t": ["1432235498025043001", "1432235498.025043001"]})

    assert clocked is not None
    assert clocked.times[0] == 1432235498025043001


@pytest.mark.parametrize("name", ["x", "runtime", "distance", "t1", "timer", "tons"])
def test_other_names_are_not_taken_for_the_time(name: str) -> None:
    assert find_clock({name: ["0", "1"]}) is None


@pytest.mark.parametrize(
    "content",
    [
        "t,x,do\n" + ROWS,
        "t, x, do\r\n" + ROWS.replace("\n", "\r\n"),
        "\ufefft;x;do\n" + ROWS.replace(",", ";"),
        "t\tx\tdo\n" + ROWS.replace(",", "\t"),
        "# a comment, with commas\n# another\nt,x,do\n" + ROWS,
        "# t,x,do\n" + ROWS,
        "#t,x,do\n#comment\n".replace("#comment\n", "") + ROWS,
        '"t","x","do"\n' + ROWS.replace("go", '"go"'),
        "t,x,do\n\n" + ROWS.replace("\n", "\n\n", 3),
    ],
)
def test_the_dialects_of_csv_give_the_same_series(workshop: Any, content: str) -> None:
    trace = workshop.read(workshop.text(content), x="x")

    assert trace.series["x"].values.tolist() == list(range(20))
    np.testing.assert_allclose(trace.series["x"].times, 0.1 * np.arange(20), atol=1e-9)
    assert trace.losses == ()


def test_a_quoted_column_name_is_found(workshop: Any) -> None:
    trace = workshop.read(workshop.text("t,left range\n0,1\n1,2\n"), x='"left range"')

    assert trace.series["x"].values.tolist() == [1.0, 2.0]


def test_a_torn_last_row_is_counted(workshop: Any) -> None:
    trace = workshop.read(workshop.text("t,x,do\n" + ROWS + "2.0,2"), x="x")

    assert len(trace.series["x"].values) == 20
    assert [(loss.cause, loss.count) for loss in trace.losses] == [
        ("rows with missing or extra cells", 1)
    ]
    assert any("last line has no end" in note for note in trace.notes)


def test_an_open_quote_costs_its_own_row(workshop: Any) -> None:
    trace = workshop.read(workshop.text('t,x\n0,1\n1,2\n2,"3\n3,4\n4,5\n'), x="x")

    assert trace.series["x"].values.tolist() == [1.0, 2.0, 4.0, 5.0]
    assert [(loss.cause, loss.count) for loss in trace.losses] == [
        ("rows with missing or extra cells", 1)
    ]


def test_empty_cells_and_nan_are_counted(workshop: Any) -> None:
    trace = workshop.read(workshop.text("t,x\n0,1\n1,\n2,nan\n3,inf\n4,oops\n5,6\n"), x="x")

    assert trace.series["x"].values.tolist() == [1.0, 6.0]
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("no finite value", 4)]


def test_rows_without_a_time_are_counted(workshop: Any) -> None:
    trace = workshop.read(workshop.text("t,x\n0,1\n,2\nlate,3\n3,4\n"), x="x")

    assert trace.series["x"].values.tolist() == [1.0, 4.0]
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("rows without a time", 2)]


def test_texts_become_the_indices_of_declared_values(workshop: Any, make: Any) -> None:
    path = workshop.text("t,do\n0,Go\n1,Stop\n2,Fly\n3,Go\n")
    mode = make.state("mode", Kind.DISCRETE, values=("stop", "go"))
    bound = make.binding("mode", "do", values=(("Stop", 0), ("Go", 1)))

    trace = read_trace(path, make.program([mode], {"mode": bound}))

    assert trace.series["mode"].values.tolist() == [1.0, 0.0, 1.0]
    assert trace.series["mode"].times.tolist() == [0.0, 1.0, 3.0]
    (loss,) = trace.losses
    assert (loss.cause, loss.count) == ("undeclared value", 1)
    assert "'Fly'" in loss.detail


def test_a_signals_other_texts_are_none_of_its_values_and_no_loss(workshop: Any, make: Any) -> None:
    path = workshop.text("t,x,do\n0,1,Go\n1,1,Stop\n2,1,Go\n")
    bound = make.binding("action", "do", values=(("Go", 0),))

    trace = read_trace(path, make.program([make.state("x")], {"x": "x", "action": bound}))

    assert trace.series["action"].values.tolist() == [0.0, -1.0, 0.0]
    assert trace.losses == ()
    assert any("'Stop' in 1 samples" in note for note in trace.notes)


def test_true_and_false_are_one_and_zero(workshop: Any, make: Any) -> None:
    path = workshop.text("t,x,on\n0,1,true\n1,1,False\n")

    trace = read_trace(path, make.program([make.state("x")], {"x": "x", "on": "on"}))

    assert trace.series["on"].values.tolist() == [1.0, 0.0]


def test_texts_where_numbers_are_needed_are_an_error(workshop: Any) -> None:
    path = workshop.text("t,do\n0,Go\n1,Stop\n")

    with pytest.raises(SpecError, match=r"(?s)V305.*'Go', 'Stop'.*values: \[Go, Stop\]"):
        workshop.read(path, x="do")


def test_two_columns_of_one_name_are_noted(workshop: Any) -> None:
    trace = workshop.read(workshop.text("t,x,x\n0,1,7\n1,2,8\n"), x="x")

    assert trace.series["x"].values.tolist() == [1.0, 2.0]
    assert any("several columns are named 'x'" in note for note in trace.notes)


def test_a_table_of_numbers_without_names_is_refused(workshop: Any) -> None:
    with pytest.raises(SpecError, match=r"V309.*holds numbers"):
        workshop.read(workshop.text("0.438,0.498,go\n0.438,0.498,go\n"), x="x")
