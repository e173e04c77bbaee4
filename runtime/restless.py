"""A behavior with noise, run alone: the field for a while, then a kick by chance, and so on.

Between two kicks the field is integrated as it is without noise; a kick is one increment of Euler
and Maruyama (Kloeden, Platen 1992, 9.1), its size worked out where the state was before. So the
noise has weak order 1 in the time between two kicks, and the field its own error control.
"""

import math
from collections.abc import Callable
from typing import Final, TypeAlias, final

import numpy as np

from runtime import chance
from runtime.arrays import Array, Integers
from runtime.flow import Flow, registers
from runtime.integrators import ENDINGS, Trajectories
from runtime.machine import evaluate
from runtime.rollout import Ending, Switches

KICKS: Final = 4
"""Kicks between two samples, for what runs continuously; a step map has one at each step."""

COMPLETED: Final = ENDINGS.index(Ending.COMPLETED)

Moved: TypeAlias = Callable[[Array, Array, Array], Trajectories]
"""From states (B, n) under controls (B, p) over times (2,), as without noise."""


def restless(flow: Flow, x0: Array, u: Array, times: Array, seed: int, move: Moved) -> Trajectories:
    """States (B, T, n) at `times` (T,) from x0 (B, n); trajectory b has chance of its own."""
    kicks = _kicks(flow, len(x0), times, seed)
    run = _Run(x0, times)
    parts = kicks.shape[1] // max(times.size - 1, 1)
    for number in range(kicks.shape[1]):
        sample, part = divmod(number, parts)
        width = (times[sample + 1] - times[sample]) / parts
        begin = times[sample] + part * width
        end = times[sample + 1] if part + 1 == parts else begin + width
        alive = run.alive
        sizes = _sizes(flow, run.x[alive], u[alive])
        run.go(move(run.x[alive], u[alive], np.array([begin, end])))
        spread = 1.0 if flow.is_map else math.sqrt(end - begin)
        kept = np.isin(alive, run.alive)
        run.kick(flow, spread * sizes[kept] * kicks[run.alive, number], end)
        if part + 1 == parts:
            run.states[run.alive, sample + 1] = run.x[run.alive]
        if not run.alive.size:
            break
    return run.trajectories()


@final
class _Run:
    """A batch on its way: those that are alive, where they are, and how the others ended."""

    def __init__(self, x0: Array, times: Array) -> None:
        batch, n = x0.shape
        self.states = np.full((batch, times.size, n), np.nan)
        self.states[:, 0] = x0
        self.x = np.array(x0)
        self.alive = np.arange(batch)
        self._endings = np.zeros(batch, dtype=np.int64)
        self._variables = np.full(batch, -1, dtype=np.int64)
        self._sides = np.zeros(batch, dtype=np.int64)
        self._ended_at = np.full(batch, times[-1])
        self._ended_in = np.array(x0)
        self._switches: list[tuple[Integers, Switches]] = []

    def go(self, ran: Trajectories) -> None:
        """Take what the field did with those alive; `x` of those that go on is at its end."""
        self._switches.append((self.alive, ran.switches))
        lost = ran.endings != COMPLETED
        gone = self.alive[lost]
        self._endings[gone], self._variables[gone] = ran.endings[lost], ran.variables[lost]
        self._sides[gone], self._ended_at[gone] = ran.sides[lost], ran.ended_at[lost]
        self._ended_in[gone] = ran.ended_in[lost]
        self.alive = self.alive[~lost]
        self.x[self.alive] = ran.states[~lost, -1]

    def kick(self, flow: Flow, by: Array, time: float) -> None:
        """Move those alive; one that is kicked out of its domain ends where it was before."""
        n = self.x.shape[1]
        kicked = self.x[self.alive] + by
        low, high = flow.domain[0, :n], flow.domain[1, :n]
        out = ~((low <= kicked) & (kicked <= high))
        outside = out.any(axis=1)
        gone, entries = self.alive[outside], np.argmax(out, axis=1)[outside]
        values = kicked[outside, entries]
        self._endings[gone], self._variables[gone] = ENDINGS.index(Ending.LEFT_DOMAIN), entries
        self._sides[gone] = np.where(values > high[entries], 1, -1)
        self._ended_at[gone], self._ended_in[gone] = time, self.x[gone]
        self.alive = self.alive[~outside]
        self.x[self.alive] = kicked[~outside]

    def trajectories(self) -> Trajectories:
        """What became of all of them."""
        self._ended_in[self.alive] = self.x[self.alive]
        found = (self._endings, self._variables, self._sides, self._ended_at, self._ended_in)
        return Trajectories(self.states, *found, _merged(self._switches))


def _kicks(flow: Flow, batch: int, times: Array, seed: int) -> Array:
    """Standard normal numbers (B, kicks, n) for the states with noise, 0 for the others."""
    count = (times.size - 1) * (1 if flow.is_map else KICKS)
    names = [state.name for state in flow.program.states]
    noisy = [names.index(noise.state) for noise in flow.program.noise]
    kicks = np.zeros((batch, count, len(names)))
    for b in range(batch):
        numbers = chance.generator(seed, "alone", str(b)).standard_normal((count, len(noisy)))
        kicks[b][:, noisy] = numbers
    return kicks


def _sizes(flow: Flow, x: Array, u: Array) -> Array:
    """The size (B, n) of the noise of each state."""
    program = flow.program
    names = [state.name for state in program.states]
    values = evaluate(
        [noise.size for noise in program.noise], program.register, registers(flow, x, u)
    )
    sizes = np.zeros_like(x)
    sizes[:, [names.index(noise.state) for noise in program.noise]] = values
    return sizes


def _merged(parts: list[tuple[Integers, Switches]]) -> Switches:
    """The switches of all parts, by trajectory, in the order of time."""
    filled = [(alive, s) for alive, s in parts if len(s.trajectories)]
    if not filled:
        return parts[0][1]
    trajectories = np.concatenate([alive[s.trajectories] for alive, s in filled])
    order = np.argsort(trajectories, kind="stable")
    return Switches(
        trajectories[order],
        np.concatenate([s.times for _, s in filled])[order],
        np.concatenate([s.left for _, s in filled])[order],
        np.concatenate([s.entered for _, s in filled])[order],
        np.concatenate([s.before for _, s in filled])[order],
        np.concatenate([s.after for _, s in filled])[order],
    )
