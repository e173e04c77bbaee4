"""Angles of quaternions: fixed vectors, and rotation matrices as the second opinion."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from verifier.traces.messages.quaternions import angle

HALF = math.sqrt(0.5)


@pytest.mark.parametrize(
    ("xyzw", "yaw"),
    [
        ((0.0, 0.0, 0.0, 1.0), 0.0),
        ((0.0, 0.0, HALF, HALF), math.pi / 2),
        ((0.0, 0.0, -HALF, HALF), -math.pi / 2),
        ((0.0, 0.0, 1.0, 0.0), math.pi),
        ((0.0, 0.0, math.sin(0.15), math.cos(0.15)), 0.3),
        ((0.0, 0.0, -math.sin(0.15), -math.cos(0.15)), 0.3),
        ((0.0, 0.0, 3.0 * math.sin(0.15), 3.0 * math.cos(0.15)), 0.3),
        ((1.0, 0.0, 0.0, 0.0), 0.0),
    ],
)
def test_yaw_is_counter_clockwise_about_z(
    xyzw: tuple[float, float, float, float], yaw: float
) -> None:
    found = angle("yaw", *(np.array([part]) for part in xyzw))

    # Four operations in double precision.
    assert found[0] == pytest.approx(yaw, abs=1e-15)


def test_nose_down_is_positive_pitch_and_right_side_down_positive_roll() -> None:
    half = math.sin(0.1), math.cos(0.1)

    pitch = angle("pitch", *(np.array([part]) for part in (0.0, half[0], 0.0, half[1])))
    roll = angle("roll", *(np.array([part]) for part in (half[0], 0.0, 0.0, half[1])))

    assert pitch[0] == pytest.approx(0.2, abs=1e-15)
    assert roll[0] == pytest.approx(0.2, abs=1e-15)


@given(
    yaw=st.floats(-3.1, 3.1),
    pitch=st.floats(-1.5, 1.5),
    roll=st.floats(-3.1, 3.1),
    scale=st.floats(0.1, 10.0),
)
def test_the_angles_of_a_composed_rotation_come_back(
    yaw: float, pitch: float, roll: float, scale: float
) -> None:
    x, y, z, w = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat() * scale
    parts = [np.array([part]) for part in (x, y, z, w)]

    found = [angle(name, *parts)[0] for name in ("yaw", "pitch", "roll")]

    # Near pitch pi/2 the arcsine loses half the digits.
    np.testing.assert_allclose(found, [yaw, pitch, roll], atol=1e-8)


def test_a_zero_quaternion_has_no_angle() -> None:
    zero = np.zeros(2)

    for name in ("yaw", "pitch", "roll"):
        assert np.isnan(angle(name, zero, zero, zero, zero)).all()
