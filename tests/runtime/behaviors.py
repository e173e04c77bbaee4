"""Programs written by hand: the runtime's tests need no compiler."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.interpolation import tabulate
from runtime.program import Control, Field, Kind, Origin, Output, Program, Role, State, Term, Unit
from runtime.table import Axis, Method

ONE = Unit("1", 1.0)
NOWHERE = "spec.yaml:1:1"


def state(name: str, low: float, high: float) -> State:
    """A continuous state that is sensed and driven."""
    return State(
        name=name,
        unit=ONE,
        low=low,
        high=high,
        role=Role.BOTH,
        kind=Kind.CONTINUOUS,
        hold=0.5 * (low + high),
        closure=None,
        values=(),
        relates=("agent", "environment"),
        about="",
        origin=NOWHERE,
    )


def control(name: str, low: float, high: float, default: float) -> Control:
    return Control(name, ONE, low, high, default, "", NOWHERE)


def formula_program(
    states: tuple[State, ...],
    formula: dict[str, str],
    controls: tuple[Control, ...] = (),
    outputs: dict[str, str] | None = None,
    every: float = 0.0,
) -> Program:
    """A behavior with a formula, or with a step map where `every` is positive."""
    return Program(
        name="behavior",
        about="",
        states=states,
        controls=controls,
        constants=(),
        outputs=tuple(
            Output(name, ONE, Code(text), "", NOWHERE) for name, text in (outputs or {}).items()
        ),
        field=Field(
            driven=tuple(formula),
            form="step" if every else "formula",
            every=every,
            tables=(),
            terms=(),
            bounds=(),
            formula=tuple(map(Code, formula.values())),
            origin=NOWHERE,
        ),
        fidelity=None,
        bindings=(),
        judge_when=None,
        realizes=(),
        feasibility=None,
        source=Origin("spec.yaml", "name: behavior\n", "0" * 64),
    )


def van_der_pol(reach: float = 6.0) -> Program:
    """x'' = mu (1 - x²) x' - x (van der Pol 1926)."""
    return formula_program(
        (state("x", -reach, reach), state("v", -reach, reach)),
        {"x": "v", "v": "mu 1 x 2 pow sub mul v mul x sub"},
        controls=(control("mu", 0.0, 5.0, 1.0),),
        outputs={"energy": "x 2 pow v 2 pow add 2 div"},
    )


def tabulated(
    program: Program,
    values: Callable[..., Array],
    axes: tuple[Axis, ...],
    method: Method,
    coefficient: str = "1",
) -> Program:
    """The program with one table for all driven states: values(*grids) gives (..., m)."""
    nodes = [axis.low + axis.step * np.arange(axis.count) for axis in axes]
    table = tabulate(values(*np.meshgrid(*nodes, indexing="ij")), axes, method)
    terms = tuple(
        Term(component, Code(coefficient), 0, component)
        for component in range(len(program.field.driven))
    )
    return replace(program, field=replace(program.field, tables=(table,), terms=terms))


def tabulated_van_der_pol(method: Method = Method.CUBIC, count: int = 33) -> Program:
    """Van der Pol at mu = 1; a cubic table loses nothing of a cubic polynomial."""
    axes = tuple(Axis(name, -4.0, 4.0, count, periodic=False) for name in ("x", "v"))
    return tabulated(
        van_der_pol(4.0),
        lambda x, v: np.stack([v, (1 - x**2) * v - x], axis=-1),
        axes,
        method,
    )
