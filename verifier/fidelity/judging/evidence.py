"""What judging reads: the errors of all windows, of one recording or of several together.

Letters: W windows, in order of time within each recording, the recordings one after the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.program import Kind, Program, State
from verifier.fidelity.judging.neighbours import one_run
from verifier.fidelity.judging.parts import Condition
from verifier.fidelity.judging.views import VIEWS, views_of
from verifier.fidelity.shooting.shooting import Errors
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Input, names_read, parts_of
from verifier.fidelity.stretches.segments import on_circle
from verifier.report.report import Noise, WindowView

TOGETHER: Final = "root mean square of what the recordings tell, each by itself"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Evidence:
    """The windows of one or several recordings, shot; `runs` (W,): of which each of them is.

    sources: the name of each recording; noise: of each, of each predicted state. states: the
    predicted ones, with their `turns` (the period of a periodic one, else 0).
    errors[horizon][state] at the `horizons`, of which the declared one comes last. is_lost (W,):
    the prediction left the domain. starts (W,): seconds from the recording's start.
    places: (W,) by name, where each window ran; conditions: what the field reads of that.
    views[state]: a few windows. unknown: inputs that were assumed. step_error: of the integration
    at the horizon, as a share of the tolerance. clocks: whose stamps the times are.
    """

    program: Program
    sources: tuple[str, ...]
    runs: Integers
    states: tuple[State, ...]
    turns: tuple[float, ...]
    noise: tuple[tuple[Noise, ...], ...]
    horizons: tuple[float, ...]
    errors: tuple[tuple[Errors, ...], ...]
    is_lost: Booleans
    starts: Array
    places: dict[str, Array]
    conditions: tuple[Condition, ...]
    views: tuple[tuple[WindowView, ...], ...]
    unknown: tuple[Input, ...]
    step_error: float
    clocks: tuple[str, ...]

    @property
    def horizon(self) -> float:
        """The declared one."""
        return self.horizons[-1]

    def index_of(self, name: str) -> int:
        """Which of the states has this name."""
        return [state.name for state in self.states].index(name)

    def kept(self, errors: Errors) -> Booleans:
        """Which windows (W,) count: those with an error, whose prediction stayed inside."""
        return np.asarray(np.isfinite(errors.mean) & ~self.is_lost)


def evidence_of(program: Program, study: Study, source: str) -> Evidence:
    """The evidence of one recording, `source`."""
    plan, shots = study.plan, study.shots
    places = places_of(program, study)
    return Evidence(
        program=program,
        sources=(source,),
        runs=one_run(len(plan.windows.times)),
        states=tuple(each.state for each in plan.samples),
        turns=tuple(each.turn for each in plan.samples),
        noise=(study.noise,),
        horizons=plan.horizons,
        errors=shots.errors,
        is_lost=shots.is_lost,
        starts=plan.windows.times,
        places=places,
        conditions=_conditions(program, study, places),
        views=tuple(views_of(study, j) for j in range(len(plan.samples))),
        unknown=plan.needs.unknown,
        step_error=study.step_error,
        clocks=tuple(sorted({series.clock for series in plan.needs.series})),
    )


def joined(parts: Sequence[Evidence]) -> Evidence:
    """The evidence of all recordings of one program together; there is one at least."""
    first = parts[0]
    if len(parts) == 1:
        return first
    counts = [len(part.sources) for part in parts]
    before = np.cumsum([0, *counts[:-1]])
    order = range(len(first.states))
    return replace(
        first,
        sources=tuple(source for part in parts for source in part.sources),
        runs=np.concatenate([p.runs + k for p, k in zip(parts, before, strict=True)]),
        noise=tuple(noise for part in parts for noise in part.noise),
        errors=tuple(
            tuple(_joined_errors([p.errors[h][j] for p in parts]) for j in order)
            for h in range(len(first.horizons))
        ),
        is_lost=np.concatenate([part.is_lost for part in parts]),
        starts=np.concatenate([part.starts for part in parts]),
        places={
            name: np.concatenate([part.places[name] for part in parts]) for name in first.places
        },
        conditions=_joined_conditions(parts),
        views=tuple(_few([view for part in parts for view in part.views[j]]) for j in order),
        unknown=tuple({each.name: each for p in parts for each in p.unknown}.values()),
        step_error=max(part.step_error for part in parts),
        clocks=tuple(sorted({clock for part in parts for clock in part.clocks})),
    )


def noise_of_all(evidence: Evidence, j: int) -> Noise:
    """The noise of one state, weighted by the windows of each recording."""
    noises = [noise[j] for noise in evidence.noise]
    if len(noises) == 1:
        return noises[0]
    shares = np.bincount(evidence.runs, minlength=len(noises)) / len(evidence.runs)
    told = zip(shares, noises, strict=True)
    return Noise(
        sigma=_root_mean(shares, np.array([noise.sigma for noise in noises])),
        samples=sum(noise.samples for noise in noises),
        correlation=float(sum(share * noise.correlation for share, noise in told)),
        quantum=max(noise.quantum for noise in noises),
        method=TOGETHER,
    )


def places_of(program: Program, study: Study) -> dict[str, Array]:
    """Where each window ran (W,): the measured start of a state, the mean of an input.

    Of a discrete input, its value at the start.
    """
    places = {}
    for name in parts_of(program):
        assumed = study.plan.model.flow.defaults[program.register.index(name)]
        places[name] = np.full(len(study.plan.windows.times), assumed)
    for each in study.plan.samples:
        start = np.interp(study.plan.windows.times, each.times, each.values)
        places[each.state.name] = on_circle(each.state, start)
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    for column, given in enumerate(study.plan.needs.inputs):
        values = study.plan.model.grid.inputs[:, column]
        is_discrete = given.name in discrete
        places[given.name] = _at_starts(study, values) if is_discrete else _means(study, values)
    return places


def _at_starts(study: Study, values: Array) -> Array:
    """What holds (W,) at each window's start: a mean of modes is none."""
    starts = np.searchsorted(study.plan.model.grid.times, study.plan.windows.times, side="right")
    return np.asarray(values[starts - 1])


