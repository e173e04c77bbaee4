"""Runs of a robot that reads at its ticks, acts a response time later, and holds that meanwhile.

At each tick the rates of the driven states follow from what was read, and its mode changes; between
two commands those rates stand. What the world moves goes on all the time.

Letters: C runs, T samples, n states, r entries of the register.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.flow import Flow, flow_of, rates, registers
from runtime.machine import evaluate
from runtime.program import Kind, Program
from verifier.procedure.driving import (
    Paths,
    Plans,
    controls_in_stage,
    paths_until,
    ramped,
    ramps_of,
    steps_taken,
    within_domain,
)
from verifier.procedure.robot import Robot

STEP: Final = 0.01
"""The world goes on in steps of so many seconds at most."""
SLACK: Final = 1e-9


@final
@dataclass(frozen=True, eq=False, slots=True)
class Command:
    """Rates (C, n) that stand from the time `since` on."""

    since: float
    rates: Array


@final
class Follower:
    """C robots of one kind, from tick to tick.

    noise (n,): of what they read. ways: rows of run, time and guard of each change of mode.
    """

    def __init__(self, flow: Flow, robot: Robot, noise: Array, rng: np.random.Generator) -> None:
        self.flow, self.robot, self.noise, self.rng = flow, robot, noise, rng
        self.own = np.array([s.name in robot.own for s in flow.program.states])
        self.ways: list[Array] = []
        self.ticks = 0
        self._queue: list[Command] = []

    def rates(self, time: float, x: Array, u: Array) -> Array:
        """What stands at a time, after a tick if one is due; x (C, n) takes what a tick changes."""
        if not self._queue:
            self._queue = [Command(time, rates(self.flow, x, u))]
        if time + SLACK >= self.ticks * self.robot.period:
            self.ticks += 1
            self._tick(time, x, u)
        while len(self._queue) > 1 and self._queue[1].since <= time + SLACK:
            self._queue.pop(0)
        return np.where(self.own, self._queue[-1].rates, self._queue[0].rates)

    def _tick(self, time: float, x: Array, u: Array) -> None:
        read = self._read(x)
        self._switch(time, x, read, u)
        told = rates(self.flow, read, u)
        self._queue.append(Command(time + self.robot.response_time, told))

    def _read(self, x: Array) -> Array:
        """What the sensors say, within the domain."""
        noise = np.where(self.own, 0.0, self.noise)
        read = x + noise * self.rng.standard_normal(x.shape) if noise.any() else x.copy()
        return within_domain(self.flow.program, read)

    def _switch(self, time: float, x: Array, read: Array, u: Array) -> None:
        """The first way that is open is taken."""
        program = self.flow.program
        if not program.field.guards:
            return
        column = [state.name for state in program.states].index(program.field.mode)
        names = program.register
        register = registers(self.flow, read, u)
        codes = [guard.condition for guard in program.field.guards]
        is_open = evaluate(codes, names, register) >= 0.0
        mode, left = x[:, column].copy(), np.ones(len(x), dtype=np.bool_)
        for index, guard in enumerate(program.field.guards):
            goes = left & is_open[:, index] & (mode == guard.mode)
            if not goes.any():
                continue
            left &= ~goes
            jumps = [code for _, code in guard.resets]
            values = evaluate(jumps, names, register) if jumps else np.zeros((len(x), 0))
            for k, (name, _) in enumerate(guard.resets):
                place = names.index(name)
                x[goes, place] = read[goes, place] = values[goes, k]
            x[goes, column] = read[goes, column] = float(guard.target)
            runs = np.flatnonzero(goes)
            told = np.column_stack([runs, np.full(runs.size, time), np.full(runs.size, index)])
            self.ways.append(told)


def sampled_paths(
    program: Program, plans: Plans, robot: Robot, every: float, seed: int, noise: Array
) -> Paths:
    """Drive every run by such a robot, with a sample `every` so many seconds.

    noise (n,): of what it reads. seed: of that, and of the program's own.
    """
    moving = ramped(program)
    flow, ramps = flow_of(moving), ramps_of(program)
    rng = np.random.default_rng(seed)
    follower = Follower(flow, robot, noise, rng)
    fine = int(np.ceil(every / STEP - SLACK))
    step, steps = every / fine, round(plans.seconds / every) * fine
    n, stages = len(program.states), plans.held.shape[1]
    x, time, parts = plans.start.copy(), 0.0, []
    for k in range(stages):
        held = plans.held[:, k]
        x = within_domain(program, steps_taken(program, plans, ramps, x, held))
        controls = controls_in_stage(program, ramps, x, held, plans.seconds)
        u = np.column_stack([controls[control.name] for control in moving.controls])
        for i in range(steps + (k == stages - 1)):
            standing = follower.rates(time, x, u)
            if i % fine == 0:
                parts.append(np.concatenate([x, u[:, : held.shape[1] - n]], axis=-1))
            x = _moved(flow, x, u, standing, (step, rng))
            time += step
    register = np.stack(parts, axis=1)
    ways = np.concatenate([np.zeros((0, 3)), *follower.ways])
    return paths_until(program, register, every, _alive(program, register), ways)


def _moved(
    flow: Flow, x: Array, u: Array, standing: Array, how: tuple[float, np.random.Generator]
) -> Array:
    """One step on: what is driven by what stands, all else as the world moves it."""
    step, rng = how
    program = flow.program
    drives = np.array([state.is_driven for state in program.states])
    moved: Array = x + step * np.where(drives, standing, rates(flow, x, u))
    if program.noise:
        codes = [each.size for each in program.noise]
        sizes = evaluate(codes, program.register, registers(flow, x, u))
        places = [program.register.index(each.state) for each in program.noise]
        moved[:, places] += np.sqrt(step) * sizes * rng.standard_normal(sizes.shape)
    return moved


def _alive(program: Program, register: Array) -> Integers:
    """(C,) so many samples until a state is outside its domain."""
    inside: Booleans = np.asarray(np.isfinite(register).all(axis=-1))
    for i, state in enumerate(program.states):
        if state.kind is Kind.CONTINUOUS:
            inside &= (register[..., i] >= state.low) & (register[..., i] <= state.high)
    ends = np.where(inside.all(axis=1), register.shape[1], np.argmin(inside, axis=1))
    return np.asarray(ends, dtype=np.int64)
