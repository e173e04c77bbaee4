"""Fixed points of the refitted field, near those of the spec.

Newton's method from the spec's point, for the estimate and for draws of what the coefficients may
be, all at once. A point is *visited* when windows of the fit went past nearby:
elsewhere the correction is a guess.

Letters: B lanes (the estimate and the draws), m axes.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from verifier.report.features import Estimate
from verifier.robot_topology.corrected import corrected_rates, corrected_slopes
from verifier.robot_topology.intervals import normal
from verifier.robot_topology.refit import Refit
from verifier.robot_topology.scene import Scene, shortest
from verifier.topology.features import FixedPoint

STEPS: Final = 20
STRIDE: Final = 0.05
"""A step of Newton's method is at most so long, as a share of the domain."""
EXACT: Final = 1e-9
"""Steps below this share of the domain have arrived."""
REACH: Final = 0.15
"""How near a path comes to a point that it visits, as a share of what was visited."""
AWAY: Final = 0.5
"""Further from the spec's point, as a share of what was visited, it is another one."""
PASSES: Final = 3
"""Windows that a visited point needs."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RefitView:
    """A refit at the setting of the scene; draws (B, P): the estimate first."""

    scene: Scene
    refit: Refit
    draws: Array
    confidence: float


@final
@dataclass(frozen=True, eq=False, slots=True)
class RefittedPoint:
    """A fixed point of the refitted field.

    at: an estimate an axis; None where the estimate has no such point near the spec's. found,
    alike: shares of the draws that have one, and that have one of the same stability. passes: how
    many windows went past.
    """

    at: tuple[Estimate, ...] | None
    found: float
    alike: float
    passes: int

    @property
    def is_visited(self) -> bool:
        """Whether the trace tells enough of the place."""
        return self.passes >= PASSES


def refitted_point(view: RefitView, point: FixedPoint) -> RefittedPoint:
    """The robot's counterpart of a fixed point of the spec."""
    scene, refit, draws = view.scene, view.refit, view.draws
    lanes, arrived = _zeros(scene, refit, point.at, draws)
    off = shortest(lanes - point.at, scene.turns)
    extent = refit.field.basis.extent
    arrived &= np.sqrt(np.sum((off / extent) ** 2, axis=-1)) <= AWAY
    place = lanes[0] if arrived[0] else point.at
    alike = arrived & (_unstable(scene, refit, lanes, draws) == _unstable_of(point))
    at = None
    if arrived[0]:
        others = off[1:][arrived[1:]]
        error = np.std(others, axis=0) if len(others) > 1 else np.full(len(place), np.inf)
        at = tuple(
            normal(float(v), float(e), view.confidence) for v, e in zip(place, error, strict=True)
        )
    passes = passes_near(scene, refit, place)
    return RefittedPoint(at, float(np.mean(arrived)), float(np.mean(alike)), passes)


def passes_near(scene: Scene, refit: Refit, place: Array) -> int:
    """How many windows went past `place` (m,)."""
    off = shortest(refit.paths - place, scene.turns) / refit.field.basis.extent
    near = np.sum(off**2, axis=-1) <= REACH**2
    return int(np.sum(np.any(near, axis=-1)))


def state_at(scene: Scene, points: Array) -> Array:
    """Whole states (..., n) at points (..., m) of the axes, the rest as the setting has it."""
    given = dict(scene.setting.values)
    whole = [given.get(state.name, state.hold) for state in scene.program.states]
    found = np.broadcast_to(np.array(whole), (*points.shape[:-1], len(whole))).copy()
    found[..., list(scene.columns)] = points
    return found


def controls_at(scene: Scene) -> Array:
    """The controls (p,) of the setting."""
    given = dict(scene.setting.values)
    return np.array([given.get(c.name, c.default) for c in scene.program.controls], dtype=float)


def _zeros(scene: Scene, refit: Refit, start: Array, draws: Array) -> tuple[Array, Booleans]:
    """Zeros (B, m) of the lanes' fields, and whether each arrived."""
    columns = list(scene.columns)
    lanes = np.tile(start, (len(draws), 1)).astype(np.float64)
    arrived = np.zeros(len(draws), dtype=np.bool_)
    u = controls_at(scene)
    for _ in range(STEPS):
        x = state_at(scene, lanes)
        value = corrected_rates(refit.field, x, u, draws)[..., columns]
        slope = corrected_slopes(refit.field, x, u, draws)
        good = np.all(np.isfinite(value), axis=-1) & np.all(np.isfinite(slope), axis=(-2, -1))
        step = np.zeros_like(lanes)
        step[good] = -(np.linalg.pinv(slope[good]) @ value[good][..., None])[..., 0]
        size = np.max(np.abs(step) / scene.width, axis=-1)
        arrived = good & (size < EXACT)
        lanes = lanes + step * np.minimum(1.0, STRIDE / np.maximum(size, 1e-300))[:, None]
    return lanes, arrived


def _unstable(scene: Scene, refit: Refit, lanes: Array, draws: Array) -> Array:
    """How many eigenvalues of each lane are on the unstable side, -1 where it left the domain."""
    slope = corrected_slopes(refit.field, state_at(scene, lanes), controls_at(scene), draws)
    good = np.all(np.isfinite(slope), axis=(-2, -1))
    values = np.linalg.eigvals(np.nan_to_num(slope))
    return np.where(good, np.sum(values.real > 0.0, axis=-1), -1)


def _unstable_of(point: FixedPoint) -> int:
    return sum(value.real > 0.0 for value in point.eigenvalues)
