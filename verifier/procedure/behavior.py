"""The test procedure of a behavior: from its spec alone, by the numbers of the verifier."""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.program import Control, Fidelity, Kind, Program, State, Unit
from verifier.fidelity.shooting.windows import SPAN
from verifier.fidelity.stretches.needs import names_guarded, names_read
from verifier.fidelity.verify import fidelity_of
from verifier.procedure.choosing import chosen_runs, reached
from verifier.procedure.driving import Plans
from verifier.procedure.excitation import effects_of, untold
from verifier.procedure.goals import Goals, goals_of, with_effects
from verifier.procedure.lateness import borne_factor, lateness_of, paths_of
from verifier.procedure.levels import threshold_levels
from verifier.procedure.model import (
    Drive,
    Excitation,
    Lateness,
    Procedure,
    Rehearsal,
    Signal,
    Stage,
)
from verifier.procedure.rehearsal import Staging, rehearsed
from verifier.procedure.robot import PROMPT, Robot
from verifier.procedure.usable import left_out, usable_plans, within_reach, without_chance
from verifier.report.report import Verdict
from verifier.report.wording import listed, percent

QUIET: Final = 0.1
"""The noise of a sensor that is rehearsed with, as a share of the tolerance, where a spec says
nothing of it."""
QUIET_INPUT: Final = 0.002
"""The same of what is only sensed, as a share of its domain."""
QUIET_LEVEL: Final = 0.02
"""But no louder than this share of a value beside a threshold."""
NO_RUN: Final = "no run of the behavior alone lasts long enough within its domain to be judged"
MANY: Final = 12
"""Rather than drive more runs, controls are set to other values than the architecture's."""
ROUND_SECONDS: Final = (0.1, 0.5)
SEED: Final = 7


def procedure_of(
    program: Program,
    robot: Robot = PROMPT,
    *,
    every: float | None = None,
    is_rehearsed: bool = True,
) -> Procedure:
    """Which runs to record so that the verifier can decide about `program`.

    robot: that it is rehearsed with. every: seconds between samples; None: as its fidelity's
    horizon needs. Where sensors as noisy as the robot's leave it open, quieter ones are asked for.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    found = _procedure(program, robot, every, is_rehearsed=is_rehearsed)
    if found.rehearsal is None or found.rehearsal.decides or not robot.noise:
        return found
    quiet = _procedure(program, replace(robot, noise={}), every, is_rehearsed=is_rehearsed)
    return quiet if quiet.rehearsal is not None and quiet.rehearsal.decides else found


def _procedure(
    program: Program, robot: Robot, every: float | None, *, is_rehearsed: bool
) -> Procedure:
    fidelity = fidelity_of(program)
    fidelity = replace(fidelity, horizon=max(fidelity.horizon, program.field.every))
    every = _period(program, fidelity) if every is None or program.field.is_map else every
    near = within_reach(program, robot, fidelity)
    signals = _signals(program, fidelity, robot)
    tried, plans = usable_plans(near, fidelity, robot, signals, every)
    paths = paths_of(near, plans, robot, every, SEED)
    effects = effects_of(near, fidelity, plans, every, robot.levels)
    goals = with_effects(goals_of(near, fidelity, paths, robot.levels), effects)
    runs = chosen_runs(goals, fidelity.coverage)
    if len(runs) > MANY and robot.levels:
        free = replace(robot, levels={})
        return _procedure(program, free, every, is_rehearsed=is_rehearsed)
    chosen = plans.part(np.array(runs, dtype=np.int64))
    lasts = rounded_down(paths.times[paths.alive - 1][list(runs)], every)
    repeats, rehearsal = 1, None
    if is_rehearsed and runs:
        staging = Staging(program, near, robot, chosen, lasts, signals, every, SEED)
        repeats, rehearsal = rehearsed(staging, tuple(fidelity.tolerance))
    told = zip(runs, lasts, strict=True)
    return Procedure(
        name=program.name,
        horizon=fidelity.horizon,
        rate=1.0 / every,
        drives=tuple(_drive(program, plans, goals, *each, repeats) for each in told),
        signals=signals,
        excited=tuple(_excitation(program, chosen, runs, name, effects[name]) for name in effects),
        required=fidelity.coverage if fidelity.region else 0.0,
        lateness=_lateness(near, fidelity, robot, chosen, every),
        remarks=(
            *_remarks(fidelity, goals, runs, rehearsal),
            *left_out(program, tried, plans),
            *untold(effects),
        ),
        rehearsal=rehearsal,
    )


def rounded_down(lasts: Array, every: float) -> Array:
    """How long runs last (s), in steps that people can tell; no less than half of it."""
    steps = [step for step in ROUND_SECONDS if step >= every] or [every]
    for step in steps:
        lasts = np.where(lasts >= 4.0 * step, np.floor(lasts / step + 1e-9) * step, lasts)
    return lasts


def _lateness(
    program: Program, fidelity: Fidelity, robot: Robot, chosen: Plans, every: float
) -> Lateness | None:
    """What the timing of the robot takes up in the chosen runs; None of what follows at once."""
    if robot.is_prompt or program.field.is_map or not len(chosen.start):
        return None
    program = without_chance(program)
    paths = paths_of(program, chosen, robot, every, SEED)
    late = lateness_of(program, fidelity, chosen, paths, every)
    factor = borne_factor(program, fidelity, chosen, robot, every)
    return Lateness(robot.period, robot.response_time, float(late.max()), factor)


def _period(program: Program, fidelity: Fidelity) -> float:
    """Seconds between samples: one in each half span that the verifier averages over."""
    if program.field.is_map:
        return program.field.every
    rate = 1.0 / (SPAN * fidelity.horizon)
    return 1.0 / float(np.ceil(rate))


def _signals(program: Program, fidelity: Fidelity, robot: Robot) -> tuple[Signal, ...]:
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
        noise = declared.get(part.name, _noise(program, part, fidelity, robot))
        is_sensed = isinstance(part, State) and not part.is_driven
        is_set = isinstance(part, Control)
        found.append(Signal(part.name, part.unit, float(noise), values, is_set, is_sensed))
    return tuple(found)


def _noise(program: Program, part: State | Control, fidelity: Fidelity, robot: Robot) -> float:
    """That of the robot's own sensor, but no less than is usual."""
    if isinstance(part, Control) or part.kind is Kind.DISCRETE:
        return 0.0
    own = robot.noise.get(part.name, 0.0)
    if part.name in fidelity.tolerance:
        return max(own, _one_digit(QUIET * fidelity.tolerance[part.name], part.unit))
    levels = [abs(each - part.low) for each in threshold_levels(program, part)]
    usual = min([QUIET_INPUT * (part.high - part.low), *(QUIET_LEVEL * each for each in levels)])
    return max(own, _one_digit(usual, part.unit))


def _one_digit(value: float, unit: Unit) -> float:
    return float(f"{value / unit.scale:.0e}") * unit.scale


def _drive(
    program: Program, plans: Plans, goals: Goals, run: int, lasts: float, repeats: int
) -> Drive:
    """One run in words of the spec, for as long as it lasts."""
    names, read = program.register, names_read(program) | names_guarded(program)
    start = {
        state.name: float(plans.start[run, i])
        for i, state in enumerate(program.states)
        if not plans.inputs[i] or (state.name in read and state.kind is not Kind.DISCRETE)
    }
    entries = [i for i in np.flatnonzero(plans.inputs) if names[i] in read]
    stages = []
    for k in range(plans.held.shape[1]):
        left = min(plans.seconds, lasts - k * plans.seconds)
        if left <= 1e-9:
            break
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
