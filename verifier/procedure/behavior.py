"""The test procedure of a behavior: from its spec alone, by the numbers of the verifier."""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.program import Control, Fidelity, Kind, Program, State
from verifier.fidelity.shooting.windows import SPAN
from verifier.fidelity.stretches.needs import names_guarded, names_read
from verifier.fidelity.verify import fidelity_of
from verifier.procedure.candidates import candidates
from verifier.procedure.choosing import chosen_runs, reached
from verifier.procedure.driving import Paths, Plans, driven_paths
from verifier.procedure.excitation import effects_of, untold
from verifier.procedure.goals import Goals, goals_of, with_effects
from verifier.procedure.levels import threshold_levels
from verifier.procedure.model import Drive, Excitation, Procedure, Rehearsal, Signal, Stage
from verifier.procedure.rehearsal import Staging, rehearsed
from verifier.report.report import Verdict
from verifier.report.wording import listed, percent

CANDIDATES: Final = 400
"""So many runs are tried, of which a few are chosen."""
QUIET: Final = 0.1
"""The noise of a sensor that is rehearsed with, as a share of the tolerance, where a spec says
nothing of it."""
QUIET_INPUT: Final = 0.002
"""The same of what is only sensed, as a share of its domain."""
QUIET_LEVEL: Final = 0.02
"""But no louder than this share of a value beside a threshold."""
NO_RUN: Final = "no run of the behavior alone lasts long enough within its domain to be judged"
SEED: Final = 7


def procedure_of(
    program: Program, *, every: float | None = None, is_rehearsed: bool = True
) -> Procedure:
    """Which runs to record so that the verifier can decide about `program`.

    every: seconds between samples; None: as its fidelity's horizon needs.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    fidelity = fidelity_of(program)
    fidelity = replace(fidelity, horizon=max(fidelity.horizon, program.field.every))
    every = _period(program, fidelity) if every is None or program.field.is_map else every
    plans = candidates(program, fidelity, CANDIDATES, every)
    paths = driven_paths(program, plans, every, SEED)
    effects = effects_of(program, fidelity, plans, every)
    goals = with_effects(goals_of(program, fidelity, paths), effects)
    runs = chosen_runs(goals, fidelity.coverage)
    chosen = plans.part(np.array(runs, dtype=np.int64))
    signals = _signals(program, fidelity)
    repeats, rehearsal = 1, None
    if is_rehearsed and runs:
        staging = Staging(program, chosen, signals, every, SEED)
        repeats, rehearsal = rehearsed(staging, tuple(fidelity.tolerance))
    return Procedure(
        name=program.name,
        horizon=fidelity.horizon,
        rate=1.0 / every,
        drives=tuple(_drive(program, plans, paths, goals, run, repeats) for run in runs),
        signals=signals,
        excited=tuple(_excitation(program, chosen, runs, name, effects[name]) for name in effects),
        required=fidelity.coverage if fidelity.region else 0.0,
        remarks=(*_remarks(fidelity, goals, runs, rehearsal), *untold(effects)),
        rehearsal=rehearsal,
    )


def _period(program: Program, fidelity: Fidelity) -> float:
    """Seconds between samples: one in each half span that the verifier averages over."""
    if program.field.is_map:
        return program.field.every
    rate = 1.0 / (SPAN * fidelity.horizon)
    return 1.0 / float(np.ceil(rate))


def _signals(program: Program, fidelity: Fidelity) -> tuple[Signal, ...]:
    """All that the field reads or drives."""
    read = names_read(program) | names_guarded(program) | set(program.field.driven)
    read |= {program.field.mode} if program.field.mode else set()
    declared = {each.name: each.noise for each in program.bindings if each.noise is not None}
    found = []
    parts: tuple[State | Control, ...] = (*program.states, *program.controls)
    for part in parts:
        if part.name not in read:
            continue
        values = part.values if isinstance(part, State) else ()
        noise = declared.get(part.name, _noise(program, part, fidelity))
        is_sensed = isinstance(part, State) and not part.is_driven
        is_set = isinstance(part, Control)
        found.append(Signal(part.name, part.unit, float(noise), values, is_set, is_sensed))
    return tuple(found)


def _noise(program: Program, part: State | Control, fidelity: Fidelity) -> float:
    if isinstance(part, Control) or part.kind is Kind.DISCRETE:
        return 0.0
    if part.name in fidelity.tolerance:
        return QUIET * fidelity.tolerance[part.name]
    levels = [abs(each - part.low) for each in threshold_levels(program, part)]
    return min([QUIET_INPUT * (part.high - part.low), *(QUIET_LEVEL * each for each in levels)])


def _drive(
    program: Program, plans: Plans, paths: Paths, goals: Goals, run: int, repeats: int
) -> Drive:
    """One run in words of the spec: until it leaves the domain, if it does."""
    names, read = program.register, names_read(program) | names_guarded(program)
    start = {
        state.name: float(plans.start[run, i])
        for i, state in enumerate(program.states)
        if not plans.inputs[i] or (state.name in read and state.kind is not Kind.DISCRETE)
    }
    alive = float(paths.times[int(paths.alive[run]) - 1])
    stages = []
    for k in range(plans.held.shape[1]):
        left = min(plans.seconds, alive - k * plans.seconds)
        if left <= 0.0:
            break
        entries = [i for i in np.flatnonzero(plans.inputs) if names[i] in read]
        stages.append(Stage(left, {names[i]: float(plans.held[run, k, i]) for i in entries}))
    cells = tuple(int(c) for c in np.flatnonzero(goals.in_cell[run]))
    return Drive(start, tuple(stages), repeats, cells)


def _excitation(
    program: Program, chosen: Plans, runs: tuple[int, ...], name: str, effect: Array
) -> Excitation:
    """What the chosen runs hold one input at, and what that changes."""
    values = chosen.held[:, :, program.register.index(name)]
    if not runs:
        return Excitation(name, 0.0, 0.0, 0.0)
    return Excitation(
        name, float(values.min()), float(values.max()), float(effect[list(runs)].max(initial=0.0))
    )


def _remarks(
    fidelity: Fidelity, goals: Goals, runs: tuple[int, ...], rehearsal: Rehearsal | None
) -> tuple[str, ...]:
    """What the runs leave open."""
    if not runs:
        return (NO_RUN,)
    met = reached(goals, runs)
    told = []
    if goals.is_cell.any():
        share = float(np.mean(met[goals.is_cell] >= 1.0))
        if share < fidelity.coverage:
            told.append(
                f"runs of the behavior alone reach {percent(share)} of the cells of the region,"
                f" {percent(fidelity.coverage)} are required"
            )
    never = _never(goals)
    if never:
        told.append(f"no run of the behavior alone comes to {listed(never)}")
    if rehearsal is not None and rehearsal.verdict is not Verdict.PASS:
        told.append(f"rehearsed, it does not decide: {rehearsal.reasons[0]}")
    return tuple(told)


def _never(goals: Goals) -> list[str]:
    """What no run that was tried comes to, but cells."""
    best = goals.gives.max(axis=0)
    told = zip(goals.names, best, strict=True)
    return [name for name, most in told if name and most == 0.0]
