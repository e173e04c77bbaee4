"""Zeros that move with controls: bounds beside the moving centre hold, and are of second order."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.code import Code
from runtime.enclosure import drifts, enclosure_of
from runtime.interpolation import tabulate
from runtime.program import Field, Program, Term
from runtime.table import Axis, Method
from tests.verifier.topology_scenes import behavior, control, state
from verifier.topology.claims.zero_bounds import zero_within
from verifier.topology.slices import cut

RATIO = behavior(
    "ratio",
    (state("x", -2.0, 2.0),),
    ("a b x mul sub",),
    (control("a", -1.0, 1.0, 0.5), control("b", 1.0, 2.0, 1.5)),
)
"""x' = a - b x: a zero at a/b."""


def tabled() -> Program:
    """The same, through a table over x and a, of which one column is weighed by -b."""
    axes = (Axis("x", -2.0, 2.0, 9, periodic=False), Axis("a", -1.0, 1.0, 5, periodic=False))
    x, a = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-1, 1, 5), indexing="ij")
    table = tabulate(np.stack([a, x], axis=-1), axes, Method.CUBIC)
    terms = (Term(0, Code("1"), 0, 0), Term(0, Code("b neg"), 0, 1))
    field = Field(("x",), "grid", 0.0, (table,), terms, (), None, "")
    return replace(RATIO, field=field)


@pytest.mark.parametrize("program", [RATIO, tabled()], ids=["formula", "tables"])
@given(st.floats(-0.9, 0.9), st.floats(1.1, 1.9), st.floats(0.001, 0.1), st.data())
@settings(max_examples=25, deadline=None)
def test_a_moving_zero_stays_within_its_bounds(
    program: Program, a: float, b: float, half: float, data: st.DataObject
) -> None:
    controls = np.array([[a - half, b - half], [a + half, b + half]])

    found = zero_within(cut(program, None, {}), controls, np.array([-1.5]), np.array([1.5]))

    for _ in range(5):
        u = controls[0] + np.array(data.draw(st.tuples(*2 * (st.floats(0.0, 1.0),)))) * 2.0 * half
        u = np.clip(u, *controls)
        zero = u[0] / u[1]
        rest = zero - (found.centre[0] + found.slopes[0] @ (u - found.middle))
        assert found.rest.low[0] - 1e-13 <= rest <= found.rest.high[0] + 1e-13
        assert found.bounds.low[0] - 1e-13 <= zero <= found.bounds.high[0] + 1e-13


def test_what_is_left_beside_the_motion_is_of_second_order() -> None:
    widths = []
    for half in (0.04, 0.02, 0.01):
        controls = np.array([[0.5 - half, 1.5 - half], [0.5 + half, 1.5 + half]])
        found = zero_within(cut(RATIO, None, {}), controls, np.array([-1.5]), np.array([1.5]))
        widths.append(float(found.rest.high[0] - found.rest.low[0]))

    assert widths[0] / widths[1] == pytest.approx(4.0, rel=0.2)
    assert widths[1] / widths[2] == pytest.approx(4.0, rel=0.2)


@pytest.mark.parametrize("program", [RATIO, tabled()], ids=["formula", "tables"])
def test_derivatives_by_controls_are_those_of_the_formula(program: Program) -> None:
    view = cut(program, None, {})
    box = np.array([[0.2, 1.2], [0.3, 1.4]])
    field = enclosure_of(view.program, ("x",), view.x, box)

    found = drifts(field, np.array([[0.5]]), np.array([[0.6]]))

    assert field.controls == ("a", "b")
    for j, (low, high) in enumerate(((1.0, 1.0), (-0.6, -0.5))):
        assert found.low[0, 0, j] <= low + 1e-9
        assert found.high[0, 0, j] >= high - 1e-9
        assert found.high[0, 0, j] - found.low[0, 0, j] < high - low + 0.2
