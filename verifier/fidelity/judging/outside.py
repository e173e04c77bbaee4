"""Variables that lie outside their domain for most of a trace, and what may be behind that.

Mostly it is a unit: a heading logged in degrees, a temperature in degrees Celsius. More data of
that kind decides nothing, so it is told before anything else.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Binding, Control, Program, State
from verifier.fidelity.stretches.needs import Needs
from verifier.fidelity.stretches.segments import inside_domains
from verifier.fidelity.stretches.spans import intersect, length, spans_of
from verifier.mixed_units import PLAUSIBLE, Slip, alternatives, unit_read
from verifier.report.wording import percent, span

MOSTLY: Final = 0.5
"""Worth a word from this share of the trace on."""
USUAL: Final = (0.01, 0.99)
"""What is called seen lies between these quantiles: single outliers are no range."""


@final
@dataclass(frozen=True, slots=True)
class Outside:
    """One variable that lies outside its domain for most of the trace: why, and what to do."""

    reason: str
    advice: str


def outside_of(program: Program, needs: Needs) -> tuple[Outside, ...]:
    """The variables that do."""
    base = needs.series[needs.base].times
    whole = spans_of([(float(base[0]), float(base[-1]))])
    bindings = {binding.name: binding for binding in program.bindings}
    found = []
    for part, series, inside in inside_domains(program, needs, whole):
        share = 1.0 - length(intersect(whole, inside)) / max(length(whole), 1e-300)
        if share >= MOSTLY:
            found.append(_told(part, series.values, share, bindings.get(part.name)))
    return tuple(found)


def _told(part: State | Control, values: Array, share: float, binding: Binding | None) -> Outside:
    low, high = (float(end) for end in np.quantile(values, USUAL))
    reason = (
        f"{part.name} lies outside its domain for {percent(share)} of the trace, which can't be"
        f" judged: it reads {span(low, high, part.unit)}, the domain is"
        f" {span(part.low, part.high, part.unit)}"
    )
    if binding is not None and binding.path:
        for what, entry, read in _other_readings(part, binding, values):
            if np.mean((read >= part.low) & (read <= part.high)) >= PLAUSIBLE:
                return Outside(
                    f"{reason}; read in {what}, it would lie inside",
                    f"if {part.name} was logged in {what}, {_to_write(binding, entry)}",
                )
    return Outside(
        reason,
        f"check the unit, scale and offset of {part.name} in `trace:`; if the robot really goes"
        " there, widen the domain",
    )


def _other_readings(
    part: State | Control, binding: Binding, values: Array
) -> Iterator[tuple[str, str, Array]]:
    """The same log in other units: their name, what to write, and what would be read."""
    for slip in alternatives(unit_read(part.unit, binding)):
        entry = _entry(slip, binding)
        if entry:
            read = slip.factor * (values - binding.offset) + binding.offset + slip.offset
            yield slip.written or f"degrees {slip.words.split()[0]}", entry, read


def _entry(slip: Slip, binding: Binding) -> str:
    """What to write; empty where neither a unit nor another zero mends it."""
    if slip.written:
        return f"unit: {slip.written}"
    if slip.offset == 0.0:
        return ""
    scale = slip.factor * binding.scale
    zero = f"offset: {binding.offset + slip.offset:.6g} K"
    return zero if scale == 1.0 else f"scale: {scale:.6g}, {zero}"


def _to_write(binding: Binding, entry: str) -> str:
    """The whole entry of the trace, where it is a path alone; else what to add to it."""
    is_path = (binding.delay, binding.scale, binding.offset, binding.noise) == (0.0, 1.0, 0.0, None)
    if not is_path:
        return f"add `{entry}` to its entry in `trace:`"
    path = binding.path if re.fullmatch(r"[\w/.@-]+", binding.path) else f"'{binding.path}'"
    return f"write `{binding.name}: {{path: {path}, {entry}}}` in `trace:`"
