"""`specc.fit`: numbers move to what the robot does, in the user's text, and nothing else does."""

import re
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import Writer

import specc
from runtime.artifact import to_bytes
from spec_schema.diagnostics import SpecError
from spec_schema.source import Source
from specc.files import BOM
from specc.fitting import cases
from specc.fitting.aims import Aim, Aims, UnitAim
from specc.fitting.compiling import compiled
from specc.fitting.fitted import Outcome
from specc.fitting.moves import _is_same, moved
from specc.fitting.own_text import own_text
from specc.fitting.pooling import pooled
from specc.fitting.rounding import rounded
from tests.specc.fit_scenes import (
    MOVER,
    SPECS,
    TOLD,
    drawn,
    late_mover,
    other_whirl,
    patrol,
    patrolled,
    whirled,
    written,
)
from verifier.diagnosis.diagnose import diagnose
from verifier.report.diagnosis import CandidateKind, Diagnosis, Told
from verifier.report.report import Verdict
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace


def changed_lines(before: str, after: str) -> list[tuple[str, str]]:
    pairs = zip(before.split("\n"), after.split("\n"), strict=True)
    return [pair for pair in pairs if pair[0] != pair[1]]


def test_a_slower_robot_moves_one_number_in_one_line(tmp_path: Path) -> None:
    spec, run = patrol(tmp_path), patrolled(tmp_path / "run.csv", 0.46)
    before = spec.read_text()

    found = specc.fit(run, spec)

    assert found.outcome is Outcome.MOVED
    [(old, new)] = changed_lines(before, found.edited.text)
    assert old == "  v1: {unit: m/s, domain: [0.1, 0.8], default: 0.5, about: speed forward}"
    number = re.fullmatch(r"  v1: .* default: (\S+), about: speed forward}", new)
    assert number is not None
    assert float(number[1]) == pytest.approx(0.46, abs=0.002)
    assert found.diff.count("\n-") == found.diff.count("\n+") - 1 == 1
    assert spec.read_text() == before, "nothing is written before `write`"


@pytest.fixture(scope="module")
def slower(tmp_path_factory: pytest.TempPathFactory) -> specc.Fitted:
    """The fit to a robot that is slower than commanded."""
    folder = tmp_path_factory.mktemp("slower")
    return specc.fit(patrolled(folder / "run.csv", 0.46), patrol(folder, TOLD))


def test_a_constant_of_the_log_is_moved_where_it_stands_and_the_verdict_clears(
    slower: specc.Fitted,
) -> None:
    [(old, new)] = changed_lines(slower.source.text, slower.edited.text)

    assert old == "  v1: {constant: 0.5}  # as commanded"
    assert new == "  v1: {constant: 0.46}  # as commanded"
    assert [report.verdict for report in slower.before] == [Verdict.FAIL]
    assert [report.verdict for report in slower.after] == [Verdict.PASS]


def test_writing_replaces_the_file_and_keeps_its_line_ends_and_mark(
    slower: specc.Fitted, tmp_path: Path
) -> None:
    spec = tmp_path / "patrol.yaml"
    text = slower.source.text.replace("\n", "\r\n")
    spec.write_bytes(BOM + text.encode())
    source = Source(str(spec), text)

    replace(slower, source=source, edited=moved(source, slower.moves)).write()

    old, new = b"  v1: {constant: 0.5}", b"  v1: {constant: 0.46}"
    assert spec.read_bytes() == BOM + text.encode().replace(old, new)


def test_a_spec_that_was_changed_meanwhile_is_not_written(
    slower: specc.Fitted, tmp_path: Path
) -> None:
    spec = tmp_path / "patrol.yaml"
    spec.write_text(slower.source.text + "# a new thought\n", encoding="utf-8")

    with pytest.raises(SpecError) as caught:
        replace(slower, source=Source(str(spec), slower.source.text)).write()

    [said] = caught.value.diagnostics
    assert (said.code, said.message) == (
        "V374",
        "the spec was changed while it was fitted, so nothing is written",
    )
    assert spec.read_text().endswith("# a new thought\n")


def test_a_faithful_robot_moves_nothing(tmp_path: Path) -> None:
    spec, run = patrol(tmp_path, TOLD), patrolled(tmp_path / "run.csv", 0.5)

    found = specc.fit(run, spec)

    assert found.outcome is Outcome.NOTHING_TO_MOVE
    assert (found.moves, found.diff, found.after) == ((), "", ())


def test_runs_that_agree_are_pooled(tmp_path: Path) -> None:
    spec = patrol(tmp_path, TOLD)
    runs = [patrolled(tmp_path / f"{i}.csv", 0.46, 40.0, i) for i in (1, 2)]

    found = specc.fit(runs, spec)

    [move] = found.moves
    assert float(move.new) == pytest.approx(0.46, abs=0.002)
    assert Verdict.FAIL not in {report.verdict for report in found.after}


