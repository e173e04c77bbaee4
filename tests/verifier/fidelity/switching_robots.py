"""Robots with modes, made by scipy's events from their own rates, and logs of them."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from verifier.traces.trace import Series, Trace

Rate = Callable[[float, Array], list[float]]


@dataclass(frozen=True)
class Leave:
    """A way out: taken where `event` rises through 0; `jump` gives the state after it."""

    event: Callable[[Array], float]
    target: str
    jump: Callable[[Array], list[float]] = list


@dataclass(frozen=True)
class Robot:
    """A field and ways out for each mode; `logged` is what a mode calls itself in the log.

    step: longer ones might pass over a way out that is open for a short while.
    """

    rates: dict[str, Rate]
    leave: dict[str, list[Leave]]
    logged: dict[str, str] = field(default_factory=dict)
    step: float = np.inf


def run(robot: Robot, mode: str, start: list[float], times: Array) -> tuple[Array, list[str]]:
    """States (T, n) and the logged modes at `times`; at a switch, those before it."""
    states, modes, x, t = np.empty((len(times), len(start))), [], np.array(start), times[0]
    while t < times[-1]:
        events = [_event(leave.event) for leave in robot.leave[mode]]
        found = solve_ivp(
            robot.rates[mode],
            (t, times[-1]),
            x,
            method="DOP853",
            rtol=1e-9,
            atol=1e-10,
            max_step=robot.step,
            events=events,
            dense_output=True,
        )
        here = (times >= t) & (times <= found.t[-1])
        here &= np.arange(len(times)) >= len(modes)
        states[here] = found.sol(times[here]).T
        modes += [robot.logged.get(mode, mode)] * int(np.sum(here))
        t, x = found.t[-1], found.y[:, -1]
        for leave, hits in zip(robot.leave[mode], found.t_events or [], strict=True):
            if len(hits):
                mode, x = leave.target, np.array(leave.jump(x))
                break
    return states, modes


def log(  # what a log is made of
    names: tuple[str, ...],
    robot: tuple[Array, list[str]],
    times: Array,
    noise: dict[str, float],
    seed: int,
    mode: tuple[str, tuple[str, ...]],
    **constants: float,
) -> Trace:
    """The log of a run, with white noise on the states and the mode with every sample."""
    rng = np.random.default_rng(seed)
    states, modes = robot
    series = {
        name: Series(
            name,
            times,
            states[:, i] + noise[name] * rng.standard_normal(len(times)),
            f"/{name}",
            "sensor",
        )
        for i, name in enumerate(names)
    }
    values = np.array([float(mode[1].index(each)) for each in modes])
    series[mode[0]] = Series(mode[0], times, values, f"/{mode[0]}", "sensor")
    return Trace("drive.mcap", series, constants, 0.0, (), ())


def _event(value: Callable[[Array], float]) -> Callable[[float, Array], float]:
    def event(_: float, x: Array) -> float:
        return value(x)

    event.terminal = True  # type: ignore[attr-defined]  # as scipy asks for it
    event.direction = 1.0  # type: ignore[attr-defined]
    return event


@dataclass(frozen=True)
class Patrol:
    """The patrol of specs/patrol.yaml: where it turns, how fast it goes, and with which resets."""

    x1: float = 1.5
    x2: float = -1.5
    v1: float = 0.5
    v2: float = 0.5
    kept: float = 1.0
    """The share of the reset speed that it has after a turn."""

    def robot(self) -> Robot:
        return Robot(
            {
                "forward": lambda _, s: [s[1], 2.0 * (self.v1 - s[1])],
                "back": lambda _, s: [s[1], 2.0 * (-self.v2 - s[1])],
            },
            {
                "forward": [
                    Leave(lambda s: s[0] - self.x1, "back", lambda s: [s[0], -self.kept * self.v2])
                ],
                "back": [
                    Leave(
                        lambda s: self.x2 - s[0], "forward", lambda s: [s[0], self.kept * self.v1]
                    )
                ],
            },
        )


NOISE = {"x": 0.01, "v": 0.02}
SPEC = {"x1": 1.5, "x2": -1.5, "v1": 0.5, "v2": 0.5}
MODES = ("going", ("forward", "back"))


def patrol_log(
    patrol: Robot, seconds: float, seed: int, every: float = 0.05, noise: float = 1.0
) -> Trace:
    """A patrol with the speeds and ends of the spec told, whatever the robot does."""
    times = np.arange(0.0, seconds, every)
    start = 0.1 * np.random.default_rng(1000 + seed).standard_normal()
    ran = run(patrol, "forward", [start, 0.5], times)
    scaled = {name: noise * sigma for name, sigma in NOISE.items()}
    return log(("x", "v"), ran, times, scaled, seed, MODES, **SPEC)


def with_mode(drive: Trace, name: str, times: Array, values: Array) -> Trace:
    """The same log with another series of the mode."""
    series = Series(name, times, values, f"/{name}", "sensor")
    return Trace(drive.source, drive.series | {name: series}, drive.constants, drive.start, (), ())


def ball_log(keep: float, floor: float, seconds: float, seed: int) -> Trace:
    """A ball that bounces off `floor` with the share `keep` of its speed, measured at 100 Hz."""
    fall = Leave(
        lambda s: floor - s[0] if s[1] < 0.0 else -1.0, "flight", lambda s: [s[0], -keep * s[1]]
    )
    robot = Robot({"flight": lambda _, s: [s[1], -9.81]}, {"flight": [fall]})
    times = np.arange(0.0, seconds, 0.01)
    height = 2.0 + 0.3 * np.random.default_rng(seed).random()
    ran = run(robot, "flight", [height, 0.0], times)
    drive = log(("x", "v"), ran, times, {"x": 0.005, "v": 0.03}, seed, ("mode", ("flight",)), e=0.9)
    return Trace(
        "ball.mcap", {n: drive.series[n] for n in ("x", "v")}, drive.constants, 0.0, (), ()
    )


def thermostat_log(seed: int, off: float = 22.0, k: float = 0.1) -> Trace:
    """Heating towards 40 at rate k until `off`, cooling towards 10 until 20, for 80 s at 20 Hz.

    The mode is logged five times a second.
    """
    robot = Robot(
        {"heat": lambda _, s: [k * (40.0 - s[0])], "cool": lambda _, s: [k * (10.0 - s[0])]},
        {
            "heat": [Leave(lambda s: s[0] - off, "cool")],
            "cool": [Leave(lambda s: 20.0 - s[0], "heat")],
        },
    )
    times = np.arange(0.0, 80.0, 0.05)
    start = 20.0 + 2.0 * np.random.default_rng(seed).random()
    ran = run(robot, "heat", [start], times)
    drive = log(("T",), ran, times, {"T": 0.05}, seed, ("mode", ("heat", "cool")), k=k)
    mode = drive.series["mode"]
    return with_mode(drive, "mode", mode.times[::4], mode.values[::4])
