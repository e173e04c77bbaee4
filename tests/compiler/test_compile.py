"""Whole compilations: bounds that hold, bytes that repeat, code and tables that agree."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from compiler.compile import Compiled
from compiler.compile_file import compile_file
from compiler.dump import dump
from runtime.flow import Source, flow_of, next_states, rates
from runtime.program import Kind, Program
from spec_schema.diagnostics import SpecError

ROOT = Path(__file__).parents[2]
SPECS = sorted((ROOT / "specs").glob("*.yaml"))
Compile = Callable[[str], Compiled]
Behavior = Callable[..., str]


def dense(program: Program, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Random states and controls all over the domain."""
    rng = np.random.default_rng(99)
    x = rng.uniform(
        [s.low for s in program.states],
        [s.high for s in program.states],
        (count, len(program.states)),
    )
    for i, state in enumerate(program.states):
        if state.kind is Kind.DISCRETE:
            x[:, i] = np.round(x[:, i])
    u = rng.uniform(
        [c.low for c in program.controls],
        [c.high for c in program.controls],
        (count, len(program.controls)),
    )
    return x, u


def errors(program: Program, count: int) -> np.ndarray:
    """The largest differences of tables and formula, per driven state."""
    x, u = dense(program, count)
    run = next_states if program.field.is_map else rates
    apart = run(flow_of(program, Source.TABLES), x, u) - run(flow_of(program, Source.FORMULA), x, u)
    return np.abs(apart).max(axis=0)[list(program.driven)]


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_spec_of_the_library_compiles_within_its_bounds(path: Path) -> None:
    program = compile_file(path, lambda _what, _done, _of: None, allow_code=True).program

    assert program.field.bounds or "keep: code" in path.read_text(encoding="utf-8")
    assert all(bound.measured <= bound.tolerance for bound in program.field.bounds)
    if program.field.bounds and program.field.formula is not None:
        bounds = [bound.measured for bound in program.field.bounds]
        assert np.all(errors(program, 50_000) <= bounds)


@pytest.mark.parametrize(
    ("rates_of", "axes"),
    [
        ({"x": "sin(3*x*y)", "y": "-x*exp(y)"}, 2),
        ({"x": "tanh(2*x + y*z)", "y": "z*cos(x)", "z": "-z"}, 3),
        ({"x": "tanh(a*x + b*y)", "y": "-y"}, 4),
    ],
    ids=["2-D", "3-D", "4-D"],
)
def test_bounds_hold_on_ten_times_as_many_random_points_as_nodes(
    compiled: Compile, behavior: Behavior, rates_of: dict[str, str], axes: int
) -> None:
    program = compiled(
        behavior(rates_of, ("a", "b") if axes == 4 else (), "table: {tolerance: {x: 1e-3}}\n")
    ).program
    widest = max(program.field.tables, key=lambda table: len(table.axes))

    assert len(widest.axes) == axes
    found = errors(program, 10 * widest.coefficients[..., 0].size)
    assert np.all(found <= [bound.measured for bound in program.field.bounds])


def test_a_discrete_state_is_never_interpolated(compiled: Compile) -> None:
    text = """specc: 1
kind: behavior
name: gears
state:
  x: {unit: "1", domain: [-1, 1], role: both, relates: {agent: a, environment: b}}
  gear:
    kind: discrete
    values: [low, high]
    role: sensed
    relates: {agent: a, environment: b}
field:
  formula: {x: "where(gear == 'high', 5 * sin(x), -cos(x))"}
"""
    program = compiled(text).program
    x = np.array([[0.3, 0.0], [0.3, 1.0]])

    found = rates(flow_of(program, Source.TABLES), x, np.zeros((2, 0)))

    np.testing.assert_allclose(found[:, 0], [-np.cos(0.3), 5 * np.sin(0.3)], atol=1e-5)


def test_a_field_kept_as_code_has_no_tables_and_the_same_rates(
    compiled: Compile, behavior: Behavior
) -> None:
    program = compiled(behavior({"x": "sin(x)"}, (), "table: {keep: code}\n")).program
    x = np.linspace(-1.0, 1.0, 11)[:, None]

    assert program.field.tables == ()
    found = rates(flow_of(program, Source.TABLES), x, np.zeros((11, 0)))
    np.testing.assert_allclose(found, np.sin(x), rtol=1e-15)


def test_units_are_turned_into_si_throughout(compiled: Compile) -> None:
    text = """specc: 1
kind: behavior
name: turning
state:
  a: {unit: deg, domain: [-90, 0.5*180], role: both, relates: {agent: a, environment: b}}
control:
  pace: {unit: deg/s, domain: [0, 90], default: 30}
constants:
  k: {value: 60, unit: 1/min}
field:
  formula: {a: "pace - k * sin(a)"}
fidelity: {tolerance: {a: 1}, horizon: 500 ms}
"""
    program = compiled(text).program

    assert program.states[0].high == pytest.approx(np.pi / 2)
    assert program.controls[0].default == pytest.approx(np.pi / 6)
    assert program.constants[0].value == pytest.approx(1.0)
    assert program.fidelity is not None
    assert program.fidelity.tolerance["a"] == pytest.approx(np.pi / 180)
    assert program.fidelity.horizon == 0.5
    found = rates(flow_of(program), np.array([[np.pi / 2]]), np.array([[np.pi / 6]]))
    assert found[0, 0] == pytest.approx(np.pi / 6 - 1.0, abs=1e-5)


def test_a_project_is_not_compiled(compiled: Compile) -> None:
    with pytest.raises(SpecError, match="S200"):
        compiled("specc: 1\nkind: project\nname: p\n")


def test_the_dump_of_a_program_is_stable(
    expect: Callable[[Path, str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    for name in ("van_der_pol", "husky_drive", "line_steps", "corridor", "patrol"):
        program = compile_file(
            Path(f"specs/{name}.yaml"), lambda _what, _done, _of: None, allow_code=True
        ).program

        expect(ROOT / "tests" / "golden" / "programs" / f"{name}.txt", dump(program))


def test_several_texts_in_a_log_may_mean_one_value(compiled: Compile) -> None:
    text = """specc: 1
kind: behavior
name: lefts
state:
  x: {unit: "1", domain: [-1, 1], role: both, relates: {agent: a, environment: b}}
  turn:
    kind: discrete
    values: [none, left]
    role: sensed
    relates: {agent: a, environment: b}
field:
  formula: {x: "where(turn == 'left', -x, x)"}
trace:
  x: x
  turn: {path: action, values: {Straight: none, Slight-Left: left, Sharp-Left: left}}
"""
    [_, turn] = compiled(text).program.bindings

    assert turn.values == (("Straight", 0), ("Slight-Left", 1), ("Sharp-Left", 1))
