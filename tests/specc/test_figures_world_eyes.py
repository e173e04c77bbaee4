"""What sensors say, as it is drawn: arcs are where the range says, lines end at what is seen."""

import math

import numpy as np
import pytest

from specc.figures.eyes import Glimpse, arcs, glimpses, hits
from specc.figures.scene import Eye, EyeKind, Said

AHEAD = Eye(EyeKind.RANGE, 0.1, 0.0, 0.0, math.pi / 2.0, 2.0)
LEFT = Eye(EyeKind.SIGHT, 0.0, 0.2, math.pi / 2.0, math.tau, 6.0)
BUMPER = Eye(EyeKind.BUMP, 0.0, 0.0, 0.0, math.pi, 0.0)
POSE = np.array([1.0, 2.0, math.pi / 2.0])
"""Looks along y: the eye ahead is at (1, 2.1), that at the left at (0.8, 2)."""


def test_an_arc_is_everywhere_as_far_as_the_range_says() -> None:
    (near, is_near), (fan, is_fan) = arcs(
        [AHEAD], [Glimpse(seen=True, distance=0.7, bearing=0.0)], POSE
    )

    assert (is_near, is_fan) == (True, False)
    np.testing.assert_allclose(np.hypot(*(near - (1.0, 2.1)).T), 0.7, atol=1e-12)
    turns = np.arctan2(near[:, 1] - 2.1, near[:, 0] - 1.0)
    assert (turns[0], turns[-1]) == pytest.approx((math.pi / 4.0, 3.0 * math.pi / 4.0))
    np.testing.assert_allclose(fan[[0, -1]], [[1.0, 2.1]] * 2, atol=1e-12)


def test_nothing_in_reach_draws_only_the_fan() -> None:
    (only,) = arcs([AHEAD], [Glimpse(seen=False, distance=2.0, bearing=0.0)], POSE)

    assert only[1] is False


def test_a_line_ends_where_the_thing_is_seen() -> None:
    ((line, _),) = arcs([LEFT], [Glimpse(seen=True, distance=3.0, bearing=-math.pi / 2.0)], POSE)

    # It looks along -x, and the thing is to the right of that: along y.
    np.testing.assert_allclose(line, [[0.8, 2.0], [0.8, 5.0]], atol=1e-12)


def test_what_has_said_nothing_or_sees_nothing_draws_nothing() -> None:
    blind = Glimpse(seen=False, distance=0.0, bearing=0.0)

    assert arcs([AHEAD, LEFT, BUMPER], [None, blind, blind], POSE) == []
    assert hits([AHEAD, BUMPER, BUMPER], [blind, None, blind], POSE, 0.2) == []


def test_a_hit_is_an_arc_around_the_robot_on_that_side() -> None:
    (struck,) = hits([BUMPER], [Glimpse(seen=True, distance=0.0, bearing=0.0)], POSE, 0.2)

    assert np.all(struck[:, 1] >= 2.0 - 1e-12)
    assert np.all(np.hypot(*(struck - POSE[:2]).T) > 0.2)


def test_a_glimpse_is_the_last_that_was_said() -> None:
    said = Said(
        np.array([1.0, 2.0]), np.array([True, False]), np.array([0.5, 2.0]), np.array([0.0, 0.0])
    )

    assert glimpses((said,), 0.9) == (None,)
    assert glimpses((said,), 1.999) == (Glimpse(seen=True, distance=0.5, bearing=0.0),)
    assert glimpses((said,), 2.0) == (Glimpse(seen=False, distance=2.0, bearing=0.0),)
