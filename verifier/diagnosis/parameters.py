"""The scalars that can be refitted: numbers of the spec, gains and offsets of rates and sensors."""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.program import Binding, Kind, Program, State, Unit
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.courses import Course
from verifier.diagnosis.loosened import ONE, TIME_SCALE, gain_of, offset_of
from verifier.diagnosis.part_units import per_second
from verifier.fidelity.stretches.needs import Input, Needs, names_read, parts_of
from verifier.mixed_units import Slip, alternatives, unit_read
from verifier.report.diagnosis import CandidateKind, ParameterKind

NUDGE: Final = 1e-4
"""The difference for sensitivities, as a share of the number's size."""

SLIPPING: Final = (ParameterKind.INPUT_GAIN, ParameterKind.RATE_GAIN)
"""Gains whose fits begin at a wrong sign and at wrong units, too."""


@final
@dataclass(frozen=True, slots=True)
class Parameter:
    """A scalar that can be refitted.

    name: of the control, constant or variable it belongs to; empty for the time scale. size: a
    change of it that would be large. slips: units that a gain may stand for.
    """

    kind: ParameterKind
    name: str
    unit: Unit
    spec: float
    size: float
    low: float
    high: float
    origin: str
    slips: tuple[Slip, ...] = ()

    @property
    def label(self) -> str:
        """`v1`, `gain of turn`, `offset of the rate of x`."""
        match self.kind:
            case ParameterKind.CONTROL | ParameterKind.CONSTANT:
                return self.name
            case ParameterKind.TIME_SCALE:
                return "time scale of all rates"
            case ParameterKind.RATE_GAIN | ParameterKind.RATE_OFFSET:
                word = "gain" if self.kind is ParameterKind.RATE_GAIN else "offset"
                return f"{word} of the rate of {self.name}"
            case ParameterKind.INPUT_GAIN | ParameterKind.SENSOR_SCALE:
                return f"gain of {self.name}"
            case _:
                return f"offset of {self.name}"


def parameters_of(program: Program, needs: Needs) -> tuple[Parameter, ...]:
    """All scalars that could be refitted from this trace, told or not; see LIMITS for which are."""
    driven = {state.name: state for state in needs.driven if state.name in program.field.driven}
    bindings = {binding.name: binding for binding in program.bindings}
    return (
        *_constant_controls(program, needs),
        *_constants(program),
        *_of_inputs(program, needs, bindings),
        *(each for state in driven.values() for each in _of_rate(program, state)),
        *([] if program.field.is_map else [_time_scale(program)]),
        *(each for s in driven.values() for each in _of_sensor(s, bindings.get(s.name))),
    )


def effect_of(parameter: Parameter) -> Effect:
    """The effect of moving one parameter."""
    kinds = {
        ParameterKind.CONTROL: CandidateKind.PARAMETER,
        ParameterKind.CONSTANT: CandidateKind.PARAMETER,
        ParameterKind.TIME_SCALE: CandidateKind.GAIN,
        ParameterKind.RATE_GAIN: CandidateKind.GAIN,
        ParameterKind.INPUT_GAIN: CandidateKind.GAIN,
        ParameterKind.SENSOR_SCALE: CandidateKind.GAIN,
    }
    name = "value" if parameter.name else "factor"
    number = Number(
        name,
        parameter.unit,
        parameter.spec,
        NUDGE * parameter.size,
        parameter.low,
        parameter.high,
    )
    return Effect(
        kind=kinds.get(parameter.kind, CandidateKind.BIAS),
        applies_to=(parameter.name or "all rates",),
        label=parameter.label,
        numbers=(number,),
        apply=_Move(parameter),
        origin=parameter.origin,
        starts=_slipped(parameter) if parameter.kind in SLIPPING else (),
        parameter=parameter.kind,
        slips=parameter.slips,
    )


def _slipped(parameter: Parameter) -> tuple[Values, ...]:
    """Where else the fit of a gain begins."""
    sign = (-1.0,) if parameter.low < 0.0 else ()
    return tuple((each,) for each in (*sign, *(s.factor for s in parameter.slips if not s.offset)))


@final
@dataclass(frozen=True, slots=True)
class _Move:
    """Moves one parameter of a setting."""

    parameter: Parameter

    def __call__(self, setting: Altered, values: Values) -> Altered:
        name, (value,) = self.parameter.name, values
        match self.parameter.kind:
            case ParameterKind.CONTROL | ParameterKind.CONSTANT:
                return setting.moved(name, value)
            case ParameterKind.TIME_SCALE:
                return setting.moved(TIME_SCALE, value)
            case ParameterKind.RATE_GAIN:
                return setting.moved(gain_of(name), value)
            case ParameterKind.RATE_OFFSET:
                return setting.moved(offset_of(name), value)
            case _:
                return self._of_signal(setting, value)

    def _of_signal(self, setting: Altered, value: float) -> Altered:
        name = self.parameter.name
        match self.parameter.kind:
            case ParameterKind.INPUT_GAIN:
                return setting.with_course(name, _scaled(setting, name, value, 0.0))
            case ParameterKind.INPUT_OFFSET:
                return setting.with_course(name, _scaled(setting, name, 1.0, value))
            case ParameterKind.SENSOR_SCALE:
                return setting.with_seen(name, replace(setting.seen[name], scale=value))
            case _:
                return setting.with_seen(name, replace(setting.seen[name], offset=value))


