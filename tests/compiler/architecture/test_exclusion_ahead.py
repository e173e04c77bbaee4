"""What a behavior's ticks look up, and where they look: bounds against the machine itself."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.ahead import within_a_period
from compiler.architecture.exclusion.answer import Proof, Undecided
from compiler.architecture.exclusion.decide import decide
from compiler.architecture.exclusion.ranges import rates_over
from compiler.architecture.exclusion.table_ranges import columns_over
from compiler.architecture.signals import box_of
from runtime.arrays import Array
from runtime.code import Code
from runtime.flow import flow_of
from runtime.interpolation import tabulate
from runtime.machine import run_tape
from runtime.program import Coordinate, Guard, Program, Role, Term
from runtime.table import Axis, Method, Table
from tests.compiler.architecture.exclusions import INPUTS, STEP, Case, N, acting, behavior, wired
from tests.runtime.behaviors import control, formula_program, state, tabulated

PARTS = ("first", "second")
ESTIMATE = 8.0
"""Times the largest coefficient: what was once taken for a bound of a table."""


def table_of(rng: np.random.Generator, d: int, method: Method) -> Table:
    axes = tuple(
        Axis(f"x{i}", -1.0 + 0.3 * i, 1.0 + 0.2 * i, 4 + i, bool(rng.random() < 0.3))
        for i in range(d)
    )
    signs = rng.choice([-1.0, 1.0], (*(axis.count for axis in axes), 1))
    return tabulate(signs * rng.uniform(0.5, 1.0, signs.shape), axes, method)


def program_of(table: Table) -> Program:
    """A behavior whose first state has this table as its rate."""
    states = tuple(state(axis.name, axis.low, axis.high) for axis in table.axes)
    made = formula_program(states, {table.axes[0].name: "0"})
    return replace(
        made, field=replace(made.field, tables=(table,), terms=(Term(0, Code("1"), 0, 0),))
    )


def looked_up(program: Program, points: Array) -> Array:
    """The rates (N, n) of a behavior's tape, which goes on beyond the table's edges."""
    flow = flow_of(program)
    register = np.tile(flow.defaults, (len(points), 1))
    register[:, : len(program.states)] = points
    results: Array = run_tape(flow.tape, register)
    return results


@settings(max_examples=40)
@given(
    st.integers(0, 10**6),
    st.integers(1, 3),
    st.sampled_from(list(Method)),
    st.sampled_from([0.0, 0.3, 1.0, 3.0]),
)
@example(2, 1, Method.CUBIC, 3.0)
def test_what_a_table_is_looked_up_at_lies_in_its_bounds_far_beyond_its_edges_too(
    seed: int, d: int, method: Method, beyond: float
) -> None:
    rng = np.random.default_rng(seed)
    table = table_of(rng, d, method)
    low = np.array([axis.low - beyond * axis.step * rng.random() for axis in table.axes])
    high = np.array([axis.high + beyond * axis.step * rng.random() for axis in table.axes])
    some = rng.random(d) < 0.5
    low = np.where(some, low + (high - low) * rng.random(d), low)
    box = {a.name: (float(u), float(v)) for a, u, v in zip(table.axes, low, high, strict=True)}

    ((least, most),) = columns_over(table, box)

    points = low + rng.random((400, d)) * (high - low)
    points[:200] = np.where(rng.random((200, d)) < 0.5, low, high)
    values = looked_up(program_of(table), points)[:, 0]
    assert least <= values.min()
    assert values.max() <= most


@pytest.mark.parametrize(("d", "beyond"), [(1, 2.0), (2, 1.0)])
def test_beyond_its_edge_a_table_is_more_than_the_old_estimate(d: int, beyond: float) -> None:
    """Coefficients of turn about, as large as can be: their weights add up without their signs."""
    axes = tuple(Axis(f"x{i}", 0.0, 3.0, 4, periodic=False) for i in range(d))
    turns = (-1.0) ** np.arange(6)
    signs = turns if d == 1 else np.multiply.outer(turns, turns)
    table = Table(axes, Method.CUBIC, signs[..., None])
    points = np.full((1, d), 3.0 + beyond)

    value = float(abs(looked_up(program_of(table), points)[0, 0]))

    (ends,) = columns_over(table, {axis.name: (0.0, 3.0 + beyond) for axis in axes})
    assert value > ESTIMATE * float(np.abs(table.coefficients).max())
    assert ends[0] <= value <= ends[1]
    assert ends[1] <= value * 1.000001


def test_a_table_that_overshoots_its_values_between_them_is_bounded_closely() -> None:
    axis = Axis("x0", 0.0, 5.0, 6, periodic=False)
    table = tabulate(np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0])[:, None], (axis,), Method.CUBIC)

    ((least, most),) = columns_over(table, {"x0": (0.0, 5.0)})

    values = looked_up(program_of(table), np.linspace(0.0, 5.0, 2001)[:, None])
    assert values.max() > 1.1
    assert values.min() < -0.01
    assert least <= values.min()
    assert values.max() <= most < 1.25


def climbing(pace: float) -> Program:
    """What moves an own y by pace * y**3, in a table, as far as a table within [-1, 1] tells."""
    own = replace(state("y", -1.0, 1.0), role=Role.DRIVEN, hold=1.0)
    axis = Axis("y", -1.0, 1.0, 9, periodic=False)
    made = formula_program((*behavior().states[:2], own), {"y": "0"}, behavior().controls)
    return tabulated(made, lambda y: pace * y[..., None] ** 3, (axis,), Method.CUBIC)


def in_place(pace: float) -> Case:
    """A combined behavior that gives the y of a period on."""
    commands = {"x": ("y", "set-point")}
    both = N("both", climbing(pace), inputs=INPUTS, replaces=PARTS, commands=commands)
    return wired([acting("first"), acting("second"), both])


def test_one_whose_table_runs_away_within_a_period_proves_nothing() -> None:
    """8 times the largest coefficient is finite, but the state is infinite when the period ends."""
    runs_away = in_place(1000.0 / STEP)

    answer = decide(runs_away.question)

    assert runs_away.both_act({0: [0.5], 1: [0.5]}, 3) == [0, 1, 2]
    assert isinstance(answer, Undecided)
    assert "a period ahead of both" in answer.reason


def test_one_that_leaves_its_table_by_half_a_cell_still_acts_in_their_place() -> None:
    steady = in_place(0.08 / STEP)

    assert isinstance(decide(steady.question), Proof)
    assert not steady.both_act({0: [0.5], 1: [0.5]}, 3)


rates = st.sampled_from(["1", "y neg", "y 2 mul", "z", "y sin", "y z mul", "p", "y abs sqrt", "k"])


@settings(max_examples=50)
@given(rates, rates, st.sampled_from([0.01, 0.2, 0.7]), st.lists(st.floats(0, 1), min_size=5))
def test_no_stage_of_a_tick_leaves_the_box(
    y: str, z: str, period: float, at: Sequence[float]
) -> None:
    """Against the classical method of Runge and Kutta, worked out here once more."""
    own = [replace(state(name, -1.0, 1.0), role=Role.DRIVEN) for name in "yz"]
    program = formula_program((state("p", -1.0, 1.0), *own), {"y": y, "z": z}, (K,))
    program = replace(program, field=replace(program.field, driven=("y", "z")))
    start = box_of(program)

    box = within_a_period(program, start, period)

    if box is None:
        return
    register = flow_of(program).defaults.copy()
    for place, (name, share) in enumerate(zip(("p", "y", "z", "k"), at, strict=False)):
        low, high = start[name]
        register[place] = low + share * (high - low)
    for stage in _stages(program, register, period):
        for place, name in enumerate(("p", "y", "z")):
            assert box[name][0] <= stage[place] <= box[name][1]


K = control("k", 0.0, 2.0, 1.0)


def _stages(program: Program, register: Array, period: float) -> list[Array]:
    tape, h, seen = flow_of(program).tape, period / 8, []
    for _ in range(8):
        x, total = register.copy(), np.zeros(3)
        for weight, reach in ((1 / 6, 0.5), (1 / 3, 0.5), (1 / 3, 1.0), (1 / 6, 0.0)):
            slope = run_tape(tape, x[None])[0]
            slope[0] = 0.0
            total += weight * slope
            x[:3] = register[:3] + reach * h * slope
            seen.append(x.copy())
        register[:3] += h * total
    return [*seen, register]


def test_a_table_over_a_coordinate_is_bounded_where_the_coordinate_may_be() -> None:
    axis = Axis("away", -2.0, 2.0, 9, periodic=False)
    made = formula_program((state("y", -1.0, 1.0),), {"y": "0"}, (control("k", -1.0, 1.0, 0.0),))
    made = tabulated(made, lambda u: u[..., None] ** 2, (axis,), Method.CUBIC)
    away = Coordinate("away", Code("y k sub"), -2.0, 2.0, "")
    program = replace(made, field=replace(made.field, coordinates=(away,)))

    ends = rates_over(program, box_of(program))["y"]

    assert ends is not None
    assert ends[0] <= 0.0
    assert 4.0 <= ends[1] < 4.1


def test_where_a_state_jumps_to_is_in_the_box_and_so_is_how_far_it_goes_from_there() -> None:
    """y turns back at 1, jumps to -3, and moves by 2 in a period: no farther down than -5."""
    made = formula_program((state("y", -1.0, 1.0),), {"y": "y 0 ge 2 -2 where"})
    turns = Guard(0, 0, Code("y 1 sub"), (("y", Code("3 neg")),), "")
    program = replace(made, field=replace(made.field, guards=(turns,)))

    box, still = (within_a_period(each, box_of(each), 1.0) for each in (program, made))

    assert box is not None
    assert still is not None
    assert box["y"][0] <= -5.0
    assert box["y"][1] >= 3.0
    assert still["y"][0] > -5.0
