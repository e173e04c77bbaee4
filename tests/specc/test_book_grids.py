"""Functions as tables: fine enough where they bend, and no finer than that."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.arrays import Array
from specc.book.gridded import FINE, FIRST, LARGEST, NARROWEST, Axis, gridded, interpolated

ACROSS = Axis(-2.0, 3.0)
MODES = Axis(0.0, 2.0, is_discrete=True)


def test_what_is_straight_needs_no_nodes_but_the_first() -> None:
    grid = gridded(lambda p: 3.0 * p[:, 0] - p[:, 1], (ACROSS, ACROSS))

    assert grid.values.shape == (FIRST, FIRST)
    assert grid.error < 1e-12


def test_what_does_not_change_is_one_number() -> None:
    grid = gridded(lambda p: np.full(len(p), 7.0), ())

    assert grid.values == 7.0
    assert grid.error == 0.0


@given(rate=st.floats(0.5, 8.0))
def test_a_wave_is_as_near_as_is_wanted(rate: float) -> None:
    def wave(points: Array) -> Array:
        return np.sin(rate * points[:, 0])

    grid = gridded(wave, (ACROSS,))
    points = np.linspace(ACROSS.low, ACROSS.high, 5003)[:, np.newaxis]
    off = np.abs(interpolated(grid.nodes, grid.values, points) - wave(points)).max()

    assert off <= 1.1 * grid.error + 1e-12
    assert grid.error <= 2.0 * FINE * grid.size  # the bend is measured at nodes, and may be more


def test_nodes_go_where_it_bends() -> None:
    grid = gridded(lambda p: np.tanh(20.0 * p[:, 0]), (ACROSS,))
    inside = np.abs(grid.nodes[0]) < 0.3

    assert inside.mean() > 0.8


def test_at_a_jump_nodes_end_somewhere() -> None:
    grid = gridded(lambda p: np.where(p[:, 0] < 0.1234, 0.0, 1.0), (ACROSS,))
    narrowest = np.diff(grid.nodes[0]).min()

    assert grid.values.size <= LARGEST
    assert narrowest >= 0.5 * NARROWEST * (ACROSS.high - ACROSS.low)


def test_values_keep_their_places_and_are_never_parted() -> None:
    grid = gridded(lambda p: np.array([5.0, -1.0, 2.0])[p[:, 0].astype(int)], (MODES,))

    assert grid.nodes[0].tolist() == [0.0, 1.0, 2.0]
    assert grid.values.tolist() == [5.0, -1.0, 2.0]


def test_between_nodes_it_goes_on_linearly() -> None:
    nodes = np.array([0.0, 1.0]), np.array([0.0, 2.0])
    corners = np.array([[0.0, 4.0], [2.0, 10.0]])

    assert interpolated(nodes, corners, np.array([[0.5, 1.0]])) == pytest.approx(4.0)
