import json
import math
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from runtime.program import Unit
from verifier.fidelity.verify import verify
from verifier.report.layout import WIDTH
from verifier.report.record import as_json
from verifier.report.report import Exclusion, Report
from verifier.report.text import as_text
from verifier.report.wording import number, quantity
from verifier.traces.trace import Loss


@pytest.fixture
def passed(scenes: ModuleType) -> Report:
    return verify(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 60.0, 0.01))


@pytest.fixture
def failed(scenes: ModuleType) -> Report:
    degrees = replace(
        scenes.unicycle(1.1).states[2], unit=Unit("deg", math.pi / 180.0), origin="base.yaml:7:3"
    )
    spec = scenes.unicycle(1.1)
    return verify(
        replace(spec, states=(*spec.states[:2], degrees)), scenes.unicycle_drive(4, 60.0, 0.01)
    )


@pytest.fixture
def empty(scenes: ModuleType) -> Report:
    return verify(scenes.unicycle(), scenes.unicycle_drive(1, 4.25, 0.01))


def test_the_verdict_and_its_reason_come_first(passed: Report, failed: Report) -> None:
    assert as_text(passed).startswith("PASS  scene on drive.mcap\n  x stays within 0.05 over 2 s")
    assert as_text(failed).startswith("FAIL  scene on drive.mcap\n  ")
    assert "heading departs by" in as_text(failed).split("\n\n")[0]


def test_figures_stand_in_the_users_units(failed: Report) -> None:
    heading = next(line for line in as_text(failed).splitlines() if line.startswith("heading  "))

    # 0.02 rad is 1.15 degrees.
    assert heading.split()[1:3] == ["deg", "1.15"]


def test_what_was_lost_and_left_out_is_told(failed: Report) -> None:
    lost = (Loss("damaged chunk", 3, "at byte 100"),)
    excluded = (Exclusion("a gap in speed", 4.2, 42),)

    text = as_text(replace(failed, losses=lost, exclusions=excluded))

    assert "lost in the log\n  3 x  damaged chunk  at byte 100" in text
    assert "not judged\n  4.2 s  42 samples  a gap in speed" in text


def test_an_inconclusive_report_without_figures_is_short(empty: Report) -> None:
    text = as_text(empty)

    assert text.startswith("INCONCLUSIVE  scene on drive.mcap\n  the trace covers 0.0-4.2 s")
    assert "tolerance" not in text


def test_lines_are_as_wide_as_a_terminal(passed: Report, failed: Report) -> None:
    for report in (passed, failed):
        assert max(map(len, as_text(report).splitlines())) <= WIDTH + 20


def test_json_has_the_keys_that_others_rely_on(failed: Report) -> None:
    found = as_json(failed)

    assert found["verdict"] == "fail"
    assert {"variables", "coverage", "losses", "spec", "trace"} <= found.keys()
    heading = found["variables"]["heading"]
    assert {"horizon", "rmse", "tolerance", "within"} <= heading["horizons"][-1].keys()
    assert heading["horizons"][-1]["horizon"] == 5.0
    assert heading["horizons"][-1]["within"] is False
    assert heading["horizons"][-1]["tolerance"] == pytest.approx(0.02 * 180.0 / math.pi)
    assert heading["unit"] == "deg"
    assert heading["origin"] == "base.yaml:7:3"


def test_json_is_strict(passed: Report, failed: Report, empty: Report) -> None:
    for report in (passed, failed, empty):
        text = json.dumps(as_json(report), allow_nan=False)
        assert json.loads(text)["trace"]["source"] == "drive.mcap"


def test_an_undecided_variable_is_neither_within_nor_beyond(scenes: ModuleType) -> None:
    report = verify(scenes.van_der_pol(), scenes.van_der_pol_drive(1, 4.0, 0.01))

    horizons = as_json(report)["variables"]["x"]["horizons"]
    assert horizons[-1]["within"] is None
    assert horizons[-1]["interval"][1] is None
    assert "x may or may not stay within" in as_text(report)


def test_views_show_what_was_measured(passed: Report, scenes: ModuleType) -> None:
    drive = scenes.van_der_pol_drive(1, 60.0, 0.01)
    series = drive.series["x"]

    for view in passed.variables[0].views:
        at = np.searchsorted(series.times, view.times)
        assert series.values[at] == pytest.approx(view.measured)
        assert np.max(np.abs(view.measured - view.predicted)) < 0.06


def test_numbers_read_as_people_write_them() -> None:
    assert number(0.05) == "0.05"
    assert number(123456.0) == "123456"
    assert number(-math.inf) == "unbounded"
    assert quantity(1.0, Unit("deg", math.pi / 180.0)) == "57.3 deg"
