"""Roll, pitch and yaw of quaternions, as REP-103 means them.

A rotation is Rz(yaw) Ry(pitch) Rx(roll): x forward, y left, z up, yaw counter-clockwise.
"""

import numpy as np

from runtime.arrays import Array


def angle(which: str, x: Array, y: Array, z: Array, w: Array) -> Array:
    """`yaw`, `pitch` or `roll` (...,) in radians; NaN where the quaternion is zero.

    The quaternion need not be of unit length. Yaw and roll are in (-pi, pi], pitch in
    [-pi/2, pi/2].
    """
    # Divided by the largest part first: squares of garbage overflow.
    size = np.maximum.reduce([np.abs(x), np.abs(y), np.abs(z), np.abs(w)])
    size = np.where((size > 0.0) & np.isfinite(size), size, np.nan)
    with np.errstate(invalid="ignore"):
        x, y, z, w = x / size, y / size, z / size, w / size
    two = 2.0 / (x * x + y * y + z * z + w * w)
    if which == "yaw":
        return np.arctan2(two * (w * z + x * y), 1.0 - two * (y * y + z * z))
    if which == "roll":
        return np.arctan2(two * (w * x + y * z), 1.0 - two * (x * x + y * y))
    assert which == "pitch", which
    return np.arcsin(np.clip(two * (w * y - z * x), -1.0, 1.0))
