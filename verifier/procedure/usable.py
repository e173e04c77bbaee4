"""Runs that can be asked for: within the reach of sensors, where lateness and noise are borne."""

from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Fidelity, Kind, Program
from verifier.procedure.candidates import candidates
from verifier.procedure.driving import Plans
from verifier.procedure.lateness import BORNE, is_clear, lateness_of, paths_of
from verifier.procedure.model import Signal
from verifier.procedure.robot import PROMPT, Robot
from verifier.report.wording import exact, listed

LEAST_REACH: Final = 0.1
"""A sensor that reaches less than this share of the domain limits nothing."""
FEWEST: Final = 0.05
"""Of the runs that are tried, so many are left at least to choose from."""
PACES: Final = {False: (1.0, 4.0), True: (2.0, 4.0)}
"""So many times as long stages last as they need to, the second where the first leaves too few
runs; slower where a late robot changes its mode, so that few windows begin just after that."""
CANDIDATES: Final = 400
"""So many runs are tried, of which a few are chosen."""
SEED: Final = 7


def within_reach(program: Program, robot: Robot, fidelity: Fidelity) -> Program:
    """The program with what is only sensed within the reach of its sensors.

    Where the spec demands a region, or hardly anything would be left, the domain stays.
    """
    states = []
    for state in program.states:
        low, high = robot.reach.get(state.name, (state.low, state.high))
        low, high = max(low, state.low), min(high, state.high)
        is_open = state.kind is Kind.CONTINUOUS and state.name not in fidelity.region
        is_wide = high - low >= LEAST_REACH * (state.high - state.low)
        usable = is_open and not state.is_driven and is_wide
        states.append(replace(state, low=low, high=high) if usable else state)
    return replace(program, states=tuple(states))


def usable_plans(
    program: Program,
    fidelity: Fidelity,
    robot: Robot,
    signals: tuple[Signal, ...],
    every: float,
) -> tuple[Plans, Plans]:
    """The runs that are tried, and those of them that are usable.

    Where hardly any is, things are moved more slowly; where that does not help, all are used.
    """
    told = {each.name: each.noise for each in signals}
    noise = np.array([told.get(state.name, 0.0) for state in program.states])
    first = None
    for slower in PACES[bool(program.field.guards) and not robot.is_prompt]:
        tried = candidates(program, fidelity, robot.levels, CANDIDATES, every, slower)
        first = tried if first is None else first
        good = np.flatnonzero(
            _usable(without_chance(program), fidelity, robot, (tried, noise, every))
        )
        if good.size >= FEWEST * CANDIDATES:
            return tried, tried.part(good)
    assert first is not None, "one pace at least is tried"
    return first, first


def _usable(
    program: Program, fidelity: Fidelity, robot: Robot, given: tuple[Plans, Array, float]
) -> Booleans:
    """Whether, in each run, lateness is borne and noise decides nothing.

    A robot that is late takes the same ways out of modes in it as one that is not.
    """
    tried, noise, every = given
    paths = paths_of(program, tried, robot, every, SEED)
    good = is_clear(program, tried, paths, noise, every)
    if robot.is_prompt:
        return good
    prompt = paths_of(program, tried, PROMPT, every, SEED)
    late = lateness_of(program, fidelity, tried, paths, every)
    return np.asarray(good & (paths.taken == prompt.taken).all(axis=1) & (late < BORNE).all(axis=1))


def without_chance(program: Program) -> Program:
    """The program without its white noise."""
    return replace(program, noise=())


def left_out(program: Program, tried: Plans, kept: Plans) -> tuple[str, ...]:
    """Up to what controls are set, where beyond that a robot so late would depart by that alone."""
    told = []
    for control in program.controls:
        place = program.register.index(control.name)
        every, left = tried.held[..., place], kept.held[..., place]
        ends = []
        if left.max() < every.max():
            ends.append(f"up to {exact(float(left.max()), control.unit)}")
        if left.min() > every.min():
            ends.append(f"from {exact(float(left.min()), control.unit)} on")
        if ends:
            told.append(
                f"{control.name} is asked for {listed(ends)} only: beyond that, reading and acting"
                " so late alone breaks a tolerance"
            )
    return tuple(told)
