"""What a diagnosis says of ties, of what is left over, and of what is allowed."""

from dataclasses import replace

import pytest

from runtime.program import Fidelity
from tests.study import planted
from tests.study.diagnosis import FOLLOW, diagnosed, program_of
from tests.study.planted import Wall
from verifier.diagnosis.diagnose import diagnose
from verifier.diagnosis.fitting import plain_fit
from verifier.diagnosis.leftover import Bench, leaves
from verifier.diagnosis.scene import scene_of
from verifier.fidelity.verify import judged
from verifier.report.diagnosis import CandidateKind, Told
from verifier.report.report import Verdict
from verifier.traces.trace import Trace


def seen_too_high(trace: Trace, name: str, by: float) -> Trace:
    series = trace.series[name]
    other = replace(series, values=series.values + by)
    return replace(trace, series={**trace.series, name: other})


def test_a_cubic_in_a_rate_is_named_as_one_term_with_its_factor() -> None:
    """The turn rate is the spec's less 12 rad/s times the cube of the heading."""
    found = diagnosed(program_of(FOLLOW), planted.wall(Wall(bend=-12.0), 3, 40.0, noise=0.2))

    (taken,) = (each for each in found.candidates if each.is_taken)
    (factor,) = taken.numbers
    assert (taken.kind, taken.applies_to) == (CandidateKind.TERM, ("heading", "heading"))
    assert taken.label == "term heading^3 in the rate of heading"
    assert factor.interval.low < -12.0 < factor.interval.high
    assert found.told is Told.STRUCTURE_DIFFERS


def test_numbers_that_leave_the_same_trace_are_said_to() -> None:
    """A distance that is seen 10 cm too large is a wanted one that is 10 cm larger."""
    trace = seen_too_high(planted.wall(Wall(), 2, 30.0), "distance", 0.1)

    found = diagnosed(program_of(FOLLOW), trace)

    (first,) = (each for each in found.candidates if each.is_taken)
    (said,) = (each for each in found.sentences if each.startswith("in other words"))
    assert "offset of distance is 0.099" in said or "offset of distance is 0.10" in said
    assert "offset of distance" in first.alike


def test_what_the_plain_spec_leaves_is_what_the_verdict_found() -> None:
    program = program_of(FOLLOW)
    report, study = judged(program, planted.wall(Wall(offset=0.4), 2, 30.0))
    assert study is not None
    assert program.fidelity is not None
    scene = scene_of(program, study)
    worst = max(report.variables, key=lambda each: each.declared.departure / each.tolerance)

    left = leaves(Bench(scene, study, program.fidelity), plain_fit(scene))

    size, _, _, name, times = left.split()[:5]
    assert name == f"{worst.name},"
    assert float(size) == pytest.approx(worst.declared.departure, rel=0.01)
    assert float(times) == pytest.approx(worst.declared.departure / worst.tolerance, rel=0.01)


def test_under_a_pass_nothing_is_said_to_be_wrong() -> None:
    """A robot a little fast, under tolerances that allow it."""
    program = program_of(FOLLOW)
    wide = Fidelity({"distance": 0.09, "heading": 0.2}, 2.0, {}, 0.0, "spec.yaml:1:1")
    program = replace(program, fidelity=wide)
    trace = planted.wall(Wall(speed=0.55), 2, 30.0)
    report, study = judged(program, trace)

    found = diagnose(program, trace, study, report)

    assert report.verdict is Verdict.PASS
    assert not any("structure" in each for each in found.sentences)
    assert found.sentences[0].startswith("what differs is allowed; it would be less with speed")
