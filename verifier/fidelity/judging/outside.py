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
from runtime.program import Binding, Control, Program, State, Unit
from spec_schema.units import UnitFault, parse_unit
from verifier.fidelity.stretches.needs import Needs
from verifier.fidelity.stretches.segments import inside_domains
from verifier.fidelity.stretches.spans import intersect, length, spans_of
from verifier.report.wording import percent, span

MOSTLY: Final = 0.5
"""Worth a word from this share of the trace on."""
PLAUSIBLE: Final = 0.9
"""A unit is suggested that puts this share of the samples into the domain."""
USUAL: Final = (0.01, 0.99)
"""What is called seen lies between these quantiles: single outliers are no range."""
ANGLES: Final[tuple[str, ...]] = ("deg", "rad", "mrad", "deg/s", "rpm", "rad/s")
UNITS: Final[tuple[str, ...]] = (
    *("mm", "cm", "km", "m", "km/h", "mm/s", "cm/s", "m/s", "ms", "us", "s", "g", "kg", "%", "1"),
    *("mA", "A", "mV", "V", "hPa", "kPa", "bar", "Pa", "mbar", "kW", "W", "l", "m^3"),
)
"""In which sensors tell what is no angle."""
CELSIUS: Final = 273.15


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
    logged = (values - binding.offset) / binding.unit.scale
    for text in _units_like(part.unit):
        scale = parse_unit(text).scale
        if scale != binding.unit.scale:
            yield text, f"unit: {text}", logged * scale + binding.offset
    if part.unit.text == "K":
        yield "degrees Celsius", "offset: 273.15 K", logged + CELSIUS


def _units_like(unit: Unit) -> list[str]:
    """Units in which sensors may tell a quantity of this unit; angles are no ratios."""
    text = unit.text or "1"
    tried = ANGLES if re.search(r"rad|deg|rpm|turn", text) else UNITS
    try:
        dimension = parse_unit(text).dimension
    except UnitFault:
        return []
    return [each for each in tried if parse_unit(each).dimension == dimension]


def _to_write(binding: Binding, entry: str) -> str:
    """The whole entry of the trace, where it is a path alone; else what to add to it."""
    is_path = (binding.delay, binding.scale, binding.offset, binding.noise) == (0.0, 1.0, 0.0, None)
    if not is_path:
        return f"add `{entry}` to its entry in `trace:`"
    path = binding.path if re.fullmatch(r"[\w/.@-]+", binding.path) else f"'{binding.path}'"
    return f"write `{binding.name}: {{path: {path}, {entry}}}` in `trace:`"
