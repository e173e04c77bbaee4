"""By how much a robot departs from the field through nothing but its lateness."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.machine import evaluate
from runtime.program import Fidelity, Kind, Program
from verifier.procedure.driving import Paths, Plans, driven_paths
from verifier.procedure.robot import Robot
from verifier.procedure.sampled import sampled_paths

BORNE: Final = 0.75
"""A run is not asked for in which lateness alone takes up so much of a tolerance."""
SLOWER: Final = (1.5, 2.0, 3.0, 5.0, 8.0)
"""So many times later robots are tried."""
SURE: Final = 4.0
"""So many deviations of the noise are kept from a threshold, where a stage ends."""
SEED: Final = 13


def paths_of(program: Program, plans: Plans, robot: Robot, every: float, seed: int) -> Paths:
    """Every run driven by a robot of this timing that reads without noise."""
    if robot.is_prompt or program.field.is_map:
        return driven_paths(program, plans, every, seed)
    quiet = np.zeros(len(program.states))
    return sampled_paths(program, plans, robot, every, seed, quiet)


def lateness_of(
    program: Program, fidelity: Fidelity, plans: Plans, paths: Paths, every: float
) -> Array:
    """(C, K) how far the paths depart from the field, in tolerances, at worst in each stage.

    The program has no chance in it.
    From the paths' own states the field goes on for one horizon, at several places of a stage; not
    at the beginning of a later one, where the robot still follows what was set before, but right
    after its mode changed, where it does so, too: there the field turns at once.
    """
    runs, stages = plans.held.shape[:2]
    span, stage = (round(t / every) for t in (fidelity.horizon, plans.seconds))
    span = max(span, 1)
    worst = np.zeros((runs, stages))
    for k in range(stages):
        for begin in range(k * stage + (span if k else 0), (k + 1) * stage - span + 1, span):
            apart = _departures(program, fidelity, (plans, paths, every), k, np.full(runs, begin))
            worst[:, k] = np.maximum(worst[:, k], apart)
        for begins in _changed(program, paths, k * stage, (k + 1) * stage - span):
            apart = _departures(program, fidelity, (plans, paths, every), k, begins)
            worst[:, k] = np.maximum(worst[:, k], apart)
    return worst


def _changed(program: Program, paths: Paths, begin: int, end: int) -> Iterator[Integers]:
    """(C,) the first sample after the first change of mode between two samples; else -1."""
    if not program.field.guards or end <= begin:
        return
    modes = paths.register[:, begin : end + 1, program.register.index(program.field.mode)]
    is_new = modes[:, 1:] != modes[:, :-1]
    yield np.where(is_new.any(axis=1), begin + 1 + np.argmax(is_new, axis=1), -1)


def _departures(
    program: Program,
    fidelity: Fidelity,
    driven: tuple[Plans, Paths, float],
    stage: int,
    begins: Integers,
) -> Array:
    """(C,) in tolerances a horizon after samples (C,); 0 where that is -1, or can't be told."""
    plans, paths, every = driven
    n, names, rows = len(program.states), program.register, np.arange(len(begins))
    span = max(round(fidelity.horizon / every), 1)
    begin = np.maximum(begins, 0)
    start, after = paths.register[rows, begin, :n], paths.register[rows, begin + span, :n]
    held = plans.held[:, stage : stage + 1].copy()
    held[:, 0, :n] = np.where(plans.inputs[:n], after, held[:, 0, :n])
    told = np.isfinite(start).all(axis=1) & np.isfinite(after).all(axis=1)
    told &= (begins >= 0) & (paths.alive > begin + span)
    shots = replace(
        plans,
        start=np.where(told[:, None], start, plans.start),
        held=np.where(told[:, None, None], held, plans.held[:, stage : stage + 1]),
        seconds=span * every,
    )
    field = driven_paths(program, shots, every, SEED).register[:, -1, :n]
    for i, state in enumerate(program.states):
        if state.kind is Kind.DISCRETE:
            through = paths.register[rows[:, None], begin[:, None] + np.arange(span + 1), i]
            told &= np.all(through == start[:, None, i], axis=1) & (field[:, i] == start[:, i])
    apart = [np.abs(after[:, names.index(v)] - field[:, names.index(v)]) / t
             for v, t in fidelity.tolerance.items()]  # fmt: skip
    return np.where(told, np.nan_to_num(np.max(apart, axis=0)), 0.0)


def is_clear(program: Program, plans: Plans, paths: Paths, noise: Array, every: float) -> Booleans:
    """(C,) whether no way out of a mode is about to open, or just open, where a stage ends.

    There what is moved turns round, and noise (n,) of what is read would decide whether it is
    taken. In whatever mode: the last tick may just have changed it.
    """
    codes = [guard.condition for guard in program.field.guards]
    if not codes:
        return np.ones(len(plans.start), dtype=np.bool_)
    names = program.register
    stage = round(plans.seconds / every)
    ends = np.arange(1, plans.held.shape[1] + 1) * stage
    at = np.minimum(ends[None, :], np.maximum(paths.alive - 1, 0)[:, None])
    register = paths.register[np.arange(len(at))[:, None], at]
    constants = np.array([constant.value for constant in program.constants])
    whole = np.concatenate(
        [register, np.broadcast_to(constants, (*register.shape[:2], constants.size))], axis=-1
    )
    values = evaluate(codes, names, whole)
    doubt = np.zeros_like(values)
    for i, each in enumerate(noise):
        aside = whole.copy()
        aside[..., i] += SURE * each
        doubt += np.abs(evaluate(codes, names, aside) - values)
    return np.asarray((np.abs(values) > doubt).all(axis=(1, 2)))


def borne_factor(
    program: Program, fidelity: Fidelity, plans: Plans, robot: Robot, every: float
) -> float:
    """How many times later a robot breaks a tolerance by that alone; 0 if none tried does.

    The program has no chance in it.
    """
    for factor in SLOWER:
        slower = replace(
            robot, period=factor * robot.period, response_time=factor * robot.response_time
        )
        paths = paths_of(program, plans, slower, every, SEED)
        if lateness_of(program, fidelity, plans, paths, every).max(initial=0.0) > 1.0:
            return factor
    return 0.0
