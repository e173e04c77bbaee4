"""What a trace cannot tell because the robot was not there: places, modes, switches, features."""

from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.claim import Claim
from runtime.machine import evaluate
from runtime.program import Control, Fidelity, Guard, Kind, Program, State
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.changes import changes_in
from verifier.fidelity.stretches.needs import held, mode_of, names_read, parts_of
from verifier.fidelity.stretches.segments import on_circle
from verifier.fidelity.stretches.spans import contains
from verifier.report.limits import NotTold
from verifier.report.wording import listed, percent, quantity, span

STILL: Final = 0.01
"""A state that moves by less than this share of its domain has not moved."""
NOISES: Final = 6.0
"""Nor has one that moves by less than so many standard deviations of its noise."""
PARTS: Final = 20
"""Parts of an axis that are told apart as visited or not."""
UNSEEN: Final = 0.2
"""A larger share of the declared region that was not visited is worth a sentence."""
UNSEEN_DOMAIN: Final = 0.5
"""Where no region is declared: of the domain, where a robot need not go everywhere."""
NEAR: Final = 0.05
"""A feature was visited where the robot came nearer than this share of the domain, per state."""


def untold_of_states(
    program: Program, fidelity: Fidelity, study: Study, known: frozenset[str]
) -> list[NotTold]:
    """States that never moved, and parts of axes that were not visited.

    Axes are those of the region, where one is declared. known: variables of which more is said
    already.
    """
    read, found = names_read(program), []
    parts = parts_of(program)
    for name, values in visited_values(study).items():
        part = parts[name]
        if name not in read or name in known:
            continue
        if isinstance(part, State) and _is_still(study, part, values):
            found.append(_unmoved(part, values))
        elif not (isinstance(part, State) and part.kind is Kind.DISCRETE):
            found += _unvisited(fidelity, part, values)
    return found


def visited_values(study: Study) -> dict[str, Array]:
    """What each predicted state and measured input was in the judged stretches."""
    spans = study.segments.spans
    found = {
        each.state.name: on_circle(each.state, each.values[contains(spans, each.times)])
        for each in study.plan.samples
    }
    for given in study.plan.needs.inputs:
        if given.series is not None:
            inside = given.series.values[contains(spans, given.series.times)]
            found[given.name] = np.concatenate([held(given.series, spans[:, 0]), inside])
    return found


def untold_of_modes(program: Program, study: Study) -> list[NotTold]:
    """Modes that were never entered, and ways between modes that were never taken."""
    mode = mode_of(program, study.plan.needs)
    state = next((s for s in program.states if s.name == program.field.mode), None)
    if mode is None or state is None:
        return []
    seen = {round(mode.value)} if mode.series is None else set(mode.series.values.astype(int))
    changes = changes_in(mode.series)
    taken = set(zip(changes.left.tolist(), changes.entered.tolist(), strict=True))
    never = [i for i in range(len(state.values)) if i not in seen]
    found = [_never_entered(state, i) for i in never]
    for guard in program.field.guards:
        way = (guard.mode, guard.target)
        if way not in taken and guard.mode not in never:
            found.append(_never_taken(state, guard))
            taken.add(way)
    return found


def untold_of_features(program: Program, study: Study) -> list[NotTold]:
    """Claimed features with a place that the robot never came near; those sketched, too."""
    return [
        _never_near(claim)
        for claim in program.claims
        if claim.places and claim.least > 0 and not _is_near(program, study, claim)
    ]


def _is_near(program: Program, study: Study, claim: Claim) -> bool:
    """Whether the robot was near the claimed place in all its states at once."""
    base = study.plan.samples[study.plan.needs.base]
    times = base.times[contains(study.segments.spans, base.times)]
    samples = {each.state.name: each for each in study.plan.samples}
    near: Booleans = np.ones(len(times), dtype=bool)
    for place in claim.places:
        if place.state not in samples:
            continue
        each = samples[place.state]
        register = np.array(study.plan.model.flow.defaults)
        for given in study.plan.needs.inputs:
            register[given.column] = (
                given.value if given.series is None else np.median(given.series.values)
            )
        at = float(evaluate([place.at], program.register, register)[0])
        width = each.state.high - each.state.low
        apart = np.interp(times, each.times, each.values) - at
        if each.turn > 0.0:
            apart -= each.turn * np.rint(apart / each.turn)
        near &= np.abs(apart) <= max(NEAR * width, place.within)
    return bool(np.any(near))


def _is_still(study: Study, state: State, values: Array) -> bool:
    names = [each.state.name for each in study.plan.samples]
    sigma = study.noise[names.index(state.name)].sigma if state.name in names else 0.0
    low, high = np.quantile(values, [0.005, 0.995])
    return bool(high - low <= max(STILL * (state.high - state.low), NOISES * sigma))


def _unmoved(state: State, values: Array) -> NotTold:
    middle = quantity(float(np.median(values)), state.unit)
    return NotTold(
        what=f"how the field depends on {state.name}",
        names=(state.name,),
        why=f"{state.name} stayed at about {middle} all the time",
        suggestion=(
            f"begin runs at values of {state.name} from"
            f" {span(state.low, state.high, state.unit)}, or disturb it"
        ),
        origin=state.origin,
    )


def _unvisited(fidelity: Fidelity, part: State | Control, values: Array) -> list[NotTold]:
    low, high = fidelity.region.get(part.name, (part.low, part.high))
    counts, edges = np.histogram(values, bins=PARTS, range=(low, high))
    empty = counts == 0
    if isinstance(part, Control):
        # Commands jump: what lies between two of them is not unseen.
        empty &= (edges[:-1] > np.max(values)) | (edges[1:] < np.min(values))
    share = float(np.mean(empty))
    if share <= (UNSEEN if part.name in fidelity.region else UNSEEN_DOMAIN):
        return []
    flags = np.concatenate([[0], empty.astype(np.int64), [0]])
    runs = np.flatnonzero(np.diff(flags)).reshape(-1, 2)
    longest = runs[np.argsort(runs[:, 0] - runs[:, 1], kind="stable")[:2]]
    spans = [span(edges[a], edges[b], part.unit) for a, b in sorted(longest.tolist())]
    where = "region" if part.name in fidelity.region else "domain"
    return [
        NotTold(
            what=f"what the robot does where {part.name} is from {listed(spans)}",
            names=(part.name,),
            why=f"{percent(share)} of the {where} of {part.name} was never visited",
            suggestion=f"record with {part.name} there",
            origin=part.origin,
        )
    ]


def _never_entered(state: State, index: int) -> NotTold:
    name = state.values[index]
    return NotTold(
        what=f"what the robot does while {state.name} is {name}",
        names=(state.name, name),
        why=f"{state.name} was never {name}",
        suggestion=f"record a run in which {state.name} becomes {name}",
        origin=state.origin,
    )


def _never_taken(state: State, guard: Guard) -> NotTold:
    left, entered = state.values[guard.mode], state.values[guard.target]
    return NotTold(
        what=f"when the robot goes from {left} to {entered}, and how its state jumps there",
        names=(state.name, left, entered),
        why=f"{state.name} never went from {left} to {entered}",
        suggestion=f"record a run that goes from {left} to {entered} three times or more",
        origin=guard.origin,
    )


def _never_near(claim: Claim) -> NotTold:
    states = listed([place.state for place in claim.places])
    return NotTold(
        what=f"whether the robot has what the spec claims: {claim.text}",
        names=tuple(place.state for place in claim.places),
        why=f"the robot was never near it (within 5 % of the domain of {states})",
        suggestion="begin a run close to it",
        origin=claim.origin,
    )
