"""The flow of a program: its rates everywhere in the domain, ready for the machine.

x: states (..., n); u: controls (..., p); both in SI, angles not wrapped.
"""

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans, frozen
from runtime.code import Code
from runtime.gates import gates_of, no_gates
from runtime.kernels.blocks import LARGEST
from runtime.kernels.events import Gates
from runtime.kernels.tape import Tape
from runtime.machine import run_tape
from runtime.program import Kind, Program, State
from runtime.tape import Sum, pack

DIFFERENCE: Final = 2.0**-19
"""Step of the Jacobian's differences, in widths of the domain: truncation (its square) and rounding
(machine epsilon over it) are both about 1e-10 there."""

STENCILS: Final = np.array([[0.5, -2.0, 1.5], [-0.5, 0.0, 0.5], [-1.5, 2.0, -0.5]])
"""Weights of three values for the slope at the last, the middle, the first of them."""


@final
class Source(StrEnum):
    """Where the rates of the driven states come from."""

    TABLES = "tables"
    FORMULA = "formula"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Flow:
    """A program, packed: register (r,) = states (n), controls (p), constants.

    domain: (2, r) lowest and highest value of each entry; for periodic and discrete states and for
    constants all finite numbers. defaults: (r,). moves: (n,) whether a state has a rate at all.
    is_map: the tape gives next states, not rates. gates: how the mode switches, if it does.
    """

    program: Program
    tape: Tape
    domain: Array
    defaults: Array
    moves: Booleans
    is_map: bool
    gates: Gates

    @property
    def switches(self) -> bool:
        """Whether there are modes that switch."""
        return len(self.gates.ways) > 0


def flow_of(program: Program, source: Source = Source.TABLES) -> Flow:
    """The flow through the program's tables, or through its own formula.

    A field that was kept as code has no terms: its formula serves for both.

    Raises:
        ValueError: the field has no formula, and `source` asks for it.
    """
    results = tuple(rate_of(program, index, source) for index in range(len(program.states)))
    return Flow(
        program=program,
        tape=pack(results, program.register, program.field.tables, program.field.coordinates),
        domain=_domain(program),
        defaults=frozen(
            [
                *(state.hold for state in program.states),
                *(control.default for control in program.controls),
                *(constant.value for constant in program.constants),
            ]
        ),
        moves=np.array([_moves(program, state) for state in program.states], dtype=np.bool_),
        is_map=program.field.is_map,
        gates=gates_of(program),
    )


def in_one_mode(flow: Flow) -> Flow:
    """The same flow without its guards: each trajectory stays in the mode in which it starts."""
    return replace(flow, gates=no_gates())


def rates(flow: Flow, x: Array, u: Array) -> Array:
    """The rates (..., n) of all states; NaN outside the domain of the states and controls.

    Sensed-only states move by their closure, or not at all; discrete ones not at all.

    Raises:
        ValueError: the program is a step map, which has no rates.
    """
    if flow.is_map:
        raise ValueError(f"'{flow.program.name}' is a step map: it has next states, not rates")
    return _results(flow, x, u)


def next_states(flow: Flow, x: Array, u: Array) -> Array:
    """The states (..., n) one step of the map later; NaN where x or u is outside the domain.

    Raises:
        ValueError: the program is no step map.
    """
    if not flow.is_map:
        raise ValueError(f"'{flow.program.name}' is no step map: it has rates, not next states")
    return _results(flow, x, u)


def jacobian(flow: Flow, x: Array, u: Array) -> Array:
    """The derivative (..., n, n) of rate i (of a map: next state i) by state j.

    Central differences, one-sided ones of second order at an edge of the domain; relative
    accuracy about 1e-9 where the field is smooth on the scale of its domain. Columns of discrete
    states are 0. NaN outside the domain.
    """
    n = len(flow.program.states)
    shape = np.broadcast_shapes(x.shape[:-1], u.shape[:-1])
    x = np.broadcast_to(x, (*shape, n))
    columns = [
        np.zeros((*shape, n))
        if state.kind is Kind.DISCRETE
        else _difference(flow, x, u, j, (state.high - state.low) * DIFFERENCE)
        for j, state in enumerate(flow.program.states)
    ]
    return np.stack(columns, axis=-1)


def registers(flow: Flow, x: Array, u: Array) -> Array:
    """The register (..., r) at states x and controls u, with the program's constants."""
    n, p = len(flow.program.states), len(flow.program.controls)
    shape = np.broadcast_shapes(x.shape[:-1], u.shape[:-1])
    register = np.empty((*shape, flow.defaults.size))
    register[..., :n] = x
    register[..., n : n + p] = u
    register[..., n + p :] = flow.defaults[n + p :]
    return register


def _results(flow: Flow, x: Array, u: Array) -> Array:
    register = registers(flow, x, u)
    results = run_tape(flow.tape, register)
    # One comparison for both edges that is false for NaN, too.
    inside = np.all((flow.domain[0] <= register) & (register <= flow.domain[1]), axis=-1)
    return np.where(inside[..., np.newaxis], results, np.nan)


def rate_of(program: Program, index: int, source: Source) -> Code | Sum:
    """What gives the rate (of a map: the next value) of state `index`.

    Raises:
        ValueError: the field has no formula, and `source` asks for it.
    """
    state = program.states[index]
    field = program.field
    still = Code(state.name) if field.is_map else Code("0")
    if not _moves(program, state):
        return still
    if state.name not in field.driven:
        return state.closure or still
    component = field.driven.index(state.name)
    if source is Source.TABLES and field.terms:
        terms = [term for term in field.terms if term.component == component]
        return Sum(tuple((term.coefficient, term.table, term.column) for term in terms))
    if field.formula is None:
        raise ValueError(f"the field of '{program.name}' ({field.form}) has no formula")
    return field.formula[component]


def _moves(program: Program, state: State) -> bool:
    if state.kind is Kind.DISCRETE and not program.field.is_map:
        return False
    return state.name in program.field.driven or state.closure is not None


def _domain(program: Program) -> Array:
    limited = [
        *((s.low, s.high) if s.kind is Kind.CONTINUOUS else None for s in program.states),
        *((control.low, control.high) for control in program.controls),
        *(None for _ in program.constants),
    ]
    edges = [edge or (-LARGEST, LARGEST) for edge in limited]
    return frozen([[low for low, _ in edges], [high for _, high in edges]])


def _difference(flow: Flow, x: Array, u: Array, j: int, step: float) -> Array:
    """The derivative (..., n) of all rates by state j, from three points `step` apart."""
    lacks_low, lacks_high = (
        x[..., j] - step < flow.domain[0, j],
        x[..., j] + step > flow.domain[1, j],
    )
    shift = np.where(lacks_low, 1, np.where(lacks_high, -1, 0))
    points = np.repeat(x[..., np.newaxis, :], 3, axis=-2)
    points[..., j] += step * (shift[..., np.newaxis] + np.array([-1, 0, 1]))
    values = _results(flow, points, u[..., np.newaxis, :])
    slopes: Array = np.sum(STENCILS[shift + 1][..., np.newaxis] * values, axis=-2) / step
    return slopes
