"""Rates that saturate, have a dead zone, or come late.

What lies in a formula is wrapped there. A rate that comes late cannot be told from the state at
the same instant, so it is worked out along the smoothed trace and put in as a function of time.
"""

from dataclasses import dataclass, replace
from typing import final

import numpy as np

from runtime.program import Unit
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.candidates.inputs import LAGS, LIMITS, SECOND, SHIFTS, ZONES
from verifier.diagnosis.courses import Course
from verifier.diagnosis.loosened import TIME_SCALE, gain_of, given_of, is_given_of, offset_of
from verifier.diagnosis.part_units import unit_of
from verifier.diagnosis.scene import Scene
from verifier.diagnosis.smoothed import Smoothed, rates_of, smoothed, values_of
from verifier.diagnosis.wraps import Wrap, wraps_of
from verifier.report.diagnosis import CandidateKind


def effects_on_rates(scene: Scene) -> tuple[Effect, ...]:
    """Of every driven state's rate, and of the differences in its formula."""
    along = smoothed(scene)
    effects = []
    for wrap in wraps_of(scene.program):
        most = float(np.nanmax(np.abs(values_of(scene, along, wrap.code)), initial=0.0))
        if most > 0.0:
            effects += _sizes(wrap, most, unit_of(wrap, scene.program), scene.program.field.origin)
    if scene.program.field.is_map:
        return tuple(effects)
    found = rates_of(scene, along, scene.plain)
    for each in scene.observed:
        rate = found[:, each.column]
        is_driven = each.name in scene.program.field.driven
        if is_driven and scene.flow.moves[each.column] and np.ptp(rate) > 0.0:
            effects += _late(scene, each.name, each.column, along)
    return tuple(effects)


def _sizes(wrap: Wrap, most: float, unit: Unit, origin: str) -> list[Effect]:
    limit = Number("limit", unit, most, 1e-4 * most, 0.0, most)
    zone = Number("half width", unit, 0.0, 1e-4 * most, 0.0, most)
    name = (wrap.name,)
    limits = tuple((share * most,) for share in LIMITS)
    zones = tuple((share * most,) for share in ZONES)
    return [
        Effect(
            CandidateKind.SATURATION,
            name,
            f"saturation of {wrap.words}",
            (limit,),
            _Entry(wrap.limit),
            origin,
            limits,
            subject=wrap.words,
        ),
        Effect(
            CandidateKind.DEAD_ZONE,
            name,
            f"dead zone of {wrap.words}",
            (zone,),
            _Entry(wrap.zone),
            origin,
            zones,
            subject=wrap.words,
        ),
    ]


def _late(scene: Scene, name: str, column: int, along: Smoothed) -> list[Effect]:
    """A dead time and a lag of one rate, from its values along the trace."""
    horizon, origin = scene.horizon, scene.program.field.origin
    delay = Number("delay", SECOND, 0.0, 1e-3 * horizon, 0.0, horizon)
    lag = Number("time constant", SECOND, 0.0, 1e-3 * horizon, 0.0, 2.0 * horizon)
    return [
        Effect(
            CandidateKind.DEAD_TIME,
            (name,),
            f"dead time of the rate of {name}",
            (delay,),
            _Late(scene, along, name, column, is_lag=False),
            origin,
            tuple((share * horizon,) for share in SHIFTS),
            stands_in=True,
            subject=f"the rate of {name}",
        ),
        Effect(
            CandidateKind.LAG,
            (name,),
            f"lag of the rate of {name}",
            (lag,),
            _Late(scene, along, name, column, is_lag=True),
            origin,
            tuple((share * horizon,) for share in LAGS),
            stands_in=True,
            subject=f"the rate of {name}",
        ),
    ]


@final
@dataclass(frozen=True, slots=True)
class _Entry:
    """Moves one entry of the register."""

    name: str

    def __call__(self, setting: Altered, values: Values) -> Altered:
        return setting.moved(self.name, values[0])


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Late:
    """Puts a rate in from outside, late or through a lag."""

    scene: Scene
    along: Smoothed
    name: str
    column: int
    is_lag: bool

    def __call__(self, setting: Altered, values: Values) -> Altered:
        shift, lag = (0.0, values[0]) if self.is_lag else (values[0], 0.0)
        own = _ungained(setting, self.name)
        rate = rates_of(self.scene, self.along, own)[:, self.column]
        begins = self.along.times - 0.5 * (self.along.times[1] - self.along.times[0])
        given = setting.moved(is_given_of(self.name), 1.0)
        return given.with_course(given_of(self.name), Course(begins, rate, shift, lag))


def _ungained(setting: Altered, name: str) -> Altered:
    """Without the factors that act on what is given, too."""
    plain = {gain_of(name): 1.0, offset_of(name): 0.0, TIME_SCALE: 1.0}
    kept = {key: value for key, value in setting.register.items() if key not in plain}
    return replace(setting, register=kept)