def test_runs_that_contradict_one_another_leave_a_choice() -> None:
    one = Aim(("control", "v1", "default"), "v1", 0.46, 0.01, "m/s", 1.0, "")
    near, far = replace(one, value=0.47), replace(one, value=0.55)

    assert not pooled([Aims((one,)), Aims((near,))]).choices
    [said] = pooled([Aims((one,)), Aims((far,)), Aims(())]).choices
    assert said == "v1: the recordings contradict one another: 0.46 and 0.55"


@pytest.mark.parametrize("count", [2, 5, 20])
def test_runs_of_one_robot_contradict_one_another_once_in_a_hundred_times(count: int) -> None:
    """However many there are: 20 recordings make 190 pairs, and some pair of them is far apart."""
    rng = np.random.default_rng(5)
    alarms = 0
    for _ in range(3000):
        sigmas = rng.uniform(0.002, 0.02, count)
        alarms += bool(pooled(measured(0.46 + sigmas * rng.normal(size=count), sigmas)).choices)

    # 30 are expected; a binomial of 3000 stays within 13 and 51 but once in 5000 times.
    assert 13 <= alarms <= 51


def test_runs_that_differ_by_halves_contradict_though_no_pair_does() -> None:
    """Ten of each kind, 2 sigma apart: Q is 20, 10 squares of 1 on either side; at 4 it is 80."""
    near, far = (np.repeat([0.46, 0.46 + apart], 10) for apart in (0.02, 0.04))

    assert not pooled(measured(near, np.full(20, 0.01))).choices
    assert len(pooled(measured(far, np.full(20, 0.01))).choices) == 1


def test_a_measured_number_contradicts_an_exact_one_beyond_its_own_doubt() -> None:
    exact, close, beyond = measured(np.array([0.46, 0.48, 0.49]), np.array([0.0, 0.01, 0.01]))

    assert not pooled([exact, close]).choices
    assert pooled([exact, beyond]).choices


def measured(values: np.ndarray, sigmas: np.ndarray) -> list[Aims]:
    """What each run tells of one number: its 95 % interval, 1.96 sigma to either side."""
    return [
        Aims((Aim(("control", "v1", "default"), "v1", float(v), 1.96 * float(s), "m/s", 1.0, ""),))
        for v, s in zip(values, sigmas, strict=True)
    ]


def test_units_contradict_where_they_differ_and_not_where_reasons_do() -> None:
    one = UnitAim(("trace", "heading", "unit"), "unit of heading", "deg", "93 % of the error")
    same, other = replace(one, sentence="88 % of the error"), replace(one, text="mrad")

    assert not pooled([Aims((one,)), Aims((same,))]).choices
    assert len(pooled([Aims((one,)), Aims((other,))]).choices) == 1


@pytest.mark.parametrize("degrees", [15, 30, 60, 116])
def test_a_number_that_is_there_already_is_no_move(degrees: int) -> None:
    assert _is_same(f"{degrees} deg", str(degrees))
    assert not _is_same(f"{degrees} deg", f"{degrees}.0001")


def test_pooled_values_are_weighted_by_how_exactly_they_are_known() -> None:
    rough = Aim(("control", "v1", "default"), "v1", 0.4, 0.02, "m/s", 1.0, "")
    exact = replace(rough, value=0.41, half=0.01)

    [found] = pooled([Aims((rough,)), Aims((exact,))]).aims

    assert isinstance(found, Aim)
    assert found.value == pytest.approx((0.4 + 4 * 0.41) / 5)
    assert found.half == pytest.approx(0.02 / 5**0.5)


@given(
    st.floats(-1e4, 1e4),
    st.floats(1e-6, 1e3),
)
def test_rounding_moves_a_value_by_no_more_than_a_quarter_of_its_doubt(
    value: float, half: float
) -> None:
    text = rounded(value, half)

    assert abs(float(text) - value) <= 0.26 * half + 1e-12 * abs(value)
    assert text == rounded(float(text), half), "rounding twice is rounding once"
    assert text != "-0"


def test_digits_beyond_the_doubt_are_dropped() -> None:
    assert [rounded(v, h) for v, h in ((0.45967, 0.01), (0.5, 0.3), (2.0004, 0.02), (-1, 0))] == [
        "0.46", "0.5", "2", "-1",
    ]  # fmt: skip


SLIDE = """specc: 1
kind: behavior
name: slide
state:
  x: {{unit: "1", domain: [-40, 40], role: both, relates: {{agent: base, environment: hall}}}}
control:
  speed: {{unit: 1/s, domain: [-1, 1], default: 0}}
field: {{formula: {{x: {rate}}}}}
fidelity: {{tolerance: {{x: 0.02}}, horizon: 1 s}}
trace:
  x: x
{speed}
"""


