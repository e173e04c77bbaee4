"""Robots made by scipy from their own formulas, and the programs that they are judged against."""

import sys
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from runtime.code import Code
from runtime.program import (
    Binding,
    Control,
    Fidelity,
    Field,
    Kind,
    Origin,
    Program,
    Role,
    State,
    Unit,
)
from verifier.traces.trace import Series, Trace

ONE = Unit("1", 1.0)
METRE = Unit("m", 1.0)


def state(name: str, low: float, high: float, **changes: object) -> State:
    plain = State(
        name, ONE, low, high, Role.BOTH, Kind.CONTINUOUS, 0.0, None, (), ("robot", "world"), "", ""
    )
    return replace(plain, **changes)


def control(name: str, low: float, high: float, default: float) -> Control:
    return Control(name, ONE, low, high, default, "", "")


def binding(name: str) -> Binding:
    return Binding(name, f"/{name}.data", ONE, 0.0, 1.0, 0.0, None, (), "")


def program(
    states: tuple[State, ...],
    controls: tuple[Control, ...],
    formula: dict[str, str],
    fidelity: Fidelity | None,
    **changes: object,
) -> Program:
    codes = tuple(Code(text) for text in formula.values())
    field = Field(tuple(formula), "formula", 0.0, (), (), (), codes, "spec.yaml:1:1")
    names = [part.name for part in (*states, *controls)]
    plain = Program(
        name="scene",
        about="",
        states=states,
        controls=controls,
        constants=(),
        outputs=(),
        field=field,
        fidelity=fidelity,
        bindings=tuple(binding(name) for name in names),
        judge_when=None,
        realizes=(),
        feasibility=None,
        source=Origin("scene.yaml", "", "0" * 64),
    )
    return replace(plain, **changes)


def fidelity(tolerance: dict[str, float], horizon: float, **changes: object) -> Fidelity:
    return replace(Fidelity(tolerance, horizon, {}, 0.0, "scene.yaml:9:1"), **changes)


def series(name: str, times: Array, values: Array) -> Series:
    return Series(name, np.asarray(times, float), np.asarray(values, float), f"/{name}", "sensor")


def trace(*parts: Series, **constants: float) -> Trace:
    return Trace("drive.mcap", {part.name: part for part in parts}, constants, 0.0, (), ())


def integrated(
    rate: Callable[[float, Array], list[float]], start: list[float], times: Array, step: float
) -> Array:
    """States (T, n) by DOP853, which never steps over a change of input."""
    found = solve_ivp(
        rate,
        (times[0], times[-1]),
        start,
        method="DOP853",
        t_eval=times,
        rtol=1e-9,
        atol=1e-10,
        max_step=step,
    )
    assert found.success
    return found.y.T


def van_der_pol(mu: str = "1", **changes: object) -> Program:
    judged = fidelity({"x": 0.05, "v": 0.1}, 2.0, region={"x": (-2.1, 2.1)}, coverage=0.6)
    return program(
        (state("x", -3.0, 3.0), state("v", -4.0, 4.0)),
        (),
        {"x": "v", "v": f"{mu} 1 x 2 pow sub mul v mul x sub"},
        judged,
        **changes,
    )


def van_der_pol_drive(seed: int, seconds: float, noise: float, mu: float = 1.0) -> Trace:
    """An oscillator as measured at 20 Hz with white noise on both states."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, seconds, 0.05)
    x = integrated(
        lambda _, s: [s[1], mu * (1.0 - s[0] ** 2) * s[1] - s[0]],
        [rng.uniform(-1.5, 1.5), rng.uniform(-1.0, 1.0)],
        times,
        0.1,
    )
    x = x + noise * rng.standard_normal(x.shape)
    return trace(series("x", times, x[:, 0]), series("v", times, x[:, 1]))


UNICYCLE = {"x": "speed heading cos mul", "y": "speed heading sin mul", "heading": "scale turn mul"}


def unicycle(scale: float = 1.0, **changes: object) -> Program:
    """A base that drives: angle, controls, and a scale on its turn rate."""
    formula = UNICYCLE | {"heading": f"{scale} turn mul"}
    judged = fidelity({"x": 0.1, "y": 0.1, "heading": 0.02}, 5.0)
    return program(
        (
            state("x", -200.0, 200.0, unit=METRE),
            state("y", -200.0, 200.0, unit=METRE),
            state("heading", -np.pi, np.pi, kind=Kind.PERIODIC),
        ),
        (control("speed", -1.0, 2.0, 0.0), control("turn", -2.0, 2.0, 0.0)),
        formula,
        judged,
        **changes,
    )


def unicycle_drive(seed: int, seconds: float, noise: float, late: float = 0.0) -> Trace:
    """A drive under commands that change every 0.7 s; `turn` is logged `late`.

    Under constant commands a base drives an arc: x grows by v / w (sin(h + w t) - sin h).
    """
    rng = np.random.default_rng(seed)
    switch = np.arange(0.0, seconds, 0.7)
    speed, turn = rng.uniform(0.2, 1.0, len(switch)), rng.uniform(-0.6, 0.8, len(switch))
    times = np.arange(0.0, seconds, 0.1)
    knots = np.union1d(times, switch)
    now = np.searchsorted(switch, knots[:-1], side="right") - 1
    v, w = speed[now], turn[now]
    h = 1.0 + np.concatenate([[0.0], np.cumsum(w * np.diff(knots))])
    x = np.concatenate([[0.0], np.cumsum(v / w * np.diff(np.sin(h)))])
    y = np.concatenate([[0.0], np.cumsum(-v / w * np.diff(np.cos(h)))])
    s = np.stack([x, y, h], axis=-1)[np.searchsorted(knots, times)]
    measured = s + noise * rng.standard_normal((len(s), 3))
    parts = [series(n, times, measured[:, i]) for i, n in enumerate(("x", "y", "heading"))]
    return trace(*parts, series("speed", switch, speed), series("turn", switch + late, turn))


@pytest.fixture
def scenes() -> ModuleType:
    """The functions above: tests hold no package that could be imported."""
    return sys.modules[__name__]
