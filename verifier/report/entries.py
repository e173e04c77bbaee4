"""What an entry of `trace:` would have to say, for the log to be read as the diagnosis has it."""

import re

from runtime.program import Binding, Program
from verifier.fidelity.stretches.needs import parts_of
from verifier.mixed_units import alternatives, unit_read
from verifier.report.diagnosis import Candidate, CandidateKind, ParameterKind
from verifier.report.wording import number, quantity


def entries_of(found: Candidate, program: Program) -> tuple[str, ...]:
    """`target: {path: target, delay: 0.279 s}`, one for each name; none where no entry says it."""
    bindings = {each.name: each for each in program.bindings if each.path}
    said = [
        (bindings[name], _key(found, bindings[name], program))
        for name in found.applies_to
        if name in bindings
    ]
    return tuple(_line(binding, key) for binding, key in said if key)


def _key(found: Candidate, binding: Binding, program: Program) -> str:
    """The key and its value, worked out from what the entry says already."""
    unit = parts_of(program)[binding.name].unit
    if found.kind in {CandidateKind.LATE_LOG, CandidateKind.CLOCK_OFFSET}:
        return f"delay: {number(binding.delay - found.numbers[0].value)} s"
    if found.kind is CandidateKind.SIGN:
        return f"scale: {-binding.scale:g}"
    if found.kind is CandidateKind.UNIT_SLIP:
        slips = alternatives(unit_read(unit, binding))
        slip = next((each for each in slips if each.words == found.slip), None)
        return f"unit: {slip.written}" if slip is not None and slip.written else ""
    if found.parameter is ParameterKind.SENSOR_OFFSET:
        return f"offset: {quantity(binding.offset - found.numbers[0].value, unit)}"
    if found.parameter is ParameterKind.SENSOR_SCALE and binding.offset == 0.0:
        return f"scale: {number(binding.scale / found.numbers[0].value)}"
    return ""


def _line(binding: Binding, key: str) -> str:
    """The whole entry where it is a path alone, else the key that changes in it."""
    is_path = (binding.delay, binding.scale, binding.offset, binding.noise) == (0.0, 1.0, 0.0, None)
    if not is_path:
        return f"{binding.name}: {{..., {key}}}"
    path = binding.path if re.fullmatch(r"[\w/.@-]+", binding.path) else f"'{binding.path}'"
    return f"{binding.name}: {{path: {path}, {key}}}"