def slid(path: Path, late: float = 0.0) -> Path:
    """A cart on a rail, pushed to and fro; its speed is logged `late` seconds late."""
    rng = np.random.default_rng(5)
    times = np.arange(0.0, 40.0, 0.04)

    def speed(at: np.ndarray) -> np.ndarray:
        return np.where(np.sin(0.9 * at) + np.sin(0.41 * at) > 0.0, 0.7, -0.3)

    x = np.concatenate([[0.0], np.cumsum(speed(times))[:-1]]) * 0.04
    x = x + 0.003 * rng.normal(size=x.shape)
    return written(path, {"t": times, "x": x, "speed": speed(times - late)})


def test_a_late_log_turns_a_bare_path_into_a_mapping_with_a_delay(tmp_path: Path) -> None:
    spec = tmp_path / "slide.yaml"
    spec.write_text(SLIDE.format(rate="speed", speed="  speed: speed  # command"))

    found = specc.fit(slid(tmp_path / "run.csv", late=0.3), spec)

    [(old, new)] = changed_lines(found.source.text, found.edited.text)
    assert old == "  speed: speed  # command"
    number = re.fullmatch(r"  speed: {path: speed, delay: (\S+) s}  # command", new)
    assert number is not None
    assert float(number[1]) == pytest.approx(0.3, abs=0.03)
    assert found.after[0].verdict is Verdict.PASS


def test_scales_that_leave_the_same_trace_are_both_shown_and_anyway_writes_the_first(
    tmp_path: Path,
) -> None:
    """x' = k speed: a speed logged half as large is an x logged twice as large."""
    spec = tmp_path / "slide.yaml"
    entry = "  speed:\n    path: speed  # command\n    scale: 0.5"
    spec.write_text(SLIDE.format(rate="speed", speed=entry))
    run = slid(tmp_path / "run.csv")

    found, forced = specc.fit(run, spec), specc.fit(run, spec, anyway=True)

    assert (found.outcome, found.edited) == (Outcome.CANNOT_TELL, found.source)
    of_speed, of_x = (float(way.moves[0].new) for way in found.ways)
    assert [way.moves[0].name for way in found.ways] == ["scale of speed", "scale of x"]
    assert (of_speed, of_x) == (pytest.approx(1.0, abs=0.02), pytest.approx(0.5, abs=0.01))
    assert all(way.explanation.telling for way in found.ways)
    [(old, new)] = changed_lines(forced.source.text, forced.edited.text)
    assert old == "    scale: 0.5"
    assert float(new.removeprefix("    scale: ")) == pytest.approx(1.0, abs=0.02)


def test_where_the_structure_differs_nothing_is_edited(tmp_path: Path) -> None:
    spec = tmp_path / "hold.yaml"
    rate = "speed * (1 + 0.4*sin(2*x))"
    spec.write_text(SLIDE.format(rate=rate, speed="  speed: speed"))

    found = specc.fit(slid(tmp_path / "run.csv"), spec)

    assert found.outcome is Outcome.STRUCTURE_DIFFERS
    assert found.edited == found.source
    assert found.beyond or found.left


def test_numbers_that_make_no_spec_are_refused(slower: specc.Fitted) -> None:
    text = slower.edited.text.replace("v1: {constant: 0.46}", "v1: {constant: 0.9}")

    with pytest.raises(SpecError) as caught:
        compiled(replace(slower.source, text=text))

    [said] = caught.value.diagnostics
    assert said.code == "V373"
    assert said.message == (
        "with the robot's numbers the spec can't be compiled: 0.9 is outside the domain [0.1, 0.8]"
    )


def test_a_number_over_several_lines_is_not_moved(slower: specc.Fitted) -> None:
    text = slower.source.text.replace("v1: {constant: 0.5}", "v1:\n    constant: >-\n      0.5 m/s")
    source = replace(slower.source, text=text)

    with pytest.raises(SpecError) as caught:
        moved(source, slower.moves)

    [said] = caught.value.diagnostics
    assert (said.code, said.message) == (
        "V372",
        "v1 can't be moved: it does not begin with a number",
    )


