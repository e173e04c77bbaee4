"""Rates that are off in one part of the region only: beyond some value of a variable.

Where the robot was in that part is read from the smoothed trace, so that what is added to the rate
is a function of time. Its border is a ramp, which a fit can move. Of all borders that are tried,
the most promising of each rate and variable stays.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Kind
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.courses import Course
from verifier.diagnosis.fitting import plain_fit
from verifier.diagnosis.loosened import offset_of
from verifier.diagnosis.part_units import per_second
from verifier.diagnosis.scene import Scene
from verifier.diagnosis.selection import forecasts
from verifier.diagnosis.smoothed import Smoothed, smoothed
from verifier.fidelity.stretches.needs import parts_of
from verifier.report.diagnosis import CandidateKind

BORDERS: Final = (0.2, 0.4, 0.6, 0.8)
"""Quantiles of a variable at which borders are tried."""
RAMP: Final = 0.02
"""The half width of a border, as a share of the variable's range."""
STILL: Final = 0.02
"""A variable that moves by less than this share of its domain has no parts."""
SIDES: Final = {"large": 1.0, "small": -1.0}


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Spot:
    """One part: where `name` is beyond a border; side: 1 above it, -1 below."""

    rate: str
    name: str
    column: int
    side: str
    border: float
    low: float
    high: float


def effects_on_regions(scene: Scene) -> tuple[Effect, ...]:
    """Of each rate and each variable that it reads, the part that promises most."""
    if scene.program.field.is_map or scene.program.field.formula is None:
        return ()
    along = smoothed(scene)
    spots = _spots(scene, along)
    if not spots:
        return ()
    tried = tuple(_effect(scene, along, spot, is_fixed=True) for spot in spots)
    promised = forecasts(scene, plain_fit(scene), tried)
    best: dict[tuple[str, str], _Spot] = {}
    for spot, effect in zip(spots, tried, strict=True):
        key = spot.rate, spot.name
        if key not in best or promised[effect.label] > promised[_label(best[key], is_fixed=True)]:
            best[key] = spot
    return tuple(_effect(scene, along, spot, is_fixed=False) for spot in best.values())


def _spots(scene: Scene, along: Smoothed) -> list[_Spot]:
    program, register = scene.program, scene.flow.program.register
    assert program.field.formula is not None, "asked for before"
    parts = parts_of(program)
    moving = {each.name for each in scene.observed}
    found = []
    for rate, code in zip(program.field.driven, program.field.formula, strict=True):
        for name in dict.fromkeys(t for t in code.tokens if t in parts and rate in moving):
            part, column = parts[name], register.index(name)
            values = along.register[:, column]
            low, high = float(np.min(values)), float(np.max(values))
            if getattr(part, "kind", Kind.CONTINUOUS) is Kind.DISCRETE:
                continue
            if high - low > STILL * (part.high - part.low):
                found += [
                    _Spot(rate, name, column, side, float(border), low, high)
                    for border in np.unique(np.quantile(values, BORDERS))
                    for side in SIDES
                ]
    return found


def _label(spot: _Spot, *, is_fixed: bool) -> str:
    label = f"offset of the rate of {spot.rate} at {spot.side} {spot.name}"
    return f"{label} {spot.border}" if is_fixed else label


def _effect(scene: Scene, along: Smoothed, spot: _Spot, *, is_fixed: bool) -> Effect:
    """is_fixed: with the border as it is, for a forecast."""
    parts = parts_of(scene.program)
    (rate,) = (s for s in scene.program.states if s.name == spot.rate)
    width = rate.high - rate.low
    offset = Number("offset", per_second(rate.unit), 0.0, 1e-5 * width, -10.0 * width, 10.0 * width)
    ramp = RAMP * (spot.high - spot.low)
    edge = Number("border", parts[spot.name].unit, spot.border, 0.5 * ramp, spot.low, spot.high)
    values = along.register[:, spot.column]
    begins = along.times - 0.5 * (along.times[1] - along.times[0])
    return Effect(
        kind=CandidateKind.REGION,
        applies_to=(spot.rate, spot.name),
        label=_label(spot, is_fixed=is_fixed),
        numbers=(offset,) if is_fixed else (offset, edge),
        apply=_Beyond(offset_of(spot.rate), begins, values, spot.border, SIDES[spot.side], ramp),
        origin=scene.program.field.origin,
        best_of=1 if is_fixed else len(BORDERS) * len(SIDES),
        detail="above" if SIDES[spot.side] > 0.0 else "below",
    )


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Beyond:
    """Adds an offset to a rate where a variable, known along the trace, is beyond a border."""

    name: str
    begins: Array
    along: Array
    border: float
    side: float
    ramp: float

    def __call__(self, setting: Altered, values: Values) -> Altered:
        border = values[1] if len(values) > 1 else self.border
        share = np.clip(0.5 + 0.5 * self.side * (self.along - border) / self.ramp, 0.0, 1.0)
        course = Course(self.begins, values[0] * share)
        if self.name in setting.courses:
            before = setting.courses[self.name]
            course = replace(before, values=before.values + course.values)
        return setting.with_course(self.name, course)
