"""Where a zero that is proved for a box of controls can be for a smaller box V of them.

The zero z(u) is the only one in a region X for all controls u of the large box. It moves with the
controls, to first order by S = -J⁻¹ dF/du, so it is bounded beside the moving point
c(u) = c0 + S (u - u0): with e = z - c, and A in the bounds of J over the hull of X and all c(u),
    0 = F(z, u) = F(c(u), u) + A e,    F(c(u), u) in F(c0, u0) + (J S + dF/du) (V - u0),
so e lies in Krawczyk's operator of it (Neumaier 1990, sections 5.1 and 5.3). e is of second order
in the size of V. m: axes; d: controls that are intervals in V.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.enclosure import Enclosure, changes, drifts, enclosure_of, slopes
from runtime.intervals import Interval, add, common, exactly, multiply, subtract
from verifier.topology.slices import Slice
from verifier.topology.zeros.contraction import inverses_of, krawczyk, narrowed

CONTRACTIONS: Final = 4
"""So often is the bound of what is left contracted; mostly twice is enough."""

ENOUGH: Final = 0.8
"""A contraction that leaves more than this share is the last."""

CLOSE: Final = 1e-6
"""Newton's method stops at steps of this share of the bounds: anything is allowed."""

STEPS: Final = 3
"""Steps of Newton's method to the zero at the middle of the controls."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Moving:
    """A zero for all controls in V: z(u) lies in c0 + S (u - u0) + `rest`, and in `bounds`.

    centre: c0 (m,). slopes: S (m, d). controls, middle, off: the names of those that are
    intervals, u0 (d,), and bounds of u - u0.
    """

    centre: Array
    slopes: Array
    rest: Interval
    bounds: Interval
    controls: tuple[str, ...]
    middle: Array
    off: Interval

    @staticmethod
    def resting(low: Array, high: Array) -> "Moving":
        """A zero anywhere in low to high (m,), however it moves there."""
        centre = 0.5 * (low + high)
        nowhere = exactly(np.empty(0))
        box = Interval(low, high)
        rest = subtract(box, exactly(centre))
        return Moving(centre, np.empty((len(low), 0)), rest, box, (), nowhere.low, nowhere)


def zero_within(view: Slice, controls: Array, low: Array, high: Array) -> Moving:
    """Bounds of the zero in low to high (m,), for all controls in (2, p) low to high."""
    names = tuple(axis.name for axis in view.axes)
    field = enclosure_of(view.program, names, view.x, controls)
    columns = [control.name in field.controls for control in view.program.controls]
    between = controls[0] + 0.5 * (controls[1] - controls[0])
    still = enclosure_of(view.program, names, view.x, np.stack([between, between]))
    centre = _newton(still, low, high)
    box, middle = Interval(low, high), exactly(between[columns])
    first, last = (subtract(exactly(end), middle) for end in controls[:, columns])
    off = Interval(first.low, last.high)
    motion = _motion(field, centre)
    path = add(exactly(centre), _product(exactly(motion), off))
    found = Moving(centre, motion, subtract(box, path), box, field.controls, middle.low, off)
    there = _only(changes(still, centre[None], centre[None]))
    for _ in range(CONTRACTIONS):
        before = found.rest.high - found.rest.low
        found = _contracted(field, found, path, there)
        if np.all(found.rest.high - found.rest.low > ENOUGH * before):
            break
    return found


def _newton(still: Enclosure, low: Array, high: Array) -> Array:
    """Nearly the zero (m,) at the middle of the controls; anything is allowed."""
    at = 0.5 * (low + high)
    for _ in range(STEPS):
        f, J = changes(still, at[None], at[None]), slopes(still, at[None], at[None])
        with np.errstate(invalid="ignore"):
            step = (inverses_of(J) @ (0.5 * (f.low + f.high))[..., None])[0, :, 0]
        before = at
        at = np.where(np.isfinite(step), np.clip(at - step, low, high), at)
        if np.all(np.abs(at - before) <= CLOSE * (high - low)):
            break
    return at


def _motion(field: Enclosure, at: Array) -> Array:
    """How a zero (m,) moves with the controls, (m, d), nearly; anything is allowed."""
    J, by_controls = slopes(field, at[None], at[None]), drifts(field, at[None], at[None])
    with np.errstate(invalid="ignore"):
        motion = -inverses_of(J)[0] @ (0.5 * by_controls.low + 0.5 * by_controls.high)[0]
    return np.where(np.isfinite(motion), motion, 0.0)


def _contracted(field: Enclosure, found: Moving, path: Interval, there: Interval) -> Moving:
    """The bounds after one more application of Krawczyk's operator to what is left."""
    low = np.minimum(path.low, found.bounds.low)[None]
    high = np.maximum(path.high, found.bounds.high)[None]
    J = slopes(field, low, high)
    along = add(_product(_only(J), exactly(found.slopes)), _only(drifts(field, low, high)))
    values = add(there, _product(along, found.off))
    rest = found.rest
    radius = np.maximum(np.abs(rest.low), np.abs(rest.high))[None]
    values = Interval(values.low[None], values.high[None])
    image = krawczyk(np.zeros_like(radius), radius, values, J, inverses_of(J))
    first, last = narrowed(image, rest.low[None], rest.high[None])
    rest = Interval(first[0], last[0])
    return replace(found, rest=rest, bounds=common(found.bounds, add(path, rest)))


def _only(boxes: Interval) -> Interval:
    return Interval(boxes.low[0], boxes.high[0])


def _product(a: Interval, b: Interval) -> Interval:
    """A matrix (m, k) times a matrix (k, d) or a vector (k,)."""
    columns = b.low.ndim > 1
    total = exactly(np.zeros((*a.low.shape[:1], *b.low.shape[1:])))
    for k in range(a.low.shape[1]):
        left = Interval(a.low[:, k], a.high[:, k])
        if columns:
            left = Interval(left.low[:, None], left.high[:, None])
        total = add(total, multiply(left, Interval(b.low[k], b.high[k])))
    return total
