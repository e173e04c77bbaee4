"""Robots with one departure planted into each, made by a solver of their own.

Each builder gives a trace; steps far below the sample period, delays and lags by the method of
steps, commands held.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from runtime.arrays import Array
from verifier.traces.trace import Series, Trace

FINE = 10
RATE = 20.0


@dataclass(frozen=True)
class Wall:
    """A wall follower: `wanted` jumps every 4 s. All are the spec's values.

    bend: of the turn rate, times the heading's cube. patch: added to it beyond 0.85 m only.
    """

    speed: float = 0.4
    stiffness: float = 2.0
    damping: float = 2.0
    gain: float = 1.0
    offset: float = 0.0
    zone: float = 0.0
    limit: float = np.inf
    late: float = 0.0
    lag: float = 0.0
    logged_late: float = 0.0
    bend: float = 0.0
    patch: float = 0.0


@dataclass(frozen=True)
class Drive:
    """A base under commands that change every 0.7 s; what happens to `turn` before it acts."""

    gain: float = 1.0
    bias: float = 0.0
    limit: float = np.inf
    zone: float = 0.0
    late: float = 0.0
    lag: float = 0.0
    pose_late: float = 0.0


def beyond(value: float, zone: float) -> float:
    """What a dead zone lets through."""
    return float(np.sign(value) * max(abs(value) - zone, 0.0))


def marched(
    rates: Callable[[float, Array], Array], start: Array, seconds: float
) -> tuple[Array, Array]:
    """Times (T,) at 20 Hz and states (T, n), by Heun's rule; commands are held over each step."""
    h = 1.0 / (RATE * FINE)
    count = round(seconds * RATE)
    x, found = start, np.empty((count, len(start)))
    for k in range(count * FINE):
        if k % FINE == 0:
            found[k // FINE] = x
        t = k * h
        a = rates(t, x)
        b = rates(t, x + h * a)
        x = x + 0.5 * h * (a + b)
    return np.arange(count) / RATE, found


def wall(robot: Wall, seed: int, seconds: float = 60.0, noise: float = 1.0) -> Trace:
    """1 cm and 0.02 rad of noise, times `noise`."""
    rng = np.random.default_rng(seed)
    jumps = np.arange(0.0, seconds, 4.0)
    wanted = rng.uniform(0.5, 1.1, len(jumps))
    past: list[tuple[float, float]] = []
    filtered = [0.0]

    def turn(t: float, x: Array) -> float:
        now = wanted[min(int((t + 1e-9) // 4.0), len(wanted) - 1)]
        rate = -robot.stiffness * beyond(x[0] - now, robot.zone) - robot.damping * x[1]
        rate = robot.gain * rate + robot.offset
        rate += robot.bend * x[1] ** 3 + robot.patch * (x[0] > 0.85)
        return float(np.clip(rate, -robot.limit, robot.limit))

    def rates(t: float, x: Array) -> Array:
        asked = turn(t, x)
        if robot.late > 0.0:
            past.append((t, asked))
            back = round(robot.late * RATE * FINE) * 2
            asked = past[max(0, len(past) - 1 - back)][1]
        if robot.lag > 0.0:
            filtered[0] += (asked - filtered[0]) * 0.5 / (RATE * FINE * robot.lag)
            asked = filtered[0]
        return np.array([robot.speed * np.sin(x[1]), asked])

    times, states = marched(rates, np.array([rng.uniform(0.5, 1.1), 0.0]), seconds)
    measured = states + noise * rng.standard_normal(states.shape) * [0.01, 0.02]
    return _trace(
        Series("distance", times, measured[:, 0], "/pose.distance", "sensor"),
        Series("heading", times, measured[:, 1], "/pose.heading", "sensor"),
        Series("wanted", jumps + robot.logged_late, wanted, "/wanted.data", "sensor"),
        speed=0.4,
        stiffness=2.0,
        damping=2.0,
    )


def drive(robot: Drive, seed: int, seconds: float = 60.0, noise: float = 1.0) -> Trace:
    """1 cm and 0.01 rad of noise, times `noise`; heading has a topic of its own."""
    rng = np.random.default_rng(seed)
    switch = np.arange(0.0, seconds, 0.7)
    speed, turn = rng.uniform(0.2, 1.0, len(switch)), rng.uniform(-0.8, 0.8, len(switch))
    filtered = [0.0]

    def at(values: Array, t: float) -> float:
        return float(values[np.clip(int((t + 1e-9) // 0.7), 0, len(values) - 1)])

    def rates(t: float, x: Array) -> Array:
        asked = float(np.clip(at(turn, t - robot.late), -robot.limit, robot.limit))
        asked = beyond(robot.gain * asked + robot.bias, robot.zone)
        if robot.lag > 0.0:
            filtered[0] += (asked - filtered[0]) * 0.5 / (RATE * FINE * robot.lag)
            asked = filtered[0]
        v = at(speed, t)
        return np.array([v * np.cos(x[2]), v * np.sin(x[2]), asked])

    times, states = marched(rates, np.array([0.0, 0.0, 1.0]), seconds)
    measured = states + noise * rng.standard_normal(states.shape) * [0.01, 0.01, 0.01]
    return _trace(
        Series("x", times + robot.pose_late, measured[:, 0], "/gps.x", "sensor"),
        Series("y", times + robot.pose_late, measured[:, 1], "/gps.y", "sensor"),
        Series("heading", times, measured[:, 2], "/imu.yaw", "sensor"),
        Series("speed", switch, speed, "/cmd.speed", "sensor"),
        Series("turn", switch, turn, "/cmd.turn", "sensor"),
    )


def oscillator(mu: float, pace: float, offset: float, seed: int, seconds: float = 60.0) -> Trace:
    """Van der Pol's, `pace` times as fast, its x seen `offset` too high; noise of 0.02."""
    rng = np.random.default_rng(seed)

    def rates(_: float, x: Array) -> Array:
        return pace * np.array([x[1], mu * (1.0 - x[0] ** 2) * x[1] - x[0]])

    start = np.array([rng.uniform(0.5, 1.5), rng.uniform(-1.0, 1.0)])
    times, states = marched(rates, start, seconds)
    measured = states + 0.02 * rng.standard_normal(states.shape) + [offset, 0.0]
    return _trace(
        Series("x", times, measured[:, 0], "/state.x", "sensor"),
        Series("v", times, measured[:, 1], "/state.v", "sensor"),
        mu=1.0,
    )


def scaled(trace: Trace, name: str, factor: float) -> Trace:
    """One series in another unit, or with another sign."""
    series = trace.series[name]
    other = replace(series, values=factor * series.values)
    return replace(trace, series={**trace.series, name: other})


def shifted(trace: Trace, name: str, late: float) -> Trace:
    """One series stamped late."""
    series = trace.series[name]
    other = replace(series, times=series.times + late)
    return replace(trace, series={**trace.series, name: other})


def swapped(trace: Trace, a: str, b: str) -> Trace:
    """Two series in each other's place."""
    one, other = trace.series[a], trace.series[b]
    pair = {a: replace(other, name=a), b: replace(one, name=b)}
    return replace(trace, series={**trace.series, **pair})


def _trace(*parts: Series, **constants: float) -> Trace:
    return Trace("drive.mcap", {part.name: part for part in parts}, constants, 0.0, (), ())
