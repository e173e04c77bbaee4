"""The attracting cycle of the refitted field, near one of the spec.

The refitted field and draws of it run from the spec's cycle until they have settled, and are timed
where they come back to a section across it (a plane at right angles to the flow).

Letters: B lanes (the estimate and the draws), m axes, T instants.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.report.features import Estimate
from verifier.robot_topology.corrected import step
from verifier.robot_topology.intervals import normal
from verifier.robot_topology.laps import on_cycle
from verifier.robot_topology.refit import Refit
from verifier.robot_topology.refitted_points import (
    PASSES,
    RefitView,
    controls_at,
    passes_near,
    state_at,
)
from verifier.robot_topology.scene import Scene, shortest
from verifier.robot_topology.swings import swing
from verifier.topology.features import Cycle

STEPS: Final = 100
"""In a period of the spec's cycle."""
SETTLED: Final = 0.02
"""Of the first deviation, that is left when a lap is timed."""
MOST_LAPS: Final = 6
LONGER: Final = 1.5
"""How much longer than the spec's a lap may take."""
PLACES: Final = 24
"""On the cycle, at which it is asked whether the trace came by."""
MOSTLY: Final = 0.9
FEWEST: Final = 0.9
"""Lanes that must come back."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RefittedCycle:
    """Period (s), lowest, highest and amplitude an axis, and the loop (T, m)."""

    period: Estimate
    lowest: tuple[Estimate, ...]
    highest: tuple[Estimate, ...]
    amplitude: tuple[Estimate, ...]
    loop: Array


def refitted_cycle(view: RefitView, cycle: Cycle) -> RefittedCycle | None:
    """The robot's counterpart of a stable cycle; None where the trace or the field has none."""
    scene, refit, confidence = view.scene, view.refit, view.confidence
    if not cycle.is_attracting or not _is_visited(scene, refit, cycle):
        return None
    origin = _quickest(scene, cycle)
    paths, times = _run(scene, refit, cycle, origin, view.draws)
    found = [_last_lap(scene, cycle, path, times, origin) for path in paths]
    laps = [lap for lap in found if lap is not None]
    if found[0] is None or len(laps) < FEWEST * len(found):
        return None
    swings = np.array([swing(loop) for _, loop in laps])
    periods = np.array([period for period, _ in laps])

    def estimates(which: int) -> tuple[Estimate, ...]:
        error = np.std(swings[1:, which], axis=0)
        return tuple(
            normal(float(v), float(e), confidence)
            for v, e in zip(swings[0, which], error, strict=True)
        )

    return RefittedCycle(
        period=normal(float(periods[0]), float(np.std(periods[1:])), confidence),
        lowest=estimates(0),
        highest=estimates(1),
        amplitude=estimates(2),
        loop=laps[0][1],
    )


def _is_visited(scene: Scene, refit: Refit, cycle: Cycle) -> bool:
    places = on_cycle(cycle, np.arange(PLACES) / PLACES)
    seen = [passes_near(scene, refit, place) >= PASSES for place in places]
    return float(np.mean(seen)) >= MOSTLY


def _quickest(scene: Scene, cycle: Cycle) -> float:
    """The phase at which the cycle is quickest, each axis in its own size."""
    phases = np.arange(STEPS) / STEPS
    points = on_cycle(cycle, phases)
    speed = shortest(np.roll(points, -1, axis=0) - points, scene.turns) / np.ptp(points, axis=0)
    return float(phases[np.argmax(np.sum(speed**2, axis=-1))])


def _run(
    scene: Scene, refit: Refit, cycle: Cycle, origin: float, draws: Array
) -> tuple[Array, Array]:
    """Paths (B, T, m) at times (T,)."""
    largest = max((abs(value) for value in cycle.multipliers), default=0.0)
    settling = np.log(SETTLED) / np.log(largest) if 0.0 < largest < 1.0 else 0.0
    laps = 2 + min(MOST_LAPS, int(np.ceil(settling)))
    seconds = cycle.period / STEPS
    count = int(LONGER * laps * STEPS)
    x = state_at(scene, np.tile(on_cycle(cycle, np.array(origin)), (len(draws), 1)))
    u = controls_at(scene)
    found = np.empty((count + 1, len(draws), len(scene.columns)))
    found[0] = x[:, list(scene.columns)]
    for k in range(count):
        x = step(refit.field, x, u, np.array(seconds), draws)
        found[k + 1] = x[:, list(scene.columns)]
    times: Array = seconds * np.arange(count + 1, dtype=np.float64)
    return np.swapaxes(found, 0, 1), times


def _last_lap(
    scene: Scene, cycle: Cycle, path: Array, times: Array, origin: float
) -> tuple[float, Array] | None:
    """Period and points of the last whole lap of a lane, None where it does not come back."""
    place, ahead = on_cycle(cycle, np.array([origin, origin + 0.5 / STEPS]))
    size = np.ptp(cycle.points, axis=0)
    off = shortest(path - place, scene.turns) / size
    side = off @ (shortest(ahead - place, scene.turns) / size)
    near = np.sum(off**2, axis=-1) < 0.25
    back = np.flatnonzero((side[:-1] < 0.0) & (side[1:] >= 0.0) & near[:-1])
    if len(back) < 2 or not np.all(np.isfinite(path[: back[-1] + 2])):
        return None
    part = -side[back] / (side[back + 1] - side[back])
    passed = times[back] + part * (times[back + 1] - times[back])
    return float(passed[-1] - passed[-2]), path[back[-2] : back[-1] + 2]
