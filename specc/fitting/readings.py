"""How a log is to be read, as numbers of `trace:` entries: delays, scales, offsets and units."""

import math
from collections.abc import Sequence
from typing import Final

from runtime.program import Binding, Program
from specc.fitting.aims import Aim, AnyAim, UnitAim
from verifier.fidelity.stretches.needs import parts_of
from verifier.mixed_units import alternatives, unit_read
from verifier.report.diagnosis import Candidate, CandidateKind, ParameterKind, Refitted

OF_INPUTS: Final = (ParameterKind.INPUT_GAIN, ParameterKind.INPUT_OFFSET)


def delays(late: Sequence[Candidate], bindings: dict[str, Binding]) -> list[Aim | str]:
    """The entries of all that comes late, by one candidate or by several.

    A shift of what acts is the opposite of a delay of the log; it comes on top of the spec's own.
    """
    found: list[Aim | str] = []
    for name in dict.fromkeys(name for each in late for name in each.applies_to):
        own = [each for each in late if name in each.applies_to]
        said = "; ".join(each.sentence for each in own)
        if not _is_bound(name, bindings):
            found.append(_unbound(said, name))
            continue
        shifts = [each.numbers[0] for each in own]
        value = bindings[name].delay - sum(shift.value for shift in shifts)
        half = math.hypot(*(0.5 * (s.interval.high - s.interval.low) for s in shifts))
        path = ("trace", name, "delay")
        found.append(Aim(path, f"delay of {name}", value, half, "s", 1.0, said))
    return found


def affine(
    name: str, moved: dict[ParameterKind, Refitted], program: Program, bindings: dict[str, Binding]
) -> list[Aim | str]:
    """The scale and the offset of one entry.

    moved: in the order in which they act. Of an input, `gain * v + offset` takes the place of v;
    of a sensor, v is `scale * x + offset`.
    """
    said = "; ".join(each.sentence for each in moved.values())
    if not _is_bound(name, bindings):
        return [_unbound(said, name)]
    factor, summand = _for_inputs(moved) if set(moved) & set(OF_INPUTS) else _for_sensors(moved)
    binding, found = bindings[name], list[Aim | str]()
    own = parts_of(program)[name].unit
    if factor != 1.0:
        value = factor * binding.scale
        half = _relative(moved, (ParameterKind.INPUT_GAIN, ParameterKind.SENSOR_SCALE)) * abs(value)
        found.append(Aim(("trace", name, "scale"), f"scale of {name}", value, half, "1", 1.0, said))
    offset = factor * binding.offset + summand
    if offset != binding.offset:
        offsets = (ParameterKind.INPUT_OFFSET, ParameterKind.SENSOR_OFFSET)
        half = max([_half(moved[kind]) for kind in offsets if kind in moved], default=0.0)
        half = half or abs(offset) * _relative(moved, tuple(moved))
        path = ("trace", name, "offset")
        found.append(Aim(path, f"offset of {name}", offset, half, own.text, own.scale, said))
    return found


def mended(
    candidate: Candidate, program: Program, bindings: dict[str, Binding]
) -> list[AnyAim | str]:
    """A wrong sign or unit in the log, of one variable or of several."""
    return [_mended(name, candidate, program, bindings) for name in candidate.applies_to]


def _mended(
    name: str, candidate: Candidate, program: Program, bindings: dict[str, Binding]
) -> AnyAim | str:
    if not _is_bound(name, bindings):
        return _unbound(candidate.sentence, name)
    binding = bindings[name]
    if candidate.kind is CandidateKind.SIGN:
        path = ("trace", name, "scale")
        scale = -binding.scale
        return Aim(path, f"scale of {name}", scale, 0.0, "1", 1.0, candidate.sentence)
    own = parts_of(program)[name].unit
    slips = alternatives(unit_read(own, binding))
    slip = next((each for each in slips if each.words == candidate.slip), None)
    if slip is not None and slip.written:
        path = ("trace", name, "unit")
        return UnitAim(path, f"unit of {name}", slip.written, candidate.sentence)
    if slip is not None and slip.factor == 1.0:
        offset = binding.offset + slip.offset
        path, what = ("trace", name, "offset"), f"offset of {name}"
        return Aim(path, what, offset, 0.0, own.text, own.scale, candidate.sentence)
    return f"{candidate.sentence}; write the unit of the log into 'trace: {name}:' by hand"


def own_number(found: Refitted, program: Program) -> Aim | str:
    """A constant or a control that the recording held at one value."""
    half = 0.5 * (found.interval.high - found.interval.low)
    bindings = {binding.name: binding for binding in program.bindings}
    match found.kind:
        case ParameterKind.CONSTANT:
            path = ("constants", found.name, "value")
        case ParameterKind.CONTROL:
            is_told = found.name in bindings and bindings[found.name].constant is not None
            path = (
                ("trace", found.name, "constant") if is_told else ("control", found.name, "default")
            )
        case _:
            return f"{found.sentence}; no number of the spec stands for it"
    unit = found.unit
    return Aim(path, found.name, found.value, half, unit.text, unit.scale, found.sentence)


def _for_inputs(moved: dict[ParameterKind, Refitted]) -> tuple[float, float]:
    factor, summand = 1.0, 0.0
    for kind, each in moved.items():
        if kind is ParameterKind.INPUT_GAIN:
            factor, summand = each.value * factor, each.value * summand
        elif kind is ParameterKind.INPUT_OFFSET:
            summand += each.value
    return factor, summand


def _for_sensors(moved: dict[ParameterKind, Refitted]) -> tuple[float, float]:
    scale = moved[ParameterKind.SENSOR_SCALE].value if ParameterKind.SENSOR_SCALE in moved else 1.0
    offset = moved.get(ParameterKind.SENSOR_OFFSET)
    return 1.0 / scale, 0.0 if offset is None else -offset.value / scale


def _half(found: Refitted) -> float:
    return 0.5 * (found.interval.high - found.interval.low)


def _relative(moved: dict[ParameterKind, Refitted], kinds: tuple[ParameterKind, ...]) -> float:
    return max(_half(each) / abs(each.value) for kind, each in moved.items() if kind in kinds)


def _is_bound(name: str, bindings: dict[str, Binding]) -> bool:
    return name in bindings and bool(bindings[name].path)


def _unbound(said: str, name: str) -> str:
    return f"{said}; 'trace:' has no entry for {name} that could say so"