def _means(study: Study, values: Array) -> Array:
    """The time average (W,) over each window of values held from knot to knot (G,)."""
    times, windows = study.plan.model.grid.times, study.plan.windows
    area = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(times))])
    span = times[windows.last] - times[windows.first]
    return np.asarray((area[windows.last] - area[windows.first]) / np.maximum(span, 1e-300))


def _conditions(program: Program, study: Study, places: dict[str, Array]) -> tuple[Condition, ...]:
    """What the field reads, and where each window had it: parts are told apart by these."""
    read = names_read(program)
    discrete = {state.name for state in program.states if state.kind is Kind.DISCRETE}
    turns = {each.state.name: each.turn for each in study.plan.samples}
    samples = zip(study.plan.samples, study.noise, strict=True)
    sigmas = {each.state.name: noise.sigma for each, noise in samples}
    return tuple(
        Condition(
            name,
            _settled(study, name) if name in discrete else values,
            is_discrete=name in discrete,
            turn=turns.get(name, 0.0),
            noise=sigmas.get(name, 0.0),
        )
        for name, values in places.items()
        if name in read
    )


def _settled(study: Study, name: str) -> Array:
    """A discrete input at the start of each window (W,)."""
    names = [given.name for given in study.plan.needs.inputs]
    if name not in names:
        return np.zeros(len(study.plan.windows.times))
    inputs = study.plan.model.grid.inputs
    return np.asarray(inputs[study.plan.windows.first, names.index(name)])


def _joined_errors(parts: Sequence[Errors]) -> Errors:
    names = [each.name for each in fields(Errors)]
    return Errors(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _joined_conditions(parts: Sequence[Evidence]) -> tuple[Condition, ...]:
    """The conditions of all windows; the noise of each weighted by the windows it is of."""
    counts = np.array([len(part.runs) for part in parts])
    found = []
    for own in zip(*(part.conditions for part in parts), strict=True):
        noise = _root_mean(counts / counts.sum(), np.array([each.noise for each in own]))
        values = np.concatenate([each.values for each in own])
        found.append(replace(own[0], values=values, noise=noise))
    return tuple(found)


def _root_mean(shares: Array, values: Array) -> float:
    return float(np.sqrt(np.sum(shares * values**2)))


def _few(views: Sequence[WindowView]) -> tuple[WindowView, ...]:
    """At most as many as of one recording, from all of them."""
    chosen = np.unique(np.linspace(0, len(views) - 1, min(VIEWS, len(views))).astype(np.int64))
    return tuple(views[place] for place in chosen)
