"""The field of nested orbits: coordinates in which they are circles, and what happens there.

Around the centre a place is (level, angle): level 0 is the centre, level i the i-th orbit, the last
one a circle around all. Along a ray the radius G(level, angle) grows with the level everywhere, so
that the level alone decides what draws in and what sends out: between two neighbors it moves one
way, and the blend has the orbits that were drawn and no other. A small distance from orbit i
shrinks by exp(-strength * time), whatever the shapes. N: places; L: orbits.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, final

import numpy as np

from compiler.sketch.blend import Blend
from compiler.sketch.curves import Curve
from compiler.sketch.graphs import quarter_turn
from compiler.sketch.models import NodeModel, Settings, saturated
from compiler.sketch.pacing import smooth_step
from runtime.arrays import Array, Booleans
from spec_schema.expressions.tree import Expr

HOLD: Final = 0.2
"""Within so much of a level, the level's own field holds alone."""
ROOM: Final = 0.8
"""How much of the narrowest gap between two orbits their own neighborhoods may take."""
AROUND: Final = 1.0
"""How far the circle around all is from the outermost orbit, in that orbit's least radius."""
FADE: Final = 2.0
"""Beyond so many of its radii the field points straight inward or outward."""
CALM: Final = 1.8
"""Over so many levels beyond the last orbit the going round comes to rest."""
NEWTON: Final = 10
"""Newton steps to a place's level; one that leaves the bracket becomes a halving."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RingModel:
    """Nested orbits as one model.

    curves, attracts, strengths, paces: per orbit, the innermost first; paces: for each edge the
    coefficient of its angular speed, 1/s. core: the point in the middle; None where other models
    hold there. turning: whether the core turns as the innermost orbit does.
    """

    centre: Array
    curves: tuple[Curve, ...]
    attracts: tuple[bool, ...]
    strengths: tuple[Expr, ...]
    paces: tuple[tuple[Expr, ...], ...]
    core: NodeModel | None
    turning: bool

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The strengths, the paces, the rate far away, those of the core."""
        paces = tuple(pace for edges in self.paces for pace in edges)
        core = (self.strengths[0],) if self.core is None else self.core.coefficients
        return (*self.strengths, *paces, self.strengths[-1], *core)

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far outside of the outermost orbit a place is; 0 inside."""
        del settings
        r, theta = self._polar(q)
        return np.maximum(r - self.curves[-1].radii(theta)[0], 0.0)

    def depth(self, q: Array) -> Array:
        """How far inside of the innermost orbit a place is; 0 outside."""
        r, theta = self._polar(q)
        return np.maximum(self.curves[0].radii(theta)[0] - r, 0.0)

    def parts(self, q: Array, settings: Settings) -> Array:
        """The vectors (N, B, 2) of the parts, in the order of the coefficients."""
        r, theta = self._polar(q)
        y, last = q - self.centre, len(self.curves)
        ray = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        radii = Radii.of(self.curves, theta)
        level = radii.level(r)
        g, by_level, by_angle = radii.at(level)
        outward = by_level[:, np.newaxis] * ray
        around = by_angle[:, np.newaxis] * ray + g[:, np.newaxis] * quarter_turn(ray)
        near = self._near(r)
        holds = [near * _hold(level, i, last) for i in range(last + 1)]
        found = [
            (_sign(draws) * (level - i) * holds[i])[:, np.newaxis] * outward
            for i, draws in enumerate(self.attracts, start=1)
        ]
        for i, curve in enumerate(self.curves, start=1):
            still = smooth_step((level - last - HOLD) / CALM)
            pace = curve.pace(theta) * (holds[i] * (1.0 - still))[:, np.newaxis]
            if i == 1 and self.turning:
                pace = pace + curve.direction * curve.mean * holds[0][:, np.newaxis]
            found += [pace[:, e, np.newaxis] * around for e in range(pace.shape[1])]
        found.append(((1.0 - near) * _sign(self.attracts[-1]))[:, np.newaxis] * saturated(y))
        own = np.stack(found, axis=1)
        middle = holds[0][:, np.newaxis, np.newaxis]
        core = (
            -_sign(self.attracts[0]) * y[:, np.newaxis]
            if self.core is None
            else self.core.parts(q, settings)
        )
        return np.concatenate([own, middle * core], axis=1)

    def _polar(self, q: Array) -> tuple[Array, Array]:
        y = q - self.centre
        return np.hypot(y[:, 0], y[:, 1]), np.arctan2(y[:, 1], y[:, 0])

    def _near(self, r: Array) -> Array:
        """1 at the orbits, 0 far away."""
        return 1.0 - smooth_step((r / _circle(self.curves) - 1.0) / (FADE - 1.0))


@final
@dataclass(frozen=True, eq=False, slots=True)
class CollarModel:
    """Nested orbits as seen from inside: the nearer to the innermost, the more they count."""

    rings: RingModel

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """Those of the orbits."""
        return self.rings.coefficients

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far inside of the innermost orbit."""
        del settings
        return self.rings.depth(q)

    def parts(self, q: Array, settings: Settings) -> Array:
        """The field of the orbits, continued inward."""
        return self.rings.parts(q, settings)