def _scaled(setting: Altered, name: str, gain: float, offset: float) -> Course:
    course = setting.courses[name]
    return replace(course, values=gain * course.values + offset)


def _constant_controls(program: Program, needs: Needs) -> list[Parameter]:
    held = {each.name: each for each in needs.inputs if each.series is None}
    return [
        Parameter(
            ParameterKind.CONTROL,
            control.name,
            control.unit,
            held[control.name].value,
            _size(held[control.name].value, control.high - control.low),
            control.low,
            control.high,
            control.origin,
        )
        for control in program.controls
        if control.name in held
    ]


def _constants(program: Program) -> list[Parameter]:
    read = _read_outside_tables(program)
    return [
        Parameter(
            ParameterKind.CONSTANT,
            constant.name,
            constant.unit,
            constant.value,
            _size(constant.value, 1.0),
            -np.inf,
            np.inf,
            constant.origin,
        )
        for constant in program.constants
        if constant.name in read
    ]


def _read_outside_tables(program: Program) -> set[str]:
    """What a fit can move: all names of the formula, else those of the tables' coefficients."""
    if program.field.formula is not None:
        return {token for code in program.field.formula for token in code.tokens}
    return names_read(program)


def _of_inputs(program: Program, needs: Needs, bindings: dict[str, Binding]) -> list[Parameter]:
    """Gain and offset of each input that was measured.

    Where a domain has no room for the other sign, a gain has none.
    """
    units = {name: part.unit for name, part in parts_of(program).items()}
    found = []
    for given in varying(program, needs):
        assert given.series is not None, "an input that varies was measured"
        binding = bindings.get(given.name)
        gain, offset = _pair(
            (ParameterKind.INPUT_GAIN, ParameterKind.INPUT_OFFSET),
            given.name,
            units[given.name],
            float(np.ptp(given.series.values)),
            "" if binding is None else binding.origin,
        )
        slips = alternatives(unit_read(units[given.name], binding))
        lowest = 0.0 if given.low >= 0.0 or given.high <= 0.0 else -np.inf
        found += [replace(gain, low=lowest, slips=slips), offset]
    return found


def varying(program: Program, needs: Needs) -> tuple[Input, ...]:
    """The inputs of the field that were measured and are no names of modes."""
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    read = names_read(program)
    return tuple(
        each
        for each in needs.inputs
        if each.series is not None
        and each.name in read
        and each.name not in discrete
        and len(each.series.times) > 1
    )


def _of_rate(program: Program, state: State) -> list[Parameter]:
    if program.field.is_map and program.field.formula is None:
        return []
    kinds = (ParameterKind.RATE_GAIN, ParameterKind.RATE_OFFSET)
    unit = state.unit if program.field.is_map else per_second(state.unit)
    width = 0.1 * (state.high - state.low)
    gain, offset = _pair(kinds, state.name, unit, width, program.field.origin)
    return [replace(gain, slips=tuple(s for s in alternatives(state.unit) if s.is_classic)), offset]


def _time_scale(program: Program) -> Parameter:
    kind = ParameterKind.TIME_SCALE
    return Parameter(kind, "", ONE, 1.0, 1.0, 0.0, np.inf, program.field.origin)


def _of_sensor(state: State, binding: Binding | None) -> list[Parameter]:
    """An angle's sensor has no scale of its own: it would not close."""
    kinds = (ParameterKind.SENSOR_SCALE, ParameterKind.SENSOR_OFFSET)
    origin = state.origin if binding is None else binding.origin
    width = 0.1 * (state.high - state.low)
    scale, offset = _pair(kinds, state.name, state.unit, width, origin)
    slips = alternatives(unit_read(state.unit, binding))
    return [offset] if state.kind is Kind.PERIODIC else [replace(scale, slips=slips), offset]


def _pair(
    kinds: tuple[ParameterKind, ParameterKind], name: str, unit: Unit, width: float, origin: str
) -> list[Parameter]:
    """A factor and a summand."""
    return [
        Parameter(kinds[0], name, ONE, 1.0, 1.0, -np.inf, np.inf, origin),
        Parameter(kinds[1], name, unit, 0.0, width or 1.0, -np.inf, np.inf, origin),
    ]


def _size(value: float, otherwise: float) -> float:
    return abs(value) or otherwise
