"""From a diagnosis to numbers of the spec: held against what the numbers mean."""

from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from runtime.program import Binding, Control, Field, Kind, Origin, Program, Role, State, Unit
from specc.fitting.aims import Aim, UnitAim
from specc.fitting.reading import aims_of
from specc.fitting.readings import affine
from verifier.report.diagnosis import (
    Candidate,
    CandidateKind,
    Diagnosis,
    Evidence,
    FittedNumber,
    ParameterKind,
    Refitted,
    Told,
)
from verifier.report.report import Interval

ONE, METRE, RADIAN = Unit("1", 1.0), Unit("m", 1.0), Unit("rad", 1.0)
NUMBER = st.floats(-5.0, 5.0).filter(lambda value: abs(value) > 0.1)


def binding(name: str, unit: Unit, scale: float = 1.0, offset: float = 0.0) -> Binding:
    return Binding(name, f"/{name}.data", unit, 0.0, scale, offset, None, (), "")


def program(*bindings: Binding) -> Program:
    places = ("robot", "world")
    x = State("x", METRE, -9, 9, Role.BOTH, Kind.CONTINUOUS, 0.0, None, (), places, "", "")
    heading = replace(x, name="heading", unit=RADIAN)
    controls = (
        Control("v", METRE, -9, 9, 0.5, "", ""),
        Control("k", METRE, -9, 9, 0.5, "", ""),
    )
    return Program(
        name="scene",
        about="",
        states=(x, heading),
        controls=controls,
        constants=(),
        outputs=(),
        field=Field(("x", "heading"), "formula", 0.0, (), (), (), None, ""),
        realizes=(),
        feasibility=None,
        fidelity=None,
        judge_when=None,
        bindings=bindings,
        claims=(),
        source=Origin("spec.yaml", "", ""),
    )


def number(kind: ParameterKind, name: str, value: float) -> Refitted:
    interval = Interval(value - 0.01, value + 0.01)
    return Refitted(
        kind,
        name,
        METRE,
        0.0,
        value,
        interval,
        is_moved=True,
        origin="",
        sentence=f"{name} is {value}",
    )


def candidate(
    kind: CandidateKind,
    *names: str,
    value: float = 0.0,
    label: str = "",
    share: float = 0.95,
    slip: str = "",
) -> Candidate:
    fitted = FittedNumber("value", ONE, 0.0, value, Interval(value - 0.01, value + 0.01))
    evidence = Evidence(20, share, 40.0, ())
    return Candidate(
        kind,
        names,
        label,
        (fitted,),
        evidence,
        is_taken=True,
        alike=(),
        origin="",
        claim=f"{kind} of {names}",
        sentence=f"{kind} of {names}; it explains 95 %",
        slip=slip,
    )


def diagnosis(*found: Refitted | Candidate, told: Told = Told.SAME_STRUCTURE) -> Diagnosis:
    candidates = tuple(each for each in found if isinstance(each, Candidate))
    numbers = tuple(each for each in found if isinstance(each, Refitted))
    return Diagnosis(told, ("why",), numbers, (), candidates, ())


@given(NUMBER, NUMBER, NUMBER, NUMBER, st.sampled_from(["gain", "offset"]), NUMBER)
def test_gain_and_offset_of_an_input_are_read_as_the_robot_has_them(
    scale: float, offset: float, gain: float, summand: float, first: str, raw: float
) -> None:
    assume(gain != 1.0)
    parts = [
        number(ParameterKind.INPUT_GAIN, "v", gain),
        number(ParameterKind.INPUT_OFFSET, "v", summand),
    ]
    order = {each.kind: each for each in (parts if first == "gain" else parts[::-1])}
    bound = binding("v", METRE, scale, offset)

    found = affine("v", order, program(bound), {"v": bound})

    moved = {aim.path[-1]: aim.value for aim in found if isinstance(aim, Aim)}
    read = moved["scale"] * raw + moved.get("offset", offset)
    before = scale * raw + offset
    wanted = gain * before + summand if first == "gain" else gain * (before + summand)
    assert read == pytest.approx(wanted, abs=1e-9)


@given(NUMBER, NUMBER, NUMBER, NUMBER, NUMBER)
def test_a_sensor_is_read_back_to_the_state_that_it_measures(
    scale: float, offset: float, factor: float, summand: float, state: float
) -> None:
    assume(factor != 1.0)
    order = {
        ParameterKind.SENSOR_SCALE: number(ParameterKind.SENSOR_SCALE, "x", factor),
        ParameterKind.SENSOR_OFFSET: number(ParameterKind.SENSOR_OFFSET, "x", summand),
    }
    bound = binding("x", METRE, scale, offset)
    raw = (factor * state + summand - offset) / scale  # what stands in the log

    found = affine("x", order, program(bound), {"x": bound})

    moved = {aim.path[-1]: aim.value for aim in found if isinstance(aim, Aim)}
    assert moved["scale"] * raw + moved.get("offset", offset) == pytest.approx(state, abs=1e-9)


