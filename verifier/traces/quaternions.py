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
    squares = x * x + y * y + z * z + w * w
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        two = np.where(squares > 0.0, 2.0 / squares, np.nan)
    if which == "yaw":
        return np.arctan2(two * (w * z + x * y), 1.0 - two * (y * y + z * z))
    if which == "roll":
        return np.arctan2(two * (w * x + y * z), 1.0 - two * (x * x + y * y))
    assert which == "pitch", which
    return np.arcsin(np.clip(two * (w * y - z * x), -1.0, 1.0))
