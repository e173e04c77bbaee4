"""States that the log tells late: named, told apart from late inputs where that can be done."""

from dataclasses import replace

import numpy as np
import pytest

from runtime.program import Program
from tests.study.diagnosis import diagnosed, program_of
from tests.study.planted import Drive, Wall, drive, wall
from verifier.diagnosis.altered import Seen
from verifier.diagnosis.candidates.clocks import effects_on_clocks
from verifier.diagnosis.naming import label_of
from verifier.diagnosis.profiled import left_over
from verifier.diagnosis.scene import Scene, scene_of
from verifier.diagnosis.sensitivities import noise_floor
from verifier.fidelity.verify import judged
from verifier.report.diagnosis import CandidateKind, Diagnosis
from verifier.traces.trace import Trace


def table(program: Program) -> Program:
    """The same, of a table whose columns share a clock."""
    bindings = tuple(replace(each, path=each.name) for each in program.bindings)
    return replace(program, bindings=bindings)


def late(trace: Trace, names: tuple[str, ...], samples: int) -> Trace:
    """With series that deliver, at the stamps of the others, what was some samples before."""
    series = dict(trace.series)
    for name, own in trace.series.items():
        values = own.values[:-samples] if name in names else own.values[samples:]
        if len(own.times) == max(len(each.times) for each in trace.series.values()):
            series[name] = replace(own, times=own.times[samples:], values=values)
    return replace(trace, series=series)


def scene(program: Program, trace: Trace) -> Scene:
    _, study = judged(program, trace)
    assert study is not None
    return scene_of(program, study)


def taken(found: Diagnosis) -> list[tuple[CandidateKind, tuple[str, ...]]]:
    return [(each.kind, each.applies_to) for each in found.candidates if each.is_taken]


def test_one_state_of_a_table_that_is_late_is_named_with_its_delay() -> None:
    trace = late(drive(Drive(), 3), ("heading",), 6)

    found = diagnosed(table(program_of("drive")), trace)

    assert taken(found) == [(CandidateKind.LATE_LOG, ("heading",))]
    (number,) = found.candidates[0].numbers
    assert number.interval.low < -0.3 < number.interval.high
    assert number.interval.high - number.interval.low < 0.03
    assert "the log tells heading 0.3" in found.candidates[0].sentence
    assert all(each.after < 0.2 * each.tolerance for each in found.after)


def test_delays_are_called_late_or_early_by_their_sign() -> None:
    found = effects_on_clocks(scene(table(program_of("drive")), drive(Drive(), 1, seconds=30.0)))
    heading = found[-1]

    assert label_of(heading, (-0.3,)) == "heading logged late"
    assert label_of(heading, (0.3,)) == "heading logged early"


def test_all_states_late_is_all_inputs_late_in_other_words() -> None:
    trace = late(wall(Wall(), 2), ("distance", "heading"), 6)

    found = diagnosed(table(program_of("wall_follow.yaml")), trace)

    assert taken(found) == [(CandidateKind.DEAD_TIME, ("wanted",))]
    assert found.candidates[0].alike[0] == "distance and heading logged late"
    (other,) = (s for s in found.sentences if s.startswith("in other words"))
    assert "the log tells distance and heading 0.3" in other


@pytest.mark.parametrize("shift", [0.3, -0.3])
def test_a_sensor_that_is_off_sees_what_inputs_that_are_off_the_other_way_make(
    shift: float,
) -> None:
    """Two ways to one trace, starts fitted; the same but for how paths are read between steps."""
    own = scene(program_of("wall_follow.yaml"), wall(Wall(), 1, seconds=40.0, noise=0.1))
    seen = {name: Seen(delay=shift) for name in own.plain.seen}
    moved = {name: replace(each, shift=shift) for name, each in own.plain.courses.items()}
    settings = [replace(own.plain, seen=seen), replace(own.plain, courses=moved), own.plain]

    first, second, plain = left_over(own, settings, [own.start] * 3, [noise_floor(own)] * 3)

    assert np.std(plain - second) > 0.02
    assert np.std(first - second) < 0.05 * np.std(plain - second)


def test_every_state_all_states_and_all_inputs_of_a_table_are_tried() -> None:
    found = effects_on_clocks(scene(table(program_of("drive")), drive(Drive(), 1, seconds=30.0)))

    assert [each.applies_to for each in found] == [
        ("speed", "turn"),
        ("x", "y", "heading"),
        ("x",),
        ("y",),
        ("heading",),
    ]
