"""Robots whose attractors, saddles and cycles are known, and what their specs say."""

import sys
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from runtime.arrays import Array
from runtime.flow import flow_of
from runtime.program import Fidelity, Program
from tests.verifier.topology_scenes import behavior, control, state
from verifier.fidelity.shooting.study import Study, study_of
from verifier.fidelity.stretches.needs import needs_of
from verifier.fidelity.stretches.segments import segments_of
from verifier.report.features import ComparedFeature, FeatureNumber, Features
from verifier.robot_topology.compare import compare_features
from verifier.traces.trace import Series, Trace


def judged_by(program: Program, tolerance: dict[str, float], horizon: float) -> Program:
    return replace(program, fidelity=Fidelity(tolerance, horizon, {}, 0.0, ""))


def oscillator(tolerance: tuple[float, float] = (0.05, 0.1)) -> Program:
    """Van der Pol with mu = 1."""
    plain = behavior(
        "oscillator",
        (state("x", -3.0, 3.0), state("v", -4.0, 4.0)),
        ("v", "1 x 2 pow sub v mul x sub"),
    )
    return judged_by(plain, {"x": tolerance[0], "v": tolerance[1]}, 2.0)


def van_der_pol(mu: float) -> Callable[[float, Array], list[float]]:
    return lambda _, s: [s[1], mu * (1.0 - s[0] ** 2) * s[1] - s[0]]


def cycle_of(mu: float) -> tuple[float, float, float]:
    """Period and amplitudes of x and v: by an integration of its own, to 1e-7."""
    rising = lambda _, s: s[0]  # noqa: E731  an event of solve_ivp
    rising.direction = 1.0  # type: ignore[attr-defined]
    found = solve_ivp(
        van_der_pol(mu),
        (0.0, 80.0),
        [2.0, 0.0],
        method="DOP853",
        rtol=1e-10,
        atol=1e-11,
        events=rising,
        dense_output=True,
    )
    assert found.t_events is not None
    assert found.sol is not None
    first, last = found.t_events[0][-2:]
    lap = found.sol(np.linspace(first, last, 20_001))
    return float(last - first), float(np.abs(lap[0]).max()), float(np.abs(lap[1]).max())


def wells(left: float = -1.0, middle: float = 0.0, right: float = 1.0) -> Program:
    """Two nodes and a saddle on the x axis: x' = -(x - left)(x - middle)(x - right), y' = -y."""
    plain = behavior(
        "wells",
        (state("x", -2.0, 2.0), state("y", -2.0, 2.0)),
        (f"x {left!r} sub x {middle!r} sub mul x {right!r} sub mul neg", "y neg"),
    )
    return judged_by(plain, {"x": 0.05, "y": 0.05}, 1.0)


def in_wells(left: float, middle: float, right: float) -> Callable[[float, Array], list[float]]:
    return lambda _, s: [-(s[0] - left) * (s[0] - middle) * (s[0] - right), -s[1]]


def swinging() -> Program:
    """A pendulum with friction, its angle periodic."""
    plain = behavior(
        "swinging",
        (state("angle", -np.pi, np.pi), state("rate", -8.0, 8.0)),
        ("rate", "angle sin -9 mul rate -0.6 mul add"),
    )
    angle = replace(plain.states[0], kind=type(plain.states[0].kind).PERIODIC)
    return judged_by(
        replace(plain, states=(angle, plain.states[1])), {"angle": 0.05, "rate": 0.15}, 1.0
    )


def driven(
    rate: Callable[[float, Array], list[float]], starts: list[list[float]], seconds: float
) -> tuple[Array, Array]:
    """Runs from each start, 2 s apart, sampled at 20 Hz: times (T,) and states (T, n)."""
    each = np.arange(0.0, seconds, 0.05)
    times, states = [], []
    for i, start in enumerate(starts):
        found = solve_ivp(rate, (0.0, seconds), start, t_eval=each, rtol=1e-8, atol=1e-9)
        times.append(each + i * (seconds + 2.0))
        states.append(found.y.T)
    return np.concatenate(times), np.concatenate(states)


def measured(
    program: Program, times: Array, states: Array, noise: float, seed: int, **constants: float
) -> Trace:
    rng = np.random.default_rng(seed)
    noisy = states + noise * rng.standard_normal(states.shape)
    series = {
        s.name: Series(s.name, times, noisy[:, i], f"/{s.name}", "sensor")
        for i, s in enumerate(program.states)
        if i < noisy.shape[1]
    }
    return Trace("drive.mcap", series, constants, 0.0, (), ())


def study(program: Program, trace: Trace) -> Study | None:
    needs = needs_of(program, trace)
    assert program.fidelity is not None
    segments = segments_of(program, needs, program.fidelity.horizon)
    if not len(segments.spans):
        return None
    found = study_of(flow_of(program), program.fidelity, needs, segments, np.random.default_rng(0))
    return None if isinstance(found, str) else found


def compared(program: Program, trace: Trace) -> Features:
    return compare_features(program, trace, study(program, trace))


def number(feature: ComparedFeature, name: str) -> FeatureNumber:
    return next(each for each in feature.numbers if each.name == name)


def near(features: Features, **place: float) -> ComparedFeature:
    """The feature of the spec at a place."""
    return min(
        (f for f in features.features if f.in_spec and not f.is_cycle),
        key=lambda f: sum(abs(number(f, name).spec - at) for name, at in place.items()),
    )


def cycle(features: Features) -> ComparedFeature:
    return next(f for f in features.features if f.is_cycle)


__all__ = ["behavior", "control", "state"]


@pytest.fixture(scope="session")
def scenes() -> ModuleType:
    """The functions above: tests hold no package that could be imported."""
    return sys.modules[__name__]
