"""Traps by Poincaré and Bendixson: what one turn of a path round a fixed point encloses.

e: differences from the fixed point as shares of the axes' widths, in a plane.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from verifier.topology.features import FixedPoint
from verifier.topology.paths.motion import moved
from verifier.topology.slices import Slice, rates_at, shortest

RADII: Final = 0.75 ** np.arange(16.0)
"""Where on a ray to the border paths begin, as shares of the way."""

TURNS: Final = 4.0
"""For how many turns of the linearisation a path may take for one of its own."""

SAMPLES: Final = 480
"""Points of a path; those of one turn are connected by straight lines, so"""

MARGIN: Final = 0.99
"""only this share of the radius is taken as enclosed."""

INWARD: Final = 1e-3
"""A turn ends closer to the fixed point by at least this share of the radius, well above what the
interpolation between samples gets wrong."""

TOLERANCE: Final = 1e-9


@final
@dataclass(frozen=True, eq=False, slots=True)
class Spiral:
    """The region that one turn round the fixed point `index` at `at` encloses.

    Its border is a path, which nothing crosses, and a piece of a ray, which everything crosses
    inward; it holds no other fixed point and no known cycle, so all that is in it goes to the
    fixed point (Poincaré and Bendixson; Strogatz 2015, section 7.3). angles: (k,) rising from 0
    to 2 pi along the turn of `sense` (1 or -1) from the angle `first`; radii: (k,).
    """

    index: int
    at: Array
    sense: float
    first: float
    angles: Array
    radii: Array

    def holds(self, view: Slice, points: Array) -> Booleans:
        """Which of `points` (..., 2) lie in it."""
        e = shortest(view, points - self.at) / view.width
        angle = np.mod(self.sense * (np.arctan2(e[..., 1], e[..., 0]) - self.first), 2.0 * np.pi)
        border = np.interp(angle, self.angles, self.radii)
        return np.asarray(np.hypot(e[..., 0], e[..., 1]) <= MARGIN * border)


def spiral_round(
    view: Slice, index: int, point: FixedPoint, others: Array, sign: int
) -> Spiral | None:
    """The largest such region of a planar flow without `others` (k, 2); None where none is seen."""
    turning = max((abs(value.imag) for value in point.eigenvalues), default=0.0)
    if view.is_map or len(view.axes) != 2 or turning == 0.0:
        return None
    times = np.linspace(0.0, sign * TURNS * 2.0 * np.pi / turning, SAMPLES)
    paths = moved(view, _starts(view, point.at), times, TOLERANCE)
    turns = [_turn(view, index, point.at, path) for path in paths]
    good = [t for t in turns if t is not None and _is_trap(view, t, others, sign)]
    return max(good, key=_area, default=None)


def _starts(view: Slice, at: Array) -> Array:
    """Points (k, 2) on the four rays along the axes, within the domain."""
    starts = []
    for direction in np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]):
        j = int(np.argmax(np.abs(direction)))
        border = view.low[j] + (view.width[j] if direction[j] > 0.0 else 0.0)
        room = 0.5 if view.periodic[j] else abs(border - at[j]) / view.width[j]
        starts.append(at + 0.98 * room * RADII[:, None] * direction * view.width)
    return np.concatenate(starts)


def _turn(view: Slice, index: int, at: Array, path: Array) -> Spiral | None:
    """The first turn of `path` (T, 2) if it goes round without turning back, and ends closer."""
    e = (path[np.all(np.isfinite(path), axis=-1)] - at) / view.width
    angle = np.unwrap(np.arctan2(e[:, 1], e[:, 0]))
    sense = float(np.sign(angle[-1] - angle[0]))
    gone = sense * (angle - angle[0])
    round_it = np.flatnonzero(gone >= 2.0 * np.pi)
    if not round_it.size or np.any(np.diff(gone[: round_it[0] + 1]) <= 0.0):
        return None
    count = int(round_it[0]) + 1
    radii = np.hypot(e[:count, 0], e[:count, 1])
    radii[-1] = _radius_after_one_turn(gone, np.hypot(e[:, 0], e[:, 1]), count - 1)
    angles = np.append(gone[: count - 1], 2.0 * np.pi)
    if not radii[-1] < (1.0 - INWARD) * radii[0]:
        return None
    return Spiral(index, at, sense, float(angle[0]), frozen(angles), frozen(radii))


def _radius_after_one_turn(gone: Array, radii: Array, k: int) -> float:
    """The radius at 2 pi, which lies between the samples k - 1 and k: a cubic through four."""
    near = slice(max(k - 2, 0), k + 2)
    x, y = gone[near] - 2.0 * np.pi, radii[near]
    weights = [np.prod(np.delete(x, i) / (np.delete(x, i) - x[i])) for i in range(len(x))]
    return float(np.dot(weights, y))


def _is_trap(view: Slice, spiral: Spiral, others: Array, sign: int) -> bool:
    """Whether nothing else lies in the region, and the ray's piece is crossed one way."""
    e = spiral.radii[:, None] * _unit(spiral.first + spiral.sense * spiral.angles)
    if np.any(np.abs(e[:, view.periodic]) >= 0.5):
        return False
    apart = np.linalg.norm(shortest(view, others - spiral.at) / view.width, axis=-1)
    if np.any(spiral.holds(view, others[apart > 1e-9])):
        return False
    ray = _unit(np.array([spiral.first]))[0]
    radii = np.linspace(spiral.radii[-1], spiral.radii[0], 9)
    rates = sign * rates_at(view, spiral.at + radii[:, None] * ray * view.width) / view.width
    across = spiral.sense * (ray[0] * rates[:, 1] - ray[1] * rates[:, 0])
    return bool(np.all(across > 0.0))


def _unit(angles: Array) -> Array:
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def _area(spiral: Spiral) -> float:
    return float(np.trapezoid(spiral.radii**2, spiral.angles))
