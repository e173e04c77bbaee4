"""Runs of a behavior alone, many at once, in stages.

At the start of a stage controls are set; what is only sensed is moved evenly to its value at the
end of the stage, as things move, or, if it is discrete, changes at the start.

Letters: C runs, K stages, T samples, n states, p controls, r = n + p entries of the register.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.code import Code
from runtime.program import Control, Kind, Program, State
from runtime.rollout import Rollout
from runtime.simulate import simulate

RAMP: Final = ".rate"
"""Behind the name of a quantity: of the control that moves it."""
STEEPEST: Final = 1e6
"""No quantity is moved faster than through so many ranges in a second."""
SHORT: Final = 3.0
"""A stay in a mode that is shorter than so many samples is in no log as it was."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Plans:
    """What C runs are to do: start (C, n), held (C, K, r), all SI.

    Of `held` those entries count that are `inputs` (r,): controls, and sensed quantities that the
    spec gives no closure, at the end of the stage. seconds: of each stage.
    """

    start: Array
    held: Array
    inputs: Booleans
    seconds: float

    def part(self, which: Integers) -> "Plans":
        """Some of the runs."""
        return Plans(self.start[which], self.held[which], self.inputs, self.seconds)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Paths:
    """How C runs went: times (T,), register (C, T, r), angles not wrapped.

    alive: (C,) so many samples until the state left its domain, or the mode changed again at once,
    or T. taken: (C, g) how often each
    way out of a mode was taken.
    """

    times: Array
    register: Array
    alive: Integers
    taken: Integers

    @property
    def is_alive(self) -> Booleans:
        """(C, T) whether a sample comes before the end."""
        return np.asarray(np.arange(self.times.size) < self.alive[:, None])


def inputs_of(program: Program) -> Booleans:
    """(r,) which entries of the register somebody else sets, or has to arrange."""
    sensed = [
        not s.is_driven and s.closure is None and s.name != program.field.mode
        for s in program.states
    ]
    return np.array([*sensed, *(True for _ in program.controls)], dtype=np.bool_)


def driven_paths(program: Program, plans: Plans, every: float, seed: int) -> Paths:
    """Drive every run, with a sample `every` so many seconds; seed: of the program's own noise."""
    n, stages = len(program.states), plans.held.shape[1]
    moving, ramps = ramped(program), ramps_of(program)
    state, parts, switched = plans.start.copy(), [], []
    dead = np.zeros(len(state), dtype=np.bool_)
    alive = np.zeros(len(state), dtype=np.int64)
    for k in range(stages):
        held = plans.held[:, k]
        state = within_domain(program, steps_taken(program, plans, ramps, state, held))
        controls = controls_in_stage(program, ramps, state, held, plans.seconds)
        starts = dict(zip([s.name for s in program.states], state.T, strict=True))
        rollout = simulate(moving, starts, plans.seconds, controls, every, seed=seed + k)
        switched.append(_ways(program, rollout, k * plans.seconds))
        last = k == stages - 1
        states = rollout.states if last else rollout.states[:, :-1]
        lives = np.sum(np.isfinite(rollout.states).all(axis=-1), axis=1)
        alive += np.where(dead, 0, np.minimum(lives, states.shape[1]))
        dead |= lives < rollout.times.size
        given = np.broadcast_to(held[:, None, n:], (*states.shape[:2], held.shape[1] - n))
        parts.append(np.concatenate([states, given], axis=-1))
        state = np.where(np.isfinite(rollout.ended_in), rollout.ended_in, state)
    register = np.concatenate(parts, axis=1)
    ways = np.concatenate(switched, axis=0)
    return paths_until(program, register, float(rollout.times[1]), alive, ways)


