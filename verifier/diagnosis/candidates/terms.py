"""Rates with one further term: a power of a variable that they read.

The variable is taken along the smoothed trace, so that what is added to the rate is a function of
time. Of all powers that are tried, the most promising of each rate and variable stays.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.program import Control, Kind, State, Unit
from verifier.diagnosis.altered import Altered, Effect, Number, Values
from verifier.diagnosis.candidates.regions import STILL
from verifier.diagnosis.courses import Course
from verifier.diagnosis.fitting import plain_fit
from verifier.diagnosis.loosened import offset_of
from verifier.diagnosis.scene import Scene
from verifier.diagnosis.selection import forecasts
from verifier.diagnosis.smoothed import Smoothed, smoothed
from verifier.fidelity.stretches.needs import parts_of
from verifier.report.diagnosis import CandidateKind

POWERS: Final = {"{0}^2": 2, "{0} |{0}|": 2, "{0}^3": 3}
"""The terms as people write them, each with its power."""

NEAR: Final = 2.0
"""A variable is no further from zero than so many times the range that it moves in."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Term:
    """`words` of `name`, added to the rate of `state`; shape (T,): its course along the trace."""

    state: State
    name: str
    words: str
    unit: Unit
    size: float
    shape: Array

    @property
    def label(self) -> str:
        """As `term x^3 in the rate of v`."""
        return f"term {self.words} in the rate of {self.state.name}"


def effects_of_terms(scene: Scene) -> tuple[Effect, ...]:
    """Of each rate and each variable that it reads, the power that promises most."""
    if scene.program.field.is_map or scene.program.field.formula is None:
        return ()
    along = smoothed(scene)
    terms = _terms(scene, along)
    if not terms:
        return ()
    effects = {term.label: _effect(scene, along, term) for term in terms}
    promised = forecasts(scene, plain_fit(scene), tuple(effects.values()))
    best: dict[tuple[str, str], _Term] = {}
    for term in terms:
        key = term.state.name, term.name
        if key not in best or promised[term.label] > promised[best[key].label]:
            best[key] = term
    return tuple(effects[term.label] for term in best.values())


def _terms(scene: Scene, along: Smoothed) -> list[_Term]:
    program, register = scene.program, scene.flow.program.register
    assert program.field.formula is not None, "asked for before"
    parts, states = parts_of(program), {state.name: state for state in program.states}
    moving = {each.name for each in scene.observed}
    found = []
    for rate, code in zip(program.field.driven, program.field.formula, strict=True):
        for name in dict.fromkeys(t for t in code.tokens if t in parts and rate in moving):
            values = along.register[:, register.index(name)]
            if _is_plain(parts[name]) and _moves(values, parts[name]):
                found += [
                    _term(states[rate], parts[name], values, words, power)
                    for words, power in POWERS.items()
                ]
    return found


def _is_plain(part: State | Control) -> bool:
    """Whether powers of it mean anything: it is no angle on a circle and no name of a mode."""
    return getattr(part, "kind", Kind.CONTINUOUS) is Kind.CONTINUOUS


def _moves(values: Array, part: State | Control) -> bool:
    """Whether it moves, and near enough to zero for powers of it to bend."""
    spread = float(np.ptp(values))
    is_near = float(np.max(np.abs(values))) < NEAR * spread
    return is_near and spread > STILL * (part.high - part.low)


def _term(state: State, part: State | Control, values: Array, words: str, power: int) -> _Term:
    is_odd = "|" in words or power % 2 == 1
    shape = np.abs(values) ** power * (np.sign(values) if is_odd else 1.0)
    own, text = state.unit, part.unit.text
    per = "" if text in {"", "1"} else f"/({text})^{power}"
    unit = Unit(f"{own.text or '1'}/s{per}", own.scale / part.unit.scale**power)
    size = (state.high - state.low) / float(np.max(np.abs(shape)))
    return _Term(state, part.name, words.format(part.name), unit, size, shape)


def _effect(scene: Scene, along: Smoothed, term: _Term) -> Effect:
    begins = along.times - 0.5 * (along.times[1] - along.times[0])
    most = 10.0 * term.size
    return Effect(
        kind=CandidateKind.TERM,
        applies_to=(term.state.name, term.name),
        label=term.label,
        numbers=(Number("factor", term.unit, 0.0, 1e-5 * term.size, -most, most),),
        apply=_Add(offset_of(term.state.name), Course(begins, term.shape)),
        origin=scene.program.field.origin,
        best_of=len(POWERS),
        detail=term.words,
    )


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Add:
    """Adds a factor times a course to a rate."""

    name: str
    shape: Course

    def __call__(self, setting: Altered, values: Values) -> Altered:
        course = replace(self.shape, values=values[0] * self.shape.values)
        if self.name in setting.courses:
            before = setting.courses[self.name]
            course = replace(before, values=before.values + course.values)
        return setting.with_course(self.name, course)
