"""How far a loop swings on each axis."""

import numpy as np

from runtime.arrays import Array


def swing(loops: Array) -> Array:
    """Lowest, highest, half their distance (..., 3, m) of loops (..., T, m)."""
    low, high = -_peak(-loops), _peak(loops)
    return np.stack([low, high, 0.5 * (high - low)], axis=-2)


def swing_with_corners(loops: Array) -> Array:
    """The same of loops with corners and jumps at some of their points, which are their ends."""
    low, high = np.min(loops, axis=-2), np.max(loops, axis=-2)
    return np.stack([low, high, 0.5 * (high - low)], axis=-2)


def _peak(loops: Array) -> Array:
    """The highest value on each axis (..., m): of a parabola through the highest three points."""
    last = loops.shape[-2] - 2
    at = np.clip(np.argmax(loops, axis=-2), 1, last)[..., None, :]
    before, here, after = (
        np.take_along_axis(loops, at + k, axis=-2)[..., 0, :] for k in (-1, 0, 1)
    )
    bend = 2.0 * here - before - after
    rise = np.where(bend > 0.0, (after - before) ** 2 / (8.0 * np.maximum(bend, 1e-300)), 0.0)
    # Not at a corner, where a parabola would rise above the curve by much.
    rise = np.minimum(rise, 0.25 * np.maximum(bend, 0.0))
    return np.asarray(np.maximum(np.max(loops, axis=-2), here + rise))