def test_the_husky_without_its_delays_is_told_so_and_gets_them_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (SPECS / "husky_drive.yaml").read_text(encoding="utf-8")
    bare = re.sub(r"\{path: (\S+), delay: \S+ s\}", r"\1", text)
    spec = tmp_path / "husky_drive.yaml"
    spec.write_text(bare, encoding="utf-8")

    told: list[Diagnosis] = []

    def heard(*given: Any) -> Diagnosis:
        told.append(diagnose(*given))
        return told[-1]

    monkeypatch.setattr("specc.fitting.fit.diagnose", heard)

    found = specc.fit(SPECS / "recordings" / "husky" / "husky.mcap", spec)

    [why] = told
    taken = {each.label: each.kind for each in why.candidates if each.is_taken}
    assert taken == {
        "speed logged late": CandidateKind.LATE_LOG,
        "turn logged late": CandidateKind.LATE_LOG,
    }
    [scale] = (each for each in why.refitted if each.name == "turn_scale")
    assert scale.interval.low < 0.944 < scale.interval.high
    delayed = re.compile(r"^  (\w+): {path: \S+, delay: (\S+) s}$", re.MULTILINE)
    delays = dict(delayed.findall(found.edited.text))
    assert delays.keys() == {"speed", "turn"}
    assert float(delays["speed"]) == pytest.approx(0.5, abs=0.06)
    assert float(delays["turn"]) == pytest.approx(0.1, abs=0.05)
    assert len(changed_lines(bare, found.edited.text)) == 2
    assert found.after[0].verdict is Verdict.PASS


@pytest.mark.parametrize("form", ["arrows", "grid"])
def test_a_drawn_field_moves_to_what_the_robot_does(
    tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if form == "grid":  # what the arrows' diagnosis says is known
        structure = Diagnosis(Told.STRUCTURE_DIFFERS, ("why",), (), (), (), ())
        monkeypatch.setattr("specc.fitting.fit.diagnose", lambda *_: structure)
    spec, run = drawn(tmp_path, form), whirled(tmp_path / "run.csv", other_whirl)

    found = specc.fit(run, spec)

    assert found.outcome is Outcome.MOVED
    assert [report.verdict for report in found.before] == [Verdict.FAIL]
    assert [report.verdict for report in found.after] != [Verdict.FAIL]
    [stays] = found.stays
    assert "stay as they are" in stays
    outside = re.compile(r"-?\d+\.\d+|-?\b\d\b(?=[,\]])")
    assert outside.sub("#", found.edited.text) == outside.sub("#", found.source.text)
    edited = tmp_path / "edited.yaml"
    edited.write_text(found.edited.text)
    program = specc.load_program(edited)
    for angle in np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False):
        x, y = 0.6 * np.cos(angle), 0.6 * np.sin(angle)
        rates = rates_at(program, x, y)
        assert rates == pytest.approx(other_whirl(x, y), abs=0.02)


def rates_at(program: specc.Program, x: float, y: float) -> np.ndarray:
    """By a short run."""
    step = 0.01
    run = specc.simulate(program, {"x": float(x), "y": float(y)}, step, every=step)
    return np.asarray((run.states[-1] - run.states[0]) / step)


def test_an_artifact_of_another_text_is_not_edited(tmp_path: Path) -> None:
    spec = patrol(tmp_path, TOLD)
    program = specc.load_program(spec)
    assert own_text(program).source.name == str(spec)

    spec.write_text(spec.read_text() + "# later\n")

    with pytest.raises(SpecError) as caught:
        own_text(program)
    [said] = caught.value.diagnostics
    assert said.code == "V371"
    assert said.help == f"name the text to edit: --spec {spec}"


def test_fit_runs_nobodys_code(tmp_path: Path) -> None:
    """The log carries the artifact, which is a table; the text beside it calls a function."""
    spec = tmp_path / "circling.yaml"
    shutil.copy(SPECS / "circling.yaml", spec)
    function = tmp_path / "circling_field.py"
    shutil.copy(SPECS / "circling_field.py", function)
    artifact = to_bytes(specc.load_program(spec))
    function.write_text("raise SystemExit('a stranger ran this')\n", encoding="utf-8")
    with (tmp_path / "run.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        writer.add_attachment(0, 0, "circling.specc", "application/zip", artifact)
        writer.finish()  # type: ignore[no-untyped-call]  # the library has no types here

    with pytest.raises(SpecError) as caught:
        specc.fit(tmp_path / "run.mcap")

    [said] = caught.value.diagnostics
    assert (said.code, said.source.name) == ("V336", str(spec))
    assert said.message == "this field is Python code, and fit runs nobody's code"


def test_a_log_is_read_again_only_where_the_edit_changes_how_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[Path] = []

    def counted(path: Path, *rest: object, **more: object) -> Trace:
        read.append(path)
        return read_trace(path, *rest, **more)  # type: ignore[arg-type]  # handed on

    monkeypatch.setattr(cases, "read_trace", counted)
    spec = tmp_path / "mover.yaml"
    log = late_mover(tmp_path / "run.csv", 0.0)
    spec.write_text(MOVER.replace("value: 1.5", "value: 1.2"), encoding="utf-8")

    assert [move.name for move in specc.fit(log, spec).moves] == ["pull"]
    assert read == [log]

    spec.write_text(MOVER, encoding="utf-8")
    late = late_mover(tmp_path / "late.csv", 0.3)
    read.clear()

    assert [move.name for move in specc.fit(late, spec, anyway=True).moves] == ["delay of x"]
    assert read == [late, late]
