"""Specs and recordings for `specc fit`, made apart from the runtime."""

import csv
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

SPECS = Path(__file__).parents[2] / "specs"

FIDELITY = """fidelity:
  tolerance: {x: 0.015 m, v: 0.03 m/s}
  horizon: 1 s
"""
TOLD = """trace:
  x: x  # metres
  v: v
  going: going
  x1: {constant: 1.5}
  x2: {constant: -1.5}
  v1: {constant: 0.5}  # as commanded
  v2: {constant: 0.5}
"""


def patrol(folder: Path, *more: str) -> Path:
    """The library's patrol without its jumps of speed, and with a fidelity."""
    text = (SPECS / "patrol.yaml").read_text(encoding="utf-8")
    text = re.sub(r", reset: {.*?}", "", text)
    text = text[: text.index("expect:")]
    path = folder / "patrol.yaml"
    path.write_text(text + FIDELITY + "".join(more), encoding="utf-8")
    return path


def patrolled(
    path: Path,
    forward: float,
    seconds: float = 60.0,
    seed: int = 1,
    *,
    far: float = 1.5,
    bounces: bool = False,
) -> Path:
    """A log of a robot that settles at `forward` m/s ahead and at 0.5 back: noisy, 20 Hz.

    It turns at `far`, 1.5 by the spec. Where it bounces, its speed turns round there at once.

    Exact over steps of 1 ms: with e = exp(-2 dt), v becomes w + (v - w) e and x grows by
    w dt + (v - w) (1 - e) / 2, where w is the speed that it settles at.
    """
    rng = np.random.default_rng(seed)
    keep, x, v, ahead, rows = math.exp(-0.002), 0.0, 0.0, True, []
    for i in range(int(seconds * 1000)):
        if i % 50 == 0:
            rows.append((i / 1000, x, v, "forward" if ahead else "back"))
        wanted = forward if ahead else -0.5
        x += 0.001 * wanted + (v - wanted) * (1.0 - keep) / 2.0
        v = wanted + (v - wanted) * keep
        goes = x < far if ahead else x <= -1.5
        v = -v if bounces and goes != ahead else v
        ahead = goes
    times, xs, vs, going = (np.array(column) for column in zip(*rows, strict=True))
    xs = xs + 0.005 * rng.normal(size=xs.shape)
    vs = vs + 0.01 * rng.normal(size=vs.shape)
    return written(path, {"t": times, "x": xs, "v": vs, "going": going})


MOVER = """specc: 1
kind: behavior
name: mover
state:
  x: {unit: m, domain: [-5, 5], role: both, relates: {agent: base, environment: room}}
control:
  goal: {unit: m, domain: [-4, 4], default: 0}
constants:
  pull: {value: 1.5, unit: 1/s, about: how fast it goes there}
field:
  formula: {x: pull * (goal - x)}
fidelity:
  tolerance: {x: 0.05 m}
  horizon: 2 s
trace:
  x: x
  goal: goal
"""


def late_mover(path: Path, late: float, seconds: float = 60.0) -> Path:
    """A log at 20 Hz of a robot that goes to goals; its place is told `late` seconds late.

    Exact between goals: the distance to one shrinks by exp(-1.5 dt).
    """
    rng = np.random.default_rng(5)
    goals = np.repeat(rng.uniform(-2.0, 2.0, int(seconds)), 20)
    xs, keep = [0.0], math.exp(-1.5 * 0.05)
    for goal in goals[:-1]:
        xs.append(goal + (xs[-1] - goal) * keep)
    back = round(late * 20.0)
    x = np.array(xs)[: len(xs) - back] + 0.01 * rng.normal(size=len(xs) - back)
    times = np.arange(len(goals)) / 20.0
    return written(path, {"t": times[back:], "x": x, "goal": goals[back:]})


DRAWN = """specc: 1
kind: behavior
name: whirl
state:
  x: {{unit: m, domain: [-1, 1], role: both, relates: {{agent: base, environment: room}}}}
  y: {{unit: m, domain: [-1, 1], role: both, relates: {{agent: base, environment: room}}}}
field:
  {field}
fidelity:
  tolerance: {{x: 0.02 m, y: 0.02 m}}
  horizon: 1 s
"""

Rate = Callable[[float, float], tuple[float, float]]


def whirl(x: float, y: float) -> tuple[float, float]:
    """Round a circle of 0.6 m."""
    inward = 0.36 - x * x - y * y
    return 0.5 * (inward * x - y), 0.5 * (inward * y + x)


def other_whirl(x: float, y: float) -> tuple[float, float]:
    """What the robot does instead."""
    there = whirl(x, y)
    return there[0] + 0.06 * x * y + 0.03, there[1] + 0.08 * x


def drawn(folder: Path, form: str) -> Path:
    """`whirl` as arrows or as a grid, on 5 x 5 places."""
    places = np.linspace(-1.0, 1.0, 5)
    if form == "arrows":
        lines = ["arrows:", "    over: [x, y]", "    sketch:"]
        for x in places:
            for y in places:
                go = whirl(x, y)
                lines.append(f"      - {{at: [{x:g}, {y:g}], go: [{go[0]:.4f}, {go[1]:.4f}]}}  # a")
    else:
        lines = ["grid:", "    over: [x, y]", "    values:"]
        for i, name in enumerate("xy"):
            rows = [", ".join(f"{whirl(x, y)[i]:.4f}" for y in places) for x in places]
            lines.append(f"      {name}: [{', '.join(f'[{row}]' for row in rows)}]")
    path = folder / "whirl.yaml"
    path.write_text(DRAWN.format(field="\n".join(lines)), encoding="utf-8")
    return path


def whirled(path: Path, rate: Rate, seconds: float = 30.0) -> Path:
    """A log of a robot with these rates, integrated in steps of 1 ms, noisy, 20 Hz."""
    rng = np.random.default_rng(3)
    x, y, rows = 0.9, 0.1, []
    for i in range(int(seconds * 1000)):
        if i % 50 == 0:
            rows.append((i / 1000, x, y))
        there = rate(x + 0.0005 * rate(x, y)[0], y + 0.0005 * rate(x, y)[1])
        x, y = x + 0.001 * there[0], y + 0.001 * there[1]
    found = np.array(rows)
    found[:, 1:] += 0.003 * rng.normal(size=(len(rows), 2))
    return written(path, {"t": found[:, 0], "x": found[:, 1], "y": found[:, 2]})


def written(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A CSV file."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))
    return path
