"""Tables over coordinates that move with the controls, against formulas and plain look-ups."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compiler.dump import dump
from runtime.arrays import Array
from runtime.artifact import ArtifactError, from_bytes, to_bytes
from runtime.code import Code
from runtime.flow import Source, flow_of, jacobian, rates
from runtime.integrators import adaptive
from runtime.interpolation import lookup
from runtime.machine import evaluate, run_tape
from runtime.program import Control, Coordinate, Kind, Program, State, Term
from runtime.table import Axis, Method
from runtime.tape import Sum, pack
from tests.runtime.behaviors import NOWHERE, control, formula_program, state, tabulated
from verifier.fidelity.stretches.needs import names_read

MIDDLE, HALF = "x c sub", "x c sub s div"
MOVING = (
    Coordinate("q", Code(HALF), -12.0, 12.0, NOWHERE),
    Coordinate("r", Code("v s div"), -8.0, 8.0, NOWHERE),
)
CONTROLS = (control("c", -2.0, 2.0, 0.5), control("s", 0.5, 2.0, 1.0))


def over(
    coordinates: tuple[Coordinate, ...],
    axes: tuple[Axis, ...],
    values: Callable[..., Array],
    formula: dict[str, str],
    states: tuple[State, ...],
    controls: tuple[Control, ...] = CONTROLS,
) -> Program:
    program = tabulated(formula_program(states, formula, controls), values, axes, Method.CUBIC, "s")
    return replace(program, field=replace(program.field, coordinates=coordinates))


def moving_cubic() -> Program:
    """Rates s (r, q - q³ - r) in q = (x - c) / s, r = v / s: a cubic spline loses nothing."""
    return over(
        MOVING,
        (Axis("q", -12.0, 12.0, 9, periodic=False), Axis("r", -8.0, 8.0, 7, periodic=False)),
        lambda q, r: np.stack([r, q - q**3 - r], axis=-1),
        {"x": "v", "v": f"s {HALF} {HALF} 3 pow sub v s div sub mul"},
        (state("x", -4.0, 4.0), state("v", -4.0, 4.0)),
    )


def places(program: Program, count: int) -> tuple[Array, Array]:
    """Random states (count, n) and controls (count, p) of the domain."""
    rng = np.random.default_rng(0)
    x, u = (
        rng.uniform(
            [part.low for part in parts], [part.high for part in parts], (count, len(parts))
        )
        for parts in (program.states, program.controls)
    )
    return x, u


def test_a_table_over_moving_coordinates_is_its_formula_at_all_controls() -> None:
    program = moving_cubic()
    x, u = places(program, 1000)

    found = rates(flow_of(program), x, u)

    exact = rates(flow_of(program, Source.FORMULA), x, u)
    np.testing.assert_allclose(found, exact, atol=1e-10)  # rates up to 3,000, a few roundings


def test_its_numbers_are_those_of_code_and_look_up_one_after_the_other() -> None:
    program = moving_cubic()
    x, u = places(program, 200)
    register = np.concatenate([x, u], axis=-1)
    at = evaluate([each.code for each in MOVING], program.register, register)

    by_hand = u[:, 1:] * lookup(program.field.tables[0], at)

    np.testing.assert_array_equal(rates(flow_of(program), x, u), by_hand)


def test_coordinates_states_and_controls_may_be_axes_of_one_table() -> None:
    program = over(
        (Coordinate("q", Code(MIDDLE), -6.0, 6.0, NOWHERE),),
        (
            Axis("s", 0.5, 2.0, 5, periodic=False),
            Axis("q", -6.0, 6.0, 6, periodic=False),
            Axis("v", -4.0, 4.0, 7, periodic=False),
        ),
        lambda s, q, v: np.stack([v * q, s * q**2 - v], axis=-1),
        {"x": f"s v mul {MIDDLE} mul", "v": f"s s {MIDDLE} 2 pow mul v sub mul"},
        (state("x", -4.0, 4.0), state("v", -4.0, 4.0)),
    )
    x, u = places(program, 300)

    exact = rates(flow_of(program, Source.FORMULA), x, u)
    np.testing.assert_allclose(rates(flow_of(program), x, u), exact, atol=1e-11)


def test_a_coordinate_of_an_angle_has_a_periodic_axis() -> None:
    angle = replace(state("theta", -math.pi, math.pi), kind=Kind.PERIODIC)
    program = over(
        (Coordinate("q", Code("theta c sub"), -math.pi, math.pi, NOWHERE),),
        (Axis("q", -math.pi, math.pi, 64, periodic=True),),
        lambda q: np.sin(q)[..., np.newaxis],
        {"theta": "s theta c sub sin mul"},
        (angle,),
    )
    x, u = places(program, 300)
    x = 10.0 * x  # several turns

    exact = rates(flow_of(program, Source.FORMULA), x, u)
    np.testing.assert_allclose(rates(flow_of(program), x, u), exact, atol=5e-7)  # s h⁴/384


def test_trajectories_through_moving_coordinates_are_those_of_the_formula() -> None:
    program = moving_cubic()
    x0, u = np.array([[1.0, 0.5], [-1.5, 0.0]]), np.array([[0.5, 1.0], [-1.0, 1.5]])
    times = np.linspace(0.0, 5.0, 11)
    tables, formula = (flow_of(program, source) for source in Source)

    found = adaptive(tables, x0, u, times, 1e-10, 1e-12).states

    expected = adaptive(formula, x0, u, times, 1e-10, 1e-12).states
    np.testing.assert_allclose(found, expected, atol=1e-8)
    np.testing.assert_allclose(
        jacobian(tables, x0, u), jacobian(formula, x0, u), atol=1e-6
    )  # of differences


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_what_is_computed_for_a_table_is_not_overwritten_before_it_is_read(seed: int) -> None:
    """Random coordinates and coefficients that share subexpressions, in any order."""
    rng = np.random.default_rng(seed)
    parts = ["a b add", "a b add 2 mul", "a b add 2 mul sin", "b a sub", "a", "0.5", "a b mul exp"]

    def pick() -> str:
        return parts[rng.integers(len(parts))]

    spots = [f"{pick()} {pick()} mul sin"]
    spots += [f"{spots[0]} {pick()} mul {pick()} add cos", f"{spots[0]} {pick()} add sin"]
    coordinates = tuple(
        Coordinate(f"q{i}", Code(text), -1.0, 1.0, NOWHERE) for i, text in enumerate(spots)
    )
    axes = [Axis(f"q{i}", -1.0, 1.0, 5, periodic=False) for i in range(3)]
    base = formula_program((state("x", -1.0, 1.0), state("y", -1.0, 1.0)), {"x": "0", "y": "0"})
    tables = [
        tabulated(
            base, lambda *q: np.stack([q[0], q[-1] * q[0]], -1), kept, Method.LINEAR
        ).field.tables[0]
        for kept in [(axes[0],), (axes[2], axes[1])]
    ]
    chosen = [(Code(f"{pick()} {pick()} add"), int(rng.integers(-1, 2)), 1) for _ in range(4)]
    code = Code(pick())
    results: list[Code | Sum] = [code, Sum(tuple(chosen)), Sum(tuple(chosen[1:3]))]
    register = rng.uniform(-1.0, 1.0, (70, 2))

    found = run_tape(pack(results, ("a", "b"), tables, coordinates), register)

    q = evaluate([each.code for each in coordinates], ("a", "b"), register)
    columns = [lookup(tables[0], q[:, :1])[:, 1], lookup(tables[1], q[:, [2, 1]])[:, 1]]
    columns.append(np.ones(70))

    def total(parts: list[tuple[Code, int, int]]) -> Array:
        values = [evaluate([code], ("a", "b"), register)[:, 0] * columns[t] for code, t, _ in parts]
        return np.asarray(sum(values))

    first = evaluate([code], ("a", "b"), register)[:, 0]
    expected = np.stack([first, total(chosen), total(chosen[1:3])], axis=-1)
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-15)


def test_coordinates_that_no_table_used_asks_for_cost_nothing() -> None:
    program = moving_cubic()
    bare = replace(program, field=replace(program.field, coordinates=(), tables=(), terms=()))

    found, without = (flow_of(each, Source.FORMULA).tape.instructions for each in (program, bare))

    assert sorted(found[:, 0]) == sorted(without[:, 0])


def test_coordinates_are_stored_dumped_and_read_by_the_field() -> None:
    program = moving_cubic()
    found = from_bytes(to_bytes(program))

    assert found.field.coordinates == MOVING
    assert "coordinate q  = x c sub s div  [-12.0, 12.0]" in dump(program)
    without = replace(program, field=replace(program.field, formula=None))
    assert {"x", "v", "c", "s"} <= names_read(without)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"code": Code("x v add")}, "reads 2 states"),
        ({"code": Code("c s add")}, "reads 0 states"),
        ({"code": Code("x q add")}, "'q'"),
        ({"code": Code("x boom")}, "'boom'"),
        ({"name": "x"}, "two variables are named 'x'"),
        ({"name": "../q"}, "no name"),
        ({"name": "w"}, "axes"),
        ({"low": 12.0}, "no values"),
    ],
)
def test_coordinates_that_do_not_fit_are_refused(change: dict[str, object], reason: str) -> None:
    program = moving_cubic()
    odd = replace(MOVING[0], **change)  # type: ignore[arg-type]  # of any field
    broken = replace(program, field=replace(program.field, coordinates=(odd, MOVING[1])))

    with pytest.raises(ArtifactError, match=reason):
        to_bytes(broken)


def test_a_term_without_a_table_needs_no_coordinate() -> None:
    program = moving_cubic()
    terms = (Term(0, Code("c"), -1, 0),)
    still = replace(program, field=replace(program.field, terms=terms))

    np.testing.assert_array_equal(
        rates(flow_of(still), np.zeros(2), np.array([1.5, 1.0])), [1.5, 0.0]
    )
