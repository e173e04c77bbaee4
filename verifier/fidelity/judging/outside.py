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
from runtime.program import Binding, Control, Kind, Program, State
from verifier.fidelity.stretches.needs import Needs
from verifier.fidelity.stretches.segments import inside_domains
from verifier.fidelity.stretches.spans import intersect, length, spans_of
from verifier.mixed_units import PLAUSIBLE, Slip, alternatives, unit_read
from verifier.report.wording import listed, percent, span
from verifier.traces.trace import Series

MOSTLY: Final = 0.5
"""Worth a word from this share of the trace on."""
RARE: Final = "mrad"
"""A unit that nobody is asked about where degrees would do."""
USUAL: Final = (0.01, 0.99)
"""What is called seen lies between these quantiles: single outliers are no range."""


@final
@dataclass(frozen=True, slots=True)
class Outside:
    """One variable that lies outside its domain for most of the trace: why, and what to do.

    is_far: whether it mostly lies by more than the width of its domain beyond it, or is an angle in
    another unit: what was meant was then something else. is_slip: whether it would lie inside if it
    was logged in another unit.
    """

    reason: str
    advice: str
    is_far: bool
    is_slip: bool


def outside_of(program: Program, needs: Needs) -> tuple[Outside, ...]:
    """The variables that do."""
    base = needs.series[needs.base].times
    whole = spans_of([(float(base[0]), float(base[-1]))])
    bindings = {binding.name: binding for binding in program.bindings}
    found = []
    for part, series, inside in inside_domains(program, needs, whole):
        share = 1.0 - length(intersect(whole, inside)) / max(length(whole), 1e-300)
        if share >= MOSTLY:
            found.append(told_outside(part, series, series.values, share, bindings.get(part.name)))
    return tuple(found)


def told_outside(
    part: State | Control, series: Series, values: Array, share: float, binding: Binding | None
) -> Outside:
    """Of a variable whose `values` lie outside for a share of the trace."""
    low, high = (float(end) for end in np.quantile(values, USUAL))
    reason = (
        f"{part.name} lies outside its domain for {percent(share)} of the trace, which can't be"
        f" judged: it reads {span(low, high, part.unit)}, the domain is"
        f" {span(part.low, part.high, part.unit)}"
    )
    is_far = _is_far(part, values)
    used = binding or own_binding(part, series.path)
    fitting = [
        (what, entry)
        for what, entry, read in other_readings(part, used, values)
        if used.path and np.mean((read >= part.low) & (read <= part.high)) >= PLAUSIBLE
    ]
    if any(what == "deg" for what, _ in fitting):
        fitting = [each for each in fitting if each[0] != RARE]
    if fitting:
        what = " or ".join(what for what, _ in fitting)
        written = _to_write(used, fitting[0][1])
        if binding is None:
            written = f"log it in {part.unit.text}, or {written} of its spec"
        if len(fitting) > 1:
            written += f"; if in {listed([what for what, _ in fitting[1:]])}, with that unit"
        return Outside(
            f"{reason}; read in {what}, it would lie inside",
            f"if {part.name} was logged in {fitting[0][0]}, {written}",
            is_far,
            is_slip=True,
        )
    if binding is None:
        return Outside(
            reason,
            f"log {part.name} in {part.unit.text}; if the robot really goes there, widen the"
            " domain",
            is_far,
            is_slip=False,
        )
    return Outside(
        reason,
        f"check the unit, scale and offset of {part.name} in `trace:`; if the robot really goes"
        " there, widen the domain",
        is_far,
        is_slip=False,
    )


def _is_far(part: State | Control, values: Array) -> bool:
    if isinstance(part, State) and part.kind is Kind.PERIODIC:
        return True
    beyond = np.median(np.maximum(values - part.high, part.low - values))
    return bool(beyond > part.high - part.low)


def own_binding(part: State | Control, path: str) -> Binding:
    """How a variable is read that stands in the log under its own name."""
    return Binding(part.name, path, part.unit, 0.0, 1.0, 0.0, None, (), part.origin)


def other_readings(
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
