"""Evenly spaced streamlines: along the flow, within the sheet, and apart from one another."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.arrays import Array
from specc.figures.streamlines import CLOSEST, FINE, Sheet, Spacing, evenly_spaced, velocity_at

SPACING = Spacing()
SIZE = np.array([4.0, 3.0])
COEFFICIENTS = st.lists(st.floats(-2.0, 2.0), min_size=8, max_size=8)


def sheet(coefficients: list[float], size: Array = SIZE) -> Sheet:
    """A smooth field with a few waves in it."""
    x, y = np.meshgrid(np.linspace(0, size[0], 41), np.linspace(0, size[1], 41), indexing="ij")
    a, b, c, d, e, f, g, h = coefficients
    u = a + b * np.sin(x + y) + c * np.cos(y) + d * np.sin(x)
    v = e + f * np.sin(x - y) + g * np.cos(x) + h * np.sin(y)
    return Sheet(np.stack([u, v], axis=-1), size)


@settings(max_examples=6, deadline=None)
@given(COEFFICIENTS)
def test_lines_run_along_the_flow_and_stay_on_the_sheet(coefficients: list[float]) -> None:
    field = sheet(coefficients)

    for line in evenly_spaced(field, SPACING):
        assert np.all((line >= 0.0) & (line <= field.size))
        steps = np.diff(line, axis=0)
        v = velocity_at(field, 0.5 * (line[1:] + line[:-1]))
        speed = np.hypot(*v.T)
        moving = speed > 0.2
        along = np.sum(steps * v, axis=-1)[moving]
        assert np.all(along >= 0.9 * np.hypot(*steps.T)[moving] * speed[moving])


@settings(max_examples=6, deadline=None)
@given(COEFFICIENTS)
def test_no_two_lines_come_closer_than_allowed(coefficients: list[float]) -> None:
    lines = evenly_spaced(sheet(coefficients), SPACING)

    # Recorded in cells: two of their diagonals, and half a step between two points.
    closest = (CLOSEST - 2.0 * 2.0**0.5 / FINE) * SPACING.apart - 0.5 * SPACING.step
    for i, line in enumerate(lines):
        for other in lines[:i]:
            gaps = np.linalg.norm(line[:, None] - other[None], axis=-1)
            assert gaps.min() > closest


@pytest.mark.parametrize("size", [np.array([4.0, 3.0]), np.array([1.5, 1.4])])
def test_a_uniform_field_is_filled_evenly(size: Array) -> None:
    lines = evenly_spaced(sheet([1.0, 0, 0, 0, 0.0, 0, 0, 0], size), SPACING)

    heights = np.unique([round(float(line[0, 1]), 3) for line in lines])
    assert np.diff(heights).max() < 2.2 * SPACING.apart


def test_lines_keep_away_from_curves_that_are_drawn_already() -> None:
    curve = np.stack([np.linspace(0.0, 4.0, 150), np.full(150, 1.5)], axis=-1)

    lines = evenly_spaced(sheet([1.0, 0, 0, 0, 0.0, 0, 0, 0]), SPACING, [curve])

    assert lines
    assert all(np.abs(line[:, 1] - 1.5).min() > 0.3 * SPACING.apart for line in lines)


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_a_field_that_stands_still_or_is_unknown_has_no_lines(value: float) -> None:
    assert not evenly_spaced(Sheet(np.full((9, 9, 2), value), SIZE), SPACING)


def test_a_focus_is_not_wound_up_into_a_blot() -> None:
    x, y = np.meshgrid(np.linspace(-2, 2, 41), np.linspace(-2, 2, 41), indexing="ij")
    spiral = Sheet(np.stack([-0.05 * x - y, x - 0.05 * y], axis=-1), np.array([4.0, 4.0]))

    near = [np.hypot(*(line - 2.0).T) < 0.3 for line in evenly_spaced(spiral, SPACING)]

    ink = sum(int(n.sum()) for n in near) * SPACING.step
    assert ink < 0.3**2 * np.pi / (CLOSEST * SPACING.apart) * 1.3
