"""Recordings under a fit: those beyond the room are read again, and nothing comes out otherwise."""

from pathlib import Path

import numpy as np
import pytest

from specc.fitting import cases
from specc.fitting.cases import Case, logs_of
from specc.loading import load_program
from tests.specc.fit_scenes import patrol, patrolled


def judged(folder: Path, count: int) -> tuple[Case, ...]:
    program = load_program(patrol(folder))
    logs = logs_of(
        [patrolled(folder / f"{i}.csv", 0.46) for i in range(count)], "auto", is_strict=False
    )
    found = logs.judged(program, lambda _phase: None)
    again = logs.judged_again(found, program, lambda _phase: None)
    assert [each.report.verdict for each in again] == [each.report.verdict for each in found]
    return found


def test_only_so_many_numbers_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    [whole] = judged(tmp_path, 1)
    assert whole.kept is not None
    numbers = sum(s.times.size + s.values.size for s in whole.kept[0].series.values())

    monkeypatch.setattr(cases, "ROOM", 2 * numbers)

    assert [case.kept is not None for case in judged(tmp_path, 3)] == [True, True, False]


def test_what_is_read_again_is_what_was_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    [kept] = judged(tmp_path, 1)
    monkeypatch.setattr(cases, "ROOM", 0)
    [let_go] = judged(tmp_path, 1)

    (trace, study), (same, other) = kept.judged(), let_go.judged()

    assert let_go.kept is None
    assert trace.series.keys() == same.series.keys()
    for name, series in trace.series.items():
        np.testing.assert_array_equal(series.values, same.series[name].values)
    assert (study is None) == (other is None)
