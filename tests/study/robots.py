"""Robots for the studies: many at once, integrated here, apart from the runtime.

B runs, T samples of the clock, n states, k inputs. Every robot follows its spec's field but for one
`deviation` and for unrest (white process noise); its sensors add noise.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypeAlias, final

import numpy as np
import numpy.typing as npt

import specc
from runtime.program import Fidelity, Program
from verifier.traces.trace import Series, Trace

Array: TypeAlias = npt.NDArray[np.float64]
Rate: TypeAlias = Callable[[Array, Array, float], Array]
"""Rates (B, n) of states (B, n) under inputs (B, k) of a robot with this deviation."""
Switch: TypeAlias = Callable[[Array, Array], Array]
"""States (B, n) after the switches that are due, under inputs (B, k)."""

CLOCK: Final = 0.01
SPECS: Final = Path(__file__).parents[2] / "specs"


@final
@dataclass(frozen=True, slots=True)
class Robot:
    """A kind of robot, its spec, and how it is driven.

    states, inputs: their names. rate(..., 0.0) is the spec's own field. low, high: of the inputs,
    (k,), which change every `hold` seconds. start: (2, n), between which runs begin. noise: (n,)
    of the sensors. unrest: (n,) per square root of a second. judged: tolerances.
    """

    name: str
    spec: str
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    rate: Rate
    low: tuple[float, ...]
    high: tuple[float, ...]
    hold: float
    start: tuple[tuple[float, ...], tuple[float, ...]]
    noise: tuple[float, ...]
    unrest: tuple[float, ...]
    judged: dict[str, float]
    horizon: float
    switch: Switch | None = None
    mode: str = ""

    def program(self, scale: float = 1.0) -> Program:
        """The spec, with `scale` times the tolerances."""
        program = specc.load_program(SPECS / f"{self.spec}.yaml")
        tolerance = {name: scale * value for name, value in self.judged.items()}
        return replace(
            program,
            fidelity=Fidelity(tolerance, self.horizon, {}, 0.0, "study"),
            judge_when=None,
        )


@final
@dataclass(frozen=True, eq=False, slots=True)
class Drives:
    """What B robots did: times (T,), states (B, T, n), inputs (B, T, k)."""

    times: Array
    states: Array
    inputs: Array


def drive(
    robot: Robot, runs: int, seconds: float, deviation: float, unrest: float, seed: int
) -> Drives:
    """Classical Runge-Kutta on the clock; `unrest` multiplies the robot's own."""
    rng = np.random.default_rng(seed)
    count = round(seconds / CLOCK) + 1
    every = round(robot.hold / CLOCK)
    shape = (runs, count // every + 1, len(robot.inputs))
    inputs = np.repeat(rng.uniform(robot.low, robot.high, shape), every, axis=1)[:, :count]
    state = rng.uniform(*robot.start, (runs, len(robot.states)))
    kick = unrest * np.asarray(robot.unrest) * np.sqrt(CLOCK)
    states = np.empty((runs, count, len(robot.states)))
    for step in range(count):
        states[:, step] = state
        state = advanced(robot, state, inputs[:, step], deviation)
        if unrest > 0.0:
            state = state + kick * rng.standard_normal(state.shape)
        if robot.switch is not None:
            state = robot.switch(state, inputs[:, step])
    return Drives(CLOCK * np.arange(count), states, inputs)


def advanced(robot: Robot, state: Array, inputs: Array, deviation: float) -> Array:
    """One step of the clock."""
    k1 = robot.rate(state, inputs, deviation)
    k2 = robot.rate(state + 0.5 * CLOCK * k1, inputs, deviation)
    k3 = robot.rate(state + 0.5 * CLOCK * k2, inputs, deviation)
    k4 = robot.rate(state + CLOCK * k3, inputs, deviation)
    return state + CLOCK / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def measured(  # as many as a log has conditions
    program: Program,
    robot: Robot,
    drives: Drives,
    run: int,
    rate: float,
    noise: float,
    memory: float,
    seed: int,
) -> Trace:
    """The log of one run, sampled `rate` times a second; other controls stay at their defaults.

    noise multiplies that of the sensors; memory is the correlation of its successive values.
    """
    rng = np.random.default_rng([seed, run])
    every = round(1.0 / (rate * CLOCK))
    times, states = drives.times[::every], drives.states[run, ::every]
    white = rng.standard_normal(states.shape)
    for k in range(1, len(white)) if memory > 0.0 else ():
        white[k] = memory * white[k - 1] + np.sqrt(1.0 - memory**2) * white[k]
    values = states + noise * np.asarray(robot.noise) * white
    series = {
        name: Series(name, times, values[:, i], f"/{name}", "sensor")
        for i, name in enumerate(robot.states)
    }
    for i, name in enumerate(robot.inputs):
        command = drives.inputs[run, :, i]
        change = np.concatenate([[True], np.diff(command) != 0.0])
        series[name] = Series(name, drives.times[change], command[change], f"/{name}", "sensor")
    constants = {c.name: c.default for c in program.controls if c.name not in series}
    return Trace("study", series, constants, 0.0, (), ())


def _wall(state: Array, inputs: Array, deviation: float) -> Array:
    distance, heading = state.T
    turn = -2.0 * (distance - inputs[:, 0]) - 2.0 * heading + deviation
    return np.stack([0.4 * np.sin(heading), turn], axis=-1)


def _soft_wall(state: Array, inputs: Array, deviation: float) -> Array:
    distance, heading = state.T
    turn = -2.0 * (1.0 + deviation) * (distance - inputs[:, 0]) - 2.0 * heading
    return np.stack([0.4 * np.sin(heading), turn], axis=-1)


def _base(state: Array, inputs: Array, deviation: float) -> Array:
    heading, (speed, turn) = state[:, 2], inputs.T
    forward = np.stack([np.cos(heading), np.sin(heading)], axis=-1) * speed[:, None]
    return np.concatenate([forward, (0.944 * turn + deviation)[:, None]], axis=-1)


def _swing(state: Array, _inputs: Array, deviation: float) -> Array:
    x, v = state.T
    return np.stack([v, (1.0 + deviation) * (1.0 - x**2) * v - x], axis=-1)


def _shuttle(state: Array, _inputs: Array, deviation: float) -> Array:
    _, v, going = state.T
    wanted = np.where(going == 0.0, 0.5 + deviation, -0.5)
    return np.stack([v, 2.0 * (wanted - v), np.zeros_like(v)], axis=-1)


def _turn_round(state: Array, _inputs: Array) -> Array:
    x, v, going = state.T
    far, near = (going == 0.0) & (x >= 1.5), (going == 1.0) & (x <= -1.5)
    v = np.where(far, -0.5, np.where(near, 0.5, v))
    return np.stack([x, v, np.where(far, 1.0, np.where(near, 0.0, going))], axis=-1)


WALL: Final = Robot(
    name="wall follower, turn offset",
    spec="wall_follow",
    states=("distance", "heading"),
    inputs=("wanted",),
    rate=_wall,
    low=(0.6,),
    high=(1.0,),
    hold=3.0,
    start=((0.6, -0.2), (1.0, 0.2)),
    noise=(0.01, 0.02),
    unrest=(0.002, 0.01),
    judged={"distance": 0.03, "heading": 0.04},
    horizon=2.0,
)
SOFT_WALL: Final = replace(WALL, name="wall follower, gain", rate=_soft_wall)
BASE: Final = Robot(
    name="base with a heading, gyro offset",
    spec="husky_drive",
    states=("x", "y", "heading"),
    inputs=("speed", "turn"),
    rate=_base,
    low=(0.3, -0.5),
    high=(1.0, 0.5),
    hold=1.5,
    start=((-1.0, -1.0, -3.0), (1.0, 1.0, 3.0)),
    noise=(0.01, 0.01, 0.005),
    unrest=(0.005, 0.005, 0.002),
    judged={"x": 0.12, "y": 0.12, "heading": 0.03},
    horizon=2.0,
)
SWING: Final = Robot(
    name="Van der Pol oscillator, mu",
    spec="van_der_pol",
    states=("x", "v"),
    inputs=(),
    rate=_swing,
    low=(),
    high=(),
    hold=1.0,
    start=((-1.5, -1.0), (1.5, 1.0)),
    noise=(0.01, 0.01),
    unrest=(0.005, 0.005),
    judged={"x": 0.05, "v": 0.1},
    horizon=2.0,
)
SHUTTLE: Final = Robot(
    name="patrol with modes, speed of one",
    spec="patrol",
    states=("x", "v", "going"),
    inputs=(),
    rate=_shuttle,
    low=(),
    high=(),
    hold=1.0,
    start=((-1.0, 0.5, 0.0), (1.0, 0.5, 0.0)),
    noise=(0.005, 0.01, 0.0),
    unrest=(0.002, 0.005, 0.0),
    judged={"x": 0.03, "v": 0.03},
    horizon=1.5,
    switch=_turn_round,
    mode="going",
)
ROBOTS: Final = (WALL, BASE, SWING, SHUTTLE)
