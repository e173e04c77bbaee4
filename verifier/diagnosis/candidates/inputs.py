"""Inputs that act late, through a lag, up to a limit, beyond a dead zone, or swapped."""

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Final, final

import numpy as np

from runtime.program import Binding, Unit
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.parameters import varying
from verifier.diagnosis.scene import Scene
from verifier.fidelity.stretches.needs import Input, parts_of
from verifier.report.diagnosis import CandidateKind
from verifier.report.wording import listed

SECOND: Final = Unit("s", 1.0)
SHIFTS: Final = (0.02, 0.05, 0.1, 0.2, 0.4)
"""Where fits of a delay begin, to either side, in horizons."""
LAGS: Final = (0.02, 0.1, 0.3)
LIMITS: Final = (0.9, 0.75, 0.6, 0.4)
"""Where fits of a limit begin, in largest values seen."""
ZONES: Final = (0.05, 0.15, 0.3)


def effects_on_inputs(scene: Scene) -> tuple[Effect, ...]:
    """All of them, for every input that was measured and varies."""
    inputs = [i for i in varying(scene.program, scene.needs) if i.series is not None]
    moving = [each for each in inputs if each.series and np.ptp(each.series.values) > 0.0]
    parts = parts_of(scene.program)
    bindings = {binding.name: binding for binding in scene.program.bindings}
    effects = []
    for each in moving:
        origin = origin_of(bindings, each.name)
        effects += [
            delay_of((each.name,), (), scene.horizon, origin),
            _lag(each.name, scene.horizon, origin),
            *_sizes(each, parts[each.name].unit, origin),
        ]
    pairs = combinations([each.name for each in moving], 2)
    effects += [
        _swap(a, b, origin_of(bindings, a))
        for a, b in pairs
        if parts[a].unit.text == parts[b].unit.text
    ]
    return tuple(effects)


def delay_of(
    inputs: tuple[str, ...],
    states: tuple[str, ...],
    horizon: float,
    origin: str,
    *,
    topic: str = "",
) -> Effect:
    """Inputs that act so many seconds later than logged; states seen so many seconds earlier.

    Of inputs alone it is a dead time, or they are logged late; of states alone a late log; of a
    `topic`, its clock is off.
    """
    kind = CandidateKind.LATE_LOG if states else CandidateKind.DEAD_TIME
    if topic:
        kind = CandidateKind.CLOCK_OFFSET
    names = (*inputs, *states)
    number = Number("delay", SECOND, 0.0, 1e-3 * horizon, -horizon, horizon)
    starts = tuple((sign * share * horizon,) for share in SHIFTS for sign in (1.0, -1.0))
    return Effect(
        kind=kind,
        applies_to=names,
        label=f"clock of {topic}" if topic else f"delay of {listed(list(names))}",
        numbers=(number,),
        apply=_Shift(inputs, states),
        origin=origin,
        starts=starts,
        subject=topic,
        is_delay=not topic,
    )


def origin_of(bindings: dict[str, Binding], name: str) -> str:
    """Where the log's path of a variable stands in the YAML; empty where it is nowhere."""
    return bindings[name].origin if name in bindings else ""


@final
@dataclass(frozen=True, slots=True)
class _Shift:
    inputs: tuple[str, ...]
    states: tuple[str, ...]

    def __call__(self, setting: Altered, values: Values) -> Altered:
        (shift,) = values
        for name in self.inputs:
            course = setting.courses[name]
            setting = setting.with_course(name, replace(course, shift=course.shift + shift))
        for name in self.states:
            seen = setting.seen[name]
            setting = setting.with_seen(name, replace(seen, delay=seen.delay - shift))
        return setting


def _lag(name: str, horizon: float, origin: str) -> Effect:
    number = Number("time constant", SECOND, 0.0, 1e-3 * horizon, 0.0, 2.0 * horizon)
    starts = tuple((share * horizon,) for share in LAGS)
    label = f"lag of {name}"
    return Effect(CandidateKind.LAG, (name,), label, (number,), _Lag(name), origin, starts)


@final
@dataclass(frozen=True, slots=True)
class _Lag:
    name: str

    def __call__(self, setting: Altered, values: Values) -> Altered:
        course = setting.courses[self.name]
        return setting.with_course(self.name, replace(course, lag=course.lag + values[0]))


def _sizes(given: Input, unit: Unit, origin: str) -> list[Effect]:
    """Saturation and dead zone of an input, symmetric about zero."""
    assert given.series is not None, "an input that varies was measured"
    name, most = given.name, float(np.max(np.abs(given.series.values)))
    limit = Number("limit", unit, most, 1e-4 * most, 0.0, most)
    zone = Number("half width", unit, 0.0, 1e-4 * most, 0.0, most)
    limits = tuple((share * most,) for share in LIMITS)
    zones = tuple((share * most,) for share in ZONES)
    saturation, dead = CandidateKind.SATURATION, CandidateKind.DEAD_ZONE
    return [
        Effect(
            saturation, (name,), f"saturation of {name}", (limit,), _Limit(name), origin, limits
        ),
        Effect(dead, (name,), f"dead zone of {name}", (zone,), _Zone(name), origin, zones),
    ]


@final
@dataclass(frozen=True, slots=True)
class _Limit:
    name: str

    def __call__(self, setting: Altered, values: Values) -> Altered:
        course = setting.courses[self.name]
        clipped = np.clip(course.values, -values[0], values[0])
        return setting.with_course(self.name, replace(course, values=clipped))


@final
@dataclass(frozen=True, slots=True)
class _Zone:
    name: str

    def __call__(self, setting: Altered, values: Values) -> Altered:
        course = setting.courses[self.name]
        beyond = course.values - np.clip(course.values, -values[0], values[0])
        return setting.with_course(self.name, replace(course, values=beyond))


def _swap(a: str, b: str, origin: str) -> Effect:
    kind, label = CandidateKind.SWAPPED_AXES, f"{a} and {b} swapped"
    return Effect(kind, (a, b), label, (), _Swap(a, b), origin)


@final
@dataclass(frozen=True, slots=True)
class _Swap:
    a: str
    b: str

    def __call__(self, setting: Altered, _values: Values) -> Altered:
        first, second = setting.courses[self.a], setting.courses[self.b]
        return setting.with_course(self.a, second).with_course(self.b, first)
