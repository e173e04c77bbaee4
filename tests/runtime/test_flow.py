"""Flows: what moves a state, where there is no rate, and derivatives against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from runtime.code import Code
from runtime.flow import Flow, Source, flow_of, jacobian, next_states, rates
from runtime.program import Constant, Kind, Program, Role, Term
from runtime.table import Axis, Method
from tests.runtime.behaviors import (
    NOWHERE,
    ONE,
    control,
    formula_program,
    state,
    tabulated,
    tabulated_van_der_pol,
    van_der_pol,
)

NO_CONTROLS = np.zeros(0)


def points_in(flow: Flow, count: int, seed: int = 0) -> np.ndarray:
    n = len(flow.program.states)
    return np.random.default_rng(seed).uniform(*flow.domain[:, :n], (count, n))


def test_a_formula_gives_its_rates() -> None:
    x = np.array([[2.0, 0.5], [-1.0, 3.0]])
    found = rates(flow_of(van_der_pol()), x, np.array([[1.0], [0.25]]))

    np.testing.assert_array_equal(found, [[0.5, -3.5], [3.0, 1.0]])


def test_a_cubic_table_of_a_cubic_polynomial_is_the_polynomial() -> None:
    program = tabulated_van_der_pol()
    table, formula = flow_of(program), flow_of(program, Source.FORMULA)
    x = points_in(table, 1000)

    np.testing.assert_allclose(
        rates(table, x, np.ones(1)),
        rates(formula, x, np.ones(1)),
        atol=1e-12,  # rates up to 64, a few roundings
    )


def test_rates_are_sums_of_coefficients_times_columns() -> None:
    axes = (Axis("x", -4.0, 4.0, 9, periodic=False),)
    program = tabulated(
        formula_program(
            (state("x", -4.0, 4.0), state("v", -4.0, 4.0)),
            {"x": "0", "v": "0"},
            controls=(control("a", 0.0, 5.0, 1.0),),
        ),
        lambda x: np.stack([x, x**2], axis=-1),
        axes,
        Method.CUBIC,
    )
    terms = (Term(0, Code("a 2 pow"), 0, 1), Term(0, Code("1"), 0, 0), Term(1, Code("a"), -1, 0))
    program = replace(program, field=replace(program.field, terms=terms))

    found = rates(flow_of(program), np.array([1.5, 0.0]), np.array([3.0]))

    np.testing.assert_allclose(found, [9.0 * 2.25 + 1.5, 3.0], rtol=1e-14)


def test_a_driven_state_without_a_term_rests() -> None:
    program = tabulated_van_der_pol()
    terms = tuple(term for term in program.field.terms if term.component == 1)
    program = replace(program, field=replace(program.field, terms=terms))

    found = rates(flow_of(program), np.array([1.0, 2.0]), np.ones(1))

    np.testing.assert_allclose(found, [0.0, -1.0], atol=1e-14)


@pytest.mark.parametrize("program", [van_der_pol(4.0), tabulated_van_der_pol()])
def test_there_are_no_rates_outside_the_domain(program: Program) -> None:
    flow = flow_of(program)
    beyond = np.nextafter(4.0, 5.0)
    x = np.array([[4.0, -4.0], [beyond, 0.0], [0.0, -beyond], [np.nan, 0.0], [np.inf, 0.0]])

    inside = np.isfinite(rates(flow, x, np.ones(1))).all(axis=-1)

    assert inside.tolist() == [True, False, False, False, False]
    assert np.isnan(rates(flow, x[0], np.array([5.5]))).all()


def test_a_periodic_state_has_no_outside_and_wraps_in_tables() -> None:
    angle = replace(state("a", -math.pi, math.pi), kind=Kind.PERIODIC)
    program = tabulated(
        formula_program((angle,), {"a": "a sin"}),
        lambda a: np.sin(a)[..., np.newaxis],
        (Axis("a", -math.pi, math.pi, 64, periodic=True),),
        Method.CUBIC,
    )
    angles = np.linspace(-20.0, 20.0, 101)[:, np.newaxis]

    for source in Source:
        found = rates(flow_of(program, source), angles, NO_CONTROLS)
        # Cubic splines: 5/384 h^4 = 1.2e-6 at 64 nodes, less for the periodic ones.
        np.testing.assert_allclose(found, np.sin(angles), atol=1.3e-6)


def sensing() -> Program:
    """Driven by what it senses: d has a closure, e is held, m is discrete."""
    sensed = replace(state("d", -1.0, 1.0), role=Role.SENSED, closure=Code("x neg"))
    held = replace(state("e", -1.0, 1.0), role=Role.SENSED)
    mode = replace(
        state("m", 0.0, 1.0), role=Role.BOTH, kind=Kind.DISCRETE, values=("off", "on"), hold=0.0
    )
    program = formula_program((state("x", -5.0, 5.0), sensed, held, mode), {"x": "k m mul"})
    return replace(program, constants=(Constant("k", ONE, 3.0, "", NOWHERE),))


def test_sensed_states_move_by_their_closure_or_not_at_all_and_discrete_ones_never() -> None:
    found = rates(flow_of(sensing()), np.array([2.0, 0.5, 0.5, 1.0]), NO_CONTROLS)

    np.testing.assert_array_equal(found, [3.0, -2.0, 0.0, 0.0])


def test_a_step_map_has_next_states_and_a_flow_has_rates() -> None:
    step = formula_program((state("x", 0.0, 1.0),), {"x": "3.9 x mul 1 x sub mul"}, every=0.1)

    assert next_states(flow_of(step), np.array([0.5]), NO_CONTROLS) == pytest.approx(0.975)
    with pytest.raises(ValueError, match="step map"):
        rates(flow_of(step), np.array([0.5]), NO_CONTROLS)
    with pytest.raises(ValueError, match="no step map"):
        next_states(flow_of(van_der_pol()), np.zeros(2), np.ones(1))


def test_a_field_without_a_formula_says_so() -> None:
    program = tabulated_van_der_pol()
    program = replace(program, field=replace(program.field, formula=None, form="arrows"))

    with pytest.raises(ValueError, match="arrows"):
        flow_of(program, Source.FORMULA)


@pytest.mark.parametrize("program", [van_der_pol(4.0), tabulated_van_der_pol()])
def test_the_jacobian_is_that_of_the_formula_also_at_the_edges(program: Program) -> None:
    flow = flow_of(program)
    corners = [[4.0, 4.0], [-4.0, 4.0], [4.0, 0.0], [0.0, -4.0]]
    x = np.concatenate([points_in(flow, 200), corners])
    p, v = x.T
    exact = np.stack(
        [
            np.stack([np.zeros_like(p), np.ones_like(p)], axis=-1),
            np.stack([-2.0 * p * v - 1.0, 1.0 - p**2], axis=-1),
        ],
        axis=-2,
    )

    found = jacobian(flow, x, np.ones(1))

    # Rounding of rates up to 64 over steps of 1.5e-5: 1e-9.
    np.testing.assert_allclose(found, exact, rtol=1e-8, atol=1e-8)


def test_the_jacobian_knows_periodic_and_discrete_states_and_the_outside() -> None:
    angle = replace(state("a", -math.pi, math.pi), kind=Kind.PERIODIC)
    pendulum = formula_program((angle, state("w", -10.0, 10.0)), {"a": "w", "w": "a sin neg"})
    found = jacobian(flow_of(pendulum), np.array([[7.0, 1.0], [0.0, 11.0]]), NO_CONTROLS)
    np.testing.assert_allclose(found[0], [[0.0, 1.0], [-math.cos(7.0), 0.0]], atol=1e-8)
    assert np.isnan(found[1]).all()

    modes = jacobian(flow_of(sensing()), np.array([2.0, 0.5, 0.5, 1.0]), NO_CONTROLS)
    np.testing.assert_allclose(modes[1], [-1.0, 0.0, 0.0, 0.0], atol=1e-9)
    assert (modes[:, 3] == 0.0).all()
