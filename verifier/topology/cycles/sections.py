"""Return maps of a planar flow on rays from a point, and on lines across a periodic axis.

L: lanes. z: points relative to a section's origin, in widths of the axes; a section is the line
z = s e (s > 0 on a ray), n its normal.  (Strogatz 2015, section 8.7.)
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.topology.paths.motion import LASTING, moved, travelled
from verifier.topology.slices import Slice, rates_at

SAMPLES: Final = 256
"""Times at which a path is looked at between two looks at which paths still go on."""

LONGEST: Final = 10.0
"""In widths: what comes back to a section does so within this length."""

CLOSER: Final = 16
"""Parts of the interval in which a return was seen, before it is interpolated."""

TOLERANCE: Final = 1e-9
"""Of the integration; returns are known to about ten times this share of the widths."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Section:
    """A ray from `origin` in direction e, or a line across periodic axis `around` (else -1)."""

    origin: Array
    along: Array
    around: int

    @property
    def normal(self) -> Array:
        """The unit vector across, (2,)."""
        return np.array([-self.along[1], self.along[0]])


@final
@dataclass(frozen=True, eq=False, slots=True)
class Lanes:
    """Starts on sections: which section (L,), and how far along it s (L,)."""

    sections: tuple[Section, ...]
    which: Integers
    s: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Returns:
    """Where each start comes back to its section, r (L,), NaN where it does not, and when.

    sides: (L,) the direction, 1 or -1, in which the section is crossed; 0 where it is touched.
    times: (L,), negative when followed backwards.
    """

    r: Array
    times: Array
    sides: Array


def points_of(view: Slice, lanes: Lanes) -> Array:
    """The starts as points (L, 2)."""
    origin = np.array([section.origin for section in lanes.sections])[lanes.which]
    along = np.array([section.along for section in lanes.sections])[lanes.which]
    return np.asarray(origin + lanes.s[:, None] * along * view.width)


def first_returns(view: Slice, lanes: Lanes, step: float) -> Returns:
    """The first return of each start in the same direction across; `step`: a pace, signed."""
    frame = _Frame.of(view, lanes)
    starts = points_of(view, lanes)
    speed = np.sum(rates_at(view, starts) / view.width * frame.normal, axis=-1) * np.sign(step)
    sides = np.nan_to_num(np.sign(speed))
    r, times = np.full(len(starts), np.nan), np.full(len(starts), np.nan)
    going = np.flatnonzero(sides)
    here, passed, length = starts[going], 0.0, np.zeros(going.size)
    for chunk in LASTING:
        clock = np.linspace(0.0, chunk * step, SAMPLES + 1)
        path = moved(view, here, clock, TOLERANCE)
        level = frame.taken(going).levels(path, sides[going])
        if passed == 0.0:
            level[:, 0] = np.where(frame.running[going], level[:, 0], 0.0)
        hit, index = _first_hit(level)
        back = np.flatnonzero(hit)
        r[going[back]], when = _located(
            view, frame.taken(going[back]), sides[going[back]], path[back, index[back]], clock[1]
        )
        times[going[back]] = passed + clock[index[back]] + when
        done = travelled(view, path, chunk)
        length += done
        rest = ~hit & (done > 0.0) & (length < LONGEST)
        going, here, length = going[rest], path[rest, -1], length[rest]
        passed += clock[-1]
        if not going.size:
            break
    return Returns(r, times, sides)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Frame:
    """Sections, one per lane: origin, along, normal (L, 2), running (L,), widths (2,)."""

    origin: Array
    along: Array
    normal: Array
    running: Booleans
    width: Array

    @classmethod
    def of(cls, view: Slice, lanes: Lanes) -> "_Frame":
        """The frames of lanes."""
        return cls(
            np.array([section.origin for section in lanes.sections])[lanes.which],
            np.array([section.along for section in lanes.sections])[lanes.which],
            np.array([section.normal for section in lanes.sections])[lanes.which],
            np.array([section.around >= 0 for section in lanes.sections])[lanes.which],
            view.width,
        )

    def taken(self, index: Integers) -> "_Frame":
        """Some of the lanes."""
        return replace(
            self,
            origin=self.origin[index],
            along=self.along[index],
            normal=self.normal[index],
            running=self.running[index],
        )

    def levels(self, points: Array, sides: Array) -> Array:
        """What (L, T) rises through zero at a return; NaN where a ray's other half is met."""
        z = (points - self.origin[:, None]) / self.width
        across = sides[:, None] * np.einsum("lti,li->lt", z, self.normal)
        ahead = np.einsum("lti,li->lt", z, self.along) > 0.0
        on_ray = np.where(ahead, across, np.where(across < 0.0, across, np.nan))
        return np.where(self.running[:, None], across - 1.0, on_ray)

    def place(self, points: Array) -> Array:
        """How far along (L,) its section each of `points` (L, 2) is."""
        z = (points - self.origin) / self.width
        return np.asarray(np.sum(z * self.along, axis=-1))


def _first_hit(level: Array) -> tuple[Booleans, Integers]:
    """Whether (L,) a level (L, T) rises through zero, and the sample before that."""
    with np.errstate(invalid="ignore"):
        rises = (level[:, :-1] < 0.0) & (level[:, 1:] >= 0.0)
    return np.asarray(rises.any(axis=1)), np.asarray(rises.argmax(axis=1))


def _located(
    view: Slice, frame: _Frame, sides: Array, before: Array, step: float
) -> tuple[Array, Array]:
    """Where on its section and when after `before` (L, 2), within `step`, each return is."""
    clock = np.linspace(0.0, step, CLOSER + 1)
    path = moved(view, before, clock, TOLERANCE)
    hit, index = _first_hit(frame.levels(path, sides))
    lane = np.arange(len(path))
    a, b = path[lane, index], path[lane, index + 1]
    h = clock[1]
    slopes = h * rates_at(view, np.stack([a, b])) if len(path) else np.zeros((2, 0, 2))
    ends = frame.levels(np.stack([a, b], axis=1), sides)
    theta = _finite(ends[:, 0], ends[:, 0] - ends[:, 1])
    for _ in range(6):
        point, slope = _hermite(a, b, slopes, theta)
        gap = frame.levels(point[:, None], sides)[:, 0]
        rise = sides * np.sum(slope / view.width * frame.normal, axis=-1)
        theta = np.clip(theta - _finite(gap, rise), 0.0, 1.0)
    point, _ = _hermite(a, b, slopes, theta)
    place = np.where(hit, frame.place(point), np.nan)
    return place, clock[index] + theta * h


def _finite(above: Array, below: Array) -> Array:
    """The ratio, 0 where that is no number: where there is no return after all."""
    known = np.isfinite(above) & np.isfinite(below) & (np.abs(below) > 1e-300)
    ratio = np.where(known, above, 0.0) / np.where(known, below, 1.0)
    return np.clip(ratio, -1.0, 1.0)


def _hermite(a: Array, b: Array, slopes: Array, theta: Array) -> tuple[Array, Array]:
    """The cubic through a and b (L, 2) with `slopes` (2, L, 2) there, and its derivative."""
    t = theta[:, None]
    quadratic = 3.0 * (b - a) - 2.0 * slopes[0] - slopes[1]
    cubic = slopes[0] + slopes[1] - 2.0 * (b - a)
    point = a + t * (slopes[0] + t * (quadratic + t * cubic))
    return point, slopes[0] + t * (2.0 * quadratic + 3.0 * t * cubic)
