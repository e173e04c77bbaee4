"""Modes: conditions as signed numbers, rates told apart by the mode, guards, doubts."""

import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from compiler.check import check
from compiler.compile_file import compile_file
from compiler.guard_sign import signed
from runtime.flow import Source, flow_of, rates
from runtime.machine import evaluate as run
from runtime.program import Guard, Program
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from tests.compiler.conftest import Compile

SPECS = Path(__file__).parents[2] / "specs"

BOUNCE = """
specc: 1
kind: behavior
name: bounce
state:
  h: {unit: m, domain: [-1, 9], role: both, relates: {agent: ball, environment: floor}}
  v: {unit: m/s, domain: [-20, 20], role: both, relates: {agent: ball, environment: floor}}
  in: {kind: discrete, values: [flight], role: both, relates: {agent: ball, environment: floor}}
constants:
  g: {value: 9.81, unit: m/s^2}
  keep: {value: 0.5, unit: "1"}
field:
  modes:
    of: in_
    each:
      flight:
        formula: {h: v, v: -g}
        leave:
          - {when: h <= 0 and v < 0, to: flight, reset: {v: -keep * v}}
""".replace("  in: {kind", "  in_: {kind")


@pytest.fixture(scope="module")
def patrol() -> Program:
    return compile_file(SPECS / "patrol.yaml", lambda _what, _done, _of: None).program


def condition(rng: random.Random, depth: int) -> str:
    """A condition over x and v as a person might write it."""
    if depth == 0:
        left, right = rng.sample(["x", "v", "x + 2*v", "0.5", "x*v", "-1"], 2)
        return f"{left} {rng.choice(['<', '<=', '>', '>='])} {right}"
    match rng.randrange(3):
        case 0:
            return f"not ({condition(rng, depth - 1)})"
        case n:
            word = "and" if n == 1 else "or"
            return f"({condition(rng, depth - 1)}) {word} ({condition(rng, depth - 1)})"


@given(st.integers(), st.integers(0, 4), st.floats(-3, 3), st.floats(-3, 3))
def test_a_signed_condition_is_positive_where_it_holds_and_negative_where_it_does_not(
    seed: int, depth: int, x: float, v: float
) -> None:
    text = condition(random.Random(seed), depth)  # noqa: S311  no secret: a reproducible text
    found = signed(parse(text), ())
    assert found is not None

    value = evaluate(found, {"x": x, "v": v})

    assume(value != 0.0)
    assert (value > 0.0) == bool(evaluate(parse(text), {"x": x, "v": v})), text


@pytest.mark.parametrize(
    "text", ["x", "x == 1", "x >= 1 and v", "not (x == 1)", "where(x > 0, 1, 0)"]
)
def test_what_is_no_comparison_has_no_sign(text: str) -> None:
    assert signed(parse(text), ()) is None


def test_each_mode_has_its_own_rates_through_the_tables(patrol: Program) -> None:
    rng = np.random.default_rng(1)
    x = rng.uniform([-2, -1, 0], [2, 1, 0], (64, 3))
    x[32:, 2] = 1.0
    low, high = np.array([(control.low, control.high) for control in patrol.controls]).T
    u = rng.uniform(low, high, (64, 4))

    found = rates(flow_of(patrol, Source.TABLES), x, u)

    wanted = np.where(x[:, 2] == 0, 2 * (u[:, 2] - x[:, 1]), 2 * (-u[:, 3] - x[:, 1]))
    # The table's tolerance is 1e-6 of the largest rate.
    np.testing.assert_allclose(found[:, 0], x[:, 1], atol=2e-6)
    np.testing.assert_allclose(found[:, 1], wanted, atol=5e-6)
    np.testing.assert_array_equal(found[:, 2], 0.0)


def test_guards_open_at_the_turning_points_and_reset_the_velocity(patrol: Program) -> None:
    register = {"x": 1.6, "v": 0.3, "x1": 1.5, "x2": -1.5, "v1": 0.5, "v2": 0.4}
    names, values = tuple(register), np.array([list(register.values())])
    turn, back = patrol.field.guards

    def value(guard: Guard) -> float:
        return float(run([guard.condition], names, values)[0, 0])

    assert (turn.mode, turn.target, back.mode, back.target) == (0, 1, 1, 0)
    assert value(turn) == pytest.approx(0.1)
    assert value(back) == pytest.approx(-3.1)
    assert [name for name, _ in turn.resets] == ["v"]
    assert run([code for _, code in turn.resets], names, values)[0, 0] == -0.4


def test_the_mode_has_no_rate_and_is_no_axis_of_a_table(patrol: Program) -> None:
    assert patrol.field.mode == "going"
    assert patrol.field.driven == ("x", "v")
    assert patrol.driven == (0, 1)
    assert {axis.name for table in patrol.field.tables for axis in table.axes} == {"v"}


def test_a_mode_may_follow_itself_where_something_jumps(compiled: Compile) -> None:
    found = compiled(BOUNCE)

    [guard] = found.program.field.guards
    assert (guard.mode, guard.target) == (0, 0)
    assert not found.warnings


def test_modes_may_stay_code(compiled: Compile) -> None:
    field = compiled(BOUNCE + "table: {keep: code}\n").program.field

    assert not field.tables
    assert field.formula is not None
    assert [code.text for code in field.formula] == ["v", "g neg"]


@pytest.mark.parametrize("name", ["patrol", "patrol_turning"])
def test_the_patrols_raise_no_doubts(name: str) -> None:
    assert check(SPECS / f"{name}.yaml") == ()


def test_what_only_a_way_reads_is_not_unused(compiled: Compile) -> None:
    warnings = compiled(BOUNCE).warnings

    assert not [found for found in warnings if found.code == "S223"]