@final
@dataclass(frozen=True, eq=False, slots=True)
class HollowModel:
    """Nested orbits around several features. inside: their blend; its first model is the collar."""

    rings: RingModel
    inside: Blend

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """Those of the orbits, then of what they hold."""
        return self.inside.coefficients

    def distance(self, q: Array, settings: Settings) -> Array:
        """How far outside of the outermost orbit a place is; 0 inside."""
        return self.rings.distance(q, settings)

    def parts(self, q: Array, settings: Settings) -> Array:
        """The blend inside, the orbits alone outside: they agree on the innermost orbit."""
        found = self.inside.parts(q, settings)
        outside = self.rings.depth(q) == 0.0
        count = len(self.rings.coefficients)
        found[outside, count:] = 0.0
        found[outside, :count] = self.rings.parts(q[outside], _at(settings, outside))
        return found


@final
@dataclass(frozen=True, eq=False, slots=True)
class Radii:
    """G along the rays of N places.

    bases, slopes: (L + 2, N) the radius at each level, and its derivative by the angle; steps:
    (L + 2,) how fast the radius grows with the level there.
    """

    bases: Array
    slopes: Array
    steps: Array

    @staticmethod
    def of(curves: tuple[Curve, ...], theta: Array) -> "Radii":
        """The levels of curves, along polar angles (N,)."""
        found = [curve.radii(theta) for curve in curves]
        circle = _circle(curves)
        zero = np.zeros_like(theta)
        bases = np.stack([zero, *(r for r, _ in found), zero + circle])
        slopes = np.stack([zero, *(slope for _, slope in found), zero])
        return Radii(bases, slopes, _steps(curves, circle))

    def at(self, level: Array) -> tuple[Array, Array, Array]:
        """G (N,), and its derivatives by the level and by the angle."""
        last = len(self.steps) - 1
        k = np.clip(np.floor(level - HOLD).astype(int), 0, last - 1)
        b, db = _step_with_slope((level - k - HOLD) / (1.0 - 2.0 * HOLD))
        db = db / (1.0 - 2.0 * HOLD)
        n = np.arange(len(level))
        low = self.bases[k, n] + (level - k) * self.steps[k]
        high = self.bases[k + 1, n] + (level - k - 1.0) * self.steps[k + 1]
        g = (1.0 - b) * low + b * high
        by_level = (1.0 - b) * self.steps[k] + b * self.steps[k + 1] + db * (high - low)
        by_angle = (1.0 - b) * self.slopes[k, n] + b * self.slopes[k + 1, n]
        return g, by_level, by_angle

    def level(self, r: Array) -> Array:
        """The level (N,) at which G is r, by Newton's method; beyond the circle G is linear."""
        last = len(self.steps) - 1
        low = np.clip(np.sum(self.bases[1:last] <= r, axis=0), 0, last - 1).astype(np.float64)
        high = low + 1.0
        level = (low + high) / 2.0
        for _ in range(NEWTON):
            g, slope, _ = self.at(level)
            low, high = np.where(g < r, level, low), np.where(g < r, high, level)
            step = level - (g - r) / slope
            level = np.where((low <= step) & (step <= high), step, (low + high) / 2.0)
        beyond = last + (r - self.bases[last]) / self.steps[last]
        found: Array = np.where(r > self.bases[last], beyond, level)
        return found


def _circle(curves: tuple[Curve, ...]) -> float:
    """The radius of the circle around all."""
    return curves[-1].outer + AROUND * curves[-1].inner


def _steps(curves: tuple[Curve, ...], circle: float) -> Array:
    """How fast (L + 2,) the radius grows at each level: less than the gaps on either side."""
    t = np.linspace(0.0, 2.0 * np.pi, 720)
    radii = [np.zeros_like(t), *(curve.radii(t)[0] for curve in curves), np.full_like(t, circle)]
    gaps = [float(np.min(outer - inner)) for inner, outer in pairwise(radii)]
    around = zip([gaps[0], *gaps], [*gaps, gaps[-1]], strict=True)
    return np.array([ROOM * min(before, after) for before, after in around])


def _step_with_slope(x: Array) -> tuple[Array, Array]:
    """The smooth step and its derivative."""
    inside = np.clip(x, 0.0, 1.0)
    return smooth_step(x), 630.0 * (inside * (1.0 - inside)) ** 4


def _hold(level: Array, i: int, last: int) -> Array:
    """How much level i counts: 1 within `HOLD` of it, 1 in all; the last one holds on outward."""
    width = 1.0 - 2.0 * HOLD
    rise = smooth_step((level - (i - 1) - HOLD) / width) if i else np.ones_like(level)
    fall = smooth_step((level - i - HOLD) / width) if i < last else np.zeros_like(level)
    found: Array = rise * (1.0 - fall)
    return found


def _sign(attracts: bool) -> float:  # noqa: FBT001  the question is what it is about
    return -1.0 if attracts else 1.0


def _at(settings: Settings, chosen: Booleans) -> Settings:
    return {name: values[chosen] for name, values in settings.items()}
