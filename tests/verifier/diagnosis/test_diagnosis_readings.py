"""Logs that are to be read otherwise: wrong signs, units, and names of modes."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from runtime.program import Program, Unit
from tests.study import planted
from tests.study.diagnosis import DRIVE, diagnosed, program_of
from tests.study.planted import Drive
from tests.study.robots import BASE, SHUTTLE, drive, measured
from verifier.mixed_units import alternatives, slip_by
from verifier.report.diagnosis import CandidateKind, Diagnosis
from verifier.traces.trace import Trace


def taken(found: Diagnosis) -> list[str]:
    return [each.label for each in found.candidates if each.is_taken]


def restless_base() -> tuple[Program, Trace]:
    """Moves by itself beside its field, so that no residual is as small as the noise."""
    program = BASE.program()
    drives = drive(BASE, 1, 24.0, 0.0, 1.0, 1)
    return program, measured(program, BASE, drives, 0, 20.0, 1.0, 0.0, 1)


def test_a_wrong_sign_is_no_unit_of_an_angle() -> None:
    """A heading read 57 times too large, or hardly at all, leaves little only by its size."""
    program, trace = restless_base()

    found = diagnosed(program, planted.scaled(trace, "heading", -1.0))

    assert taken(found) == ["sign of heading"]


def in_centimetres(trace: Trace) -> Trace:
    return planted.scaled(planted.scaled(trace, "x", 100.0), "y", 100.0)


def in_rpm(trace: Trace) -> Trace:
    return planted.scaled(trace, "turn", 30.0 / np.pi)


def in_kilometres_per_hour(trace: Trace) -> Trace:
    return planted.scaled(trace, "speed", 3.6)


@pytest.mark.parametrize(
    ("change", "label"),
    [
        (in_centimetres, "centimetres for metres in x and y"),
        (in_rpm, "rpm for rad/s in turn"),
        (in_kilometres_per_hour, "km/h for m/s in speed"),
    ],
)
def test_a_log_in_another_unit_is_named_by_it(change: Callable[[Trace], Trace], label: str) -> None:
    program = program_of(DRIVE)
    narrow = {"speed": (0.0, 1.1), "turn": (-1.0, 1.0)}
    controls = tuple(
        replace(each, low=narrow[each.name][0], high=narrow[each.name][1])
        for each in program.controls
    )
    room = tuple(
        replace(each, low=-60.0, high=60.0) if each.name != "heading" else each
        for each in program.states
    )
    program = replace(program, controls=controls, states=room)

    found = diagnosed(program, change(planted.drive(Drive(), 1, 20.0)))

    assert taken(found) == [label]


def test_two_modes_in_each_other_s_place_are_named() -> None:
    program = SHUTTLE.program()
    trace = measured(program, SHUTTLE, drive(SHUTTLE, 1, 30.0, 0.0, 0.0, 2), 0, 20.0, 1.0, 0.0, 2)
    going = trace.series["going"]
    other = replace(going, values=1.0 - going.values)

    found = diagnosed(program, replace(trace, series={**trace.series, "going": other}))

    (named,) = (each for each in found.candidates if each.is_taken)
    assert named.kind is CandidateKind.EXCHANGED_VALUES
    assert named.label == "forward and back exchanged in going"


@pytest.mark.parametrize(
    ("unit", "words", "number", "si"),
    [
        (Unit("K", 1.0), "Celsius for kelvin", 20.0, 293.15),
        (Unit("K", 1.0), "Fahrenheit for kelvin", 68.0, 293.15),
        (Unit("1", 1.0), "percent for shares", 35.0, 0.35),
        (Unit("%", 0.01), "shares for percent", 0.35 * 0.01, 0.35),
        (Unit("m/s", 1.0), "km/h for m/s", 36.0, 10.0),
        (Unit("km/h", 1.0 / 3.6), "m/s for km/h", 10.0 / 3.6, 10.0),
        (Unit("rad/s", 1.0), "rpm for rad/s", 60.0, 2.0 * np.pi),
        (Unit("rpm", np.pi / 30.0), "rad/s for rpm", 2.0 * np.pi * np.pi / 30.0, 2.0 * np.pi),
        (Unit("cm", 0.01), "metres for centimetres", 0.03, 3.0),
        (Unit("cm^2", 1e-4), "metres for centimetres", 2.0 * 1e-4, 2.0),
    ],
)
def test_a_slip_mends_what_was_read(unit: Unit, words: str, number: float, si: float) -> None:
    """number: the SI value that was read in the wrong unit."""
    (slip,) = (each for each in alternatives(unit) if each.words == words)

    assert slip.factor * number + slip.offset == pytest.approx(si)


def test_a_gain_that_is_near_no_unit_is_none() -> None:
    slips = alternatives(Unit("m/s", 1.0))

    assert slip_by(0.2778, slips) is not None
    assert slip_by(0.3, slips) is None
    assert slip_by(np.pi / 180.0, slips) is None


def test_a_domain_without_room_for_the_other_sign_has_none() -> None:
    """The speed of this base is never negative; its turn rate may be."""
    program = program_of(DRIVE)
    forward = tuple(
        replace(each, low=0.0) if each.name == "speed" else each for each in program.controls
    )
    trace = planted.scaled(planted.drive(Drive(), 1, 20.0), "y", -1.0)

    found = diagnosed(replace(program, controls=forward), trace)

    labels = {each.label for each in found.candidates}
    assert taken(found) == ["sign of y"]
    assert "sign of speed" not in labels