def test_a_late_log_adds_to_the_delay_that_the_spec_has() -> None:
    bound = replace(binding("v", METRE), delay=0.1)
    late = candidate(CandidateKind.LATE_LOG, "v", value=-0.3)

    [aim] = aims_of(program(bound), diagnosis(late, told=Told.STRUCTURE_DIFFERS)).aims

    assert isinstance(aim, Aim)
    assert aim.path == ("trace", "v", "delay")
    assert aim.value == pytest.approx(0.4)


def test_a_clock_moves_all_that_it_stamps() -> None:
    both = candidate(CandidateKind.CLOCK_OFFSET, "v", "x", value=-0.2)

    told = aims_of(program(binding("v", METRE), binding("x", METRE)), diagnosis(both))

    assert [aim.path for aim in told.aims] == [("trace", "v", "delay"), ("trace", "x", "delay")]


def test_a_late_log_and_a_clock_add_up() -> None:
    clock = candidate(CandidateKind.CLOCK_OFFSET, "v", "x", value=-0.2)
    late = candidate(CandidateKind.LATE_LOG, "v", value=-0.3)
    both = program(binding("v", METRE), binding("x", METRE))

    found = aims_of(both, diagnosis(clock, late)).aims

    delays = {aim.path[1]: aim.value for aim in found if isinstance(aim, Aim)}
    assert len(found) == 2
    assert delays == pytest.approx({"v": 0.5, "x": 0.2})


@pytest.mark.parametrize(
    ("unit", "words", "factor", "text"),
    [
        (RADIAN, "degrees for radians", 0.0174533, "deg"),
        (Unit("deg", 0.0174533), "radians for degrees", 57.29578, "rad"),
    ],
)
def test_a_unit_slip_becomes_the_unit_of_the_log(
    unit: Unit, words: str, factor: float, text: str
) -> None:
    slip = candidate(CandidateKind.UNIT_SLIP, "heading", value=factor, slip=words)

    [aim] = aims_of(program(binding("heading", unit)), diagnosis(slip)).aims

    assert isinstance(aim, UnitAim)
    assert (aim.path, aim.text) == (("trace", "heading", "unit"), text)


def test_a_slip_that_its_unit_would_not_mend_is_left_to_people() -> None:
    words = "radians for degrees"
    slip = candidate(CandidateKind.UNIT_SLIP, "heading", value=57.29578, slip=words)

    told = aims_of(program(binding("heading", RADIAN)), diagnosis(slip))

    assert not told.aims
    assert told.beyond[0].endswith("by hand")


def test_a_wrong_sign_turns_the_scale() -> None:
    turned = candidate(CandidateKind.SIGN, "x", value=-1.0, label="sign of x")

    [aim] = aims_of(program(binding("x", METRE, 2.0)), diagnosis(turned)).aims

    assert isinstance(aim, Aim)
    assert (aim.value, aim.half) == (-2.0, 0.0)


@pytest.mark.parametrize("section", ["control", "trace"])
def test_a_control_moves_where_the_spec_says_what_it_was(section: str) -> None:
    told = replace(binding("k", METRE), path="", constant=0.5)
    moved = number(ParameterKind.CONTROL, "k", 0.46)

    [aim] = aims_of(
        program(*([told] if section == "trace" else [])),
        diagnosis(moved, candidate(CandidateKind.PARAMETER, "k")),
    ).aims

    assert aim.path == (section, "k", "constant" if section == "trace" else "default")


@pytest.mark.parametrize(
    "found",
    [
        (candidate(CandidateKind.DEAD_TIME, "v", value=0.3),),
        (candidate(CandidateKind.SATURATION, "x", value=0.3),),
        (
            candidate(CandidateKind.GAIN, "x", value=1.2),
            number(ParameterKind.RATE_GAIN, "x", 1.2),
        ),
        (
            candidate(CandidateKind.SIGN, "x", value=-1.0),
            number(ParameterKind.RATE_GAIN, "x", -1.0),
        ),
    ],
)
def test_what_is_no_number_of_the_spec_is_beyond_it(
    found: tuple[Refitted | Candidate, ...],
) -> None:
    bound = (binding("x", METRE), binding("v", METRE))

    told = aims_of(program(*bound), diagnosis(*found, told=Told.STRUCTURE_DIFFERS))

    assert not told.aims
    assert len(told.beyond) == 1


def test_numbers_that_explain_little_leave_the_structure_open() -> None:
    weak = candidate(CandidateKind.LATE_LOG, "v", value=-0.3, share=0.3)

    told = aims_of(program(binding("v", METRE)), diagnosis(weak))

    assert told.left == ("they explain 30 % of the error beyond noise only",)


def test_where_nothing_is_named_the_diagnosis_speaks() -> None:
    assert aims_of(program(), diagnosis(told=Told.STRUCTURE_DIFFERS)).beyond == ("why",)
    assert aims_of(program(), diagnosis(told=Told.CANNOT_TELL)).choices == ("why",)
    assert aims_of(program(), diagnosis(told=Told.NO_DIFFERENCE)) == aims_of(program(), diagnosis())