def paths_until(
    program: Program, register: Array, period: float, alive: Integers, ways: Array
) -> Paths:
    """The paths, each until its state left its domain or its mode changed again at once."""
    ends = np.minimum(alive * period, _at_once(ways, len(alive), SHORT * period))
    counts = np.zeros((len(alive), len(program.field.guards)), dtype=np.int64)
    run, way = ways[:, 0].astype(np.int64), ways[:, 2].astype(np.int64)
    inside = (ways[:, 1] < ends[run]) & (way >= 0)
    np.add.at(counts, (run[inside], way[inside]), 1)
    times = np.asarray(np.arange(register.shape[1]) * period, dtype=np.float64)
    return Paths(times, register, np.floor(ends / period + 1e-9).astype(np.int64), counts)


def ramped(program: Program) -> Program:
    """The program with a control more for each quantity that is moved evenly: its rate."""
    states, rates = [], []
    for state, is_input in zip(program.states, inputs_of(program), strict=False):
        if not is_input or state.kind is Kind.DISCRETE:
            states.append(state)
            continue
        name, width = state.name + RAMP, (state.high - state.low) * STEEPEST
        code = f"{state.name} {name} add" if program.field.is_map else name
        states.append(replace(state, closure=Code(code)))
        rates.append(Control(name, state.unit, -width, width, 0.0, "", ""))
    return replace(program, states=tuple(states), controls=(*program.controls, *rates))


def ramps_of(program: Program) -> Integers:
    """The places of the states that are moved evenly."""
    inputs = inputs_of(program)[: len(program.states)]
    smooth = [state.kind is not Kind.DISCRETE for state in program.states]
    return np.flatnonzero(inputs & np.array(smooth))


def steps_taken(
    program: Program, plans: Plans, ramps: Integers, state: Array, held: Array
) -> Array:
    """The states (C, n) at the start of a stage: what is discrete jumps, what is moved goes on."""
    n = len(program.states)
    jumps = plans.inputs[:n].copy()
    jumps[ramps] = False
    return np.where(jumps, held[:, :n], state)


def controls_in_stage(
    program: Program, ramps: Integers, state: Array, held: Array, seconds: float
) -> dict[str, Array]:
    """What is set in a stage (C,): the controls, and how fast each quantity is moved."""
    n = len(program.states)
    names = [control.name for control in program.controls]
    controls = dict(zip(names, held[:, n:].T, strict=True))
    steps = round(seconds / program.field.every) if program.field.is_map else seconds
    for place in ramps:
        name = program.states[place].name + RAMP
        controls[name] = (held[:, place] - state[:, place]) / steps
    return controls


def within_domain(program: Program, states: Array) -> Array:
    """States (C, n) that rounding put outside their domain, at its edge."""
    columns = [_clipped(s, states[:, i]) for i, s in enumerate(program.states)]
    return np.stack(columns, axis=-1)


def _clipped(state: State, values: Array) -> Array:
    return np.clip(values, state.low, state.high) if state.kind is Kind.CONTINUOUS else values


def _ways(program: Program, rollout: Rollout, since: float) -> Array:
    """(k, 3) of each change of mode: the run, when, and the guard's index, -1 where it has none."""
    found = rollout.switches
    way = np.full(len(found), -1)
    for index, guard in enumerate(program.field.guards):
        way[(found.left == guard.mode) & (found.entered == guard.target)] = index
    return np.column_stack([found.trajectories, found.times + since, way]).reshape(-1, 3)


def _at_once(ways: Array, runs: int, short: float) -> Array:
    """(C,) when the mode first changes so shortly after it began that no log shows it; inf."""
    begins = np.column_stack([np.arange(runs), np.zeros(runs), np.full(runs, -1)])
    every = np.concatenate([begins, ways])
    every = every[np.lexsort((every[:, 1], every[:, 0]))]
    same = every[1:, 0] == every[:-1, 0]
    hurried = same & (every[1:, 1] - every[:-1, 1] < short)
    found: Array = np.full(runs, np.inf)
    np.minimum.at(found, every[:-1][hurried, 0].astype(np.int64), every[:-1][hurried, 1])
    return found
