"""A joint of an arm under a controller, with a trace of one that is made by small Euler steps."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import numpy as np

import specc
from runtime.arrays import Array
from runtime.program import Program
from verifier.traces.trace import Series, Trace

SPEC = """
specc: 1
kind: behavior
name: joint
about: A joint under a controller.
state:
  q:
    unit: rad
    domain: [-2, 2]
    role: both
    relates: {agent: the forearm, environment: the horizontal}
  w:
    unit: rad/s
    domain: [-8, 8]
    role: both
    relates: {agent: the forearm, environment: the horizontal}
control:
  target: {unit: rad, domain: [-1.5, 1.5], default: 0}
constants:
  kp: {value: 16, unit: 1/s^2, about: stiffness over inertia}
  kd: {value: 4, unit: 1/s, about: damping over inertia}
  sag: {value: 2, unit: 1/s^2, about: gravity torque over inertia when horizontal}
field:
  formula:
    q: w
    w: kp*(target - q) - kd*w - sag*cos(q)
fidelity:
  tolerance: {q: 0.03 rad, w: 0.1 rad/s}
  horizon: 1 s
"""
FINE = 0.001
EVERY = 50
"""Fine steps from sample to sample."""

Held: TypeAlias = Callable[[float], float]
"""What becomes of the speed after each step."""


def program(folder: Path) -> Program:
    """The spec of the joint."""
    path = folder / "joint.yaml"
    path.write_text(SPEC, encoding="utf-8")
    return specc.load_program(path)


def jumps(rng: np.random.Generator, count: int, grid: int) -> Array:
    """Set-points (count,) that change every 2 to 4 s, at multiples of `grid` fine steps."""
    found = np.zeros(count)
    at = 0
    while at < count:
        following = at + int(rng.integers(2000, 4000)) // grid * grid
        found[at:following] = rng.uniform(-1.2, 1.2)
        at = following
    return found


def joint(
    seed: int,
    *,
    seconds: float = 40.0,
    grid: int = EVERY,
    held: Held = float,
    late: int = 0,
    damping: float = 4.0,
) -> Trace:
    """Sampled at 20 Hz; noise of 3 mrad and 12 mrad/s.

    grid: set-points jump at multiples of so many fine steps. late: q is so many fine steps late,
    and tells its first value until then. damping: 4 in the spec.
    """
    rng = np.random.default_rng(seed)
    count = int(seconds / FINE)
    target = jumps(rng, count, grid)
    states = np.zeros((count, 2))
    for i in range(1, count):
        q, w = states[i - 1]
        rate = 16.0 * (target[i - 1] - q) - damping * w - 2.0 * np.cos(q)
        speed = held(float(w + FINE * rate))
        states[i] = q + FINE * speed, speed
    angle = np.concatenate([np.full(late, states[0, 0]), states[: count - late, 0]])
    times = FINE * np.arange(0, count, EVERY)
    noise = rng.standard_normal((len(times), 2)) * [0.003, 0.012]
    measured = np.stack([angle, states[:, 1]], axis=1)[::EVERY] + noise
    parts = (
        Series("q", times, measured[:, 0], "q", "log"),
        Series("w", times, measured[:, 1], "w", "log"),
        Series("target", times, target[::EVERY], "target", "log"),
    )
    return Trace("joint.csv", {part.name: part for part in parts}, {}, 0.0, (), ())
