"""Fields as numbers: rates and outputs on grids, for readers who have numpy and no specc.

Each quantity gets a table of its own (in each mode one), over those states and wired controls that
change it there, so that a field of many states needs no grid over all of them. Between the nodes a
reader goes on linearly. Values are in the spec's own units.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.flow import Flow, flow_of, next_states, rates
from runtime.machine import evaluate
from runtime.program import Control, Kind, Program, State
from spec_schema.expressions.algebra import is_number
from specc.book.formulas import in_mode, reads
from specc.book.gridded import Axis, Grid, gridded

Part: TypeAlias = State | Control


@final
@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """One table. axes: by name, in their units; what the grid holds is in `unit`."""

    quantity: str
    setting: str
    unit: str
    axes: tuple[str, ...]
    grid: Grid


def sheets_of(
    program: Program, setting: str, controls: Mapping[str, float], wired: Iterable[str]
) -> tuple[Sheet, ...]:
    """A table for each driven state and each output of a behavior; one for each mode.

    controls: at what values (SI) they are held; wired: those that move, and are axes instead.
    """
    flow = flow_of(program)
    moving = frozenset(wired)
    word = "next" if program.field.is_map else "rate"
    found: list[Sheet] = []
    for state in program.states:
        if state.name in program.field.driven:
            unit = state.unit.text if program.field.is_map else per_second(state.unit.text)
            what = Wanted(f"{word} {state.name}", unit, state.unit.scale, state.name)
            found += _in_modes(flow, what, setting, controls, moving)
    for output in program.outputs:
        what = Wanted(f"output {output.name}", output.unit.text, output.unit.scale, output.code)
        found += _in_modes(flow, what, setting, controls, moving)
    return tuple(found)


def per_second(unit: str) -> str:
    """The unit of a rate: `m/s`, `(rad/s)/s`."""
    if unit in {"", "1"}:
        return "1/s"
    return f"({unit})/s" if "/" in unit else f"{unit}/s"


@final
@dataclass(frozen=True, slots=True)
class Wanted:
    """What is tabulated: the rate of the state of this name, or an output by its code."""

    quantity: str
    unit: str
    scale: float
    what: str | Code


def _in_modes(
    flow: Flow,
    wanted: Wanted,
    setting: str,
    controls: Mapping[str, float],
    moving: frozenset[str],
) -> list[Sheet]:
    """A table for each mode; one for all where the modes do not matter to it."""
    program = flow.program
    mode = program.field.mode
    values = next((s.values for s in program.states if s.name == mode), ())
    if mode not in _used(program, wanted.what, "", 0):
        values = ()
    readers = [
        _Reader(flow, wanted, {**controls, mode: float(k)}, _used(program, wanted.what, mode, k))
        for k in range(len(values))
    ] or [_Reader(flow, wanted, dict(controls), _used(program, wanted.what, "", 0))]
    ends = [f" in {value}" for value in values] or [""]
    return [
        _sheet(reader, f"{wanted.quantity}{end}", setting, moving)
        for reader, end in zip(readers, ends, strict=True)
    ]


def _used(program: Program, what: str | Code, mode: str, index: int) -> set[str]:
    """The names that a rate or an output depends on in one mode; an empty mode for all of them."""
    if isinstance(what, Code):
        return reads(in_mode(what, mode, index))
    place = program.field.driven.index(what)
    used: set[str] = set()
    inside = {c.name: reads(in_mode(c.code, mode, index)) for c in program.field.coordinates}
    for term in program.field.terms:
        coefficient = in_mode(term.coefficient, mode, index)
        if term.component != place or is_number(coefficient, 0.0):
            continue
        used |= reads(coefficient)
        axes = program.field.tables[term.table].axes if term.table >= 0 else ()
        used |= {name for axis in axes for name in inside.get(axis.name, {axis.name})}
    if not program.field.terms and program.field.formula is not None:
        used |= reads(in_mode(program.field.formula[place], mode, index))
    return used


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Reader:
    """A quantity of a flow at held values (SI), in the users' units; used: what it depends on."""

    flow: Flow
    wanted: Wanted
    held: dict[str, float]
    used: set[str]

    def axes(self, moving: frozenset[str]) -> tuple[Part, ...]:
        """The states and moving controls that it depends on."""
        program = self.flow.program
        names = {*(s.name for s in program.states if len(s.values) != 1), *moving}
        parts: tuple[Part, ...] = (*program.states, *program.controls)
        return tuple(p for p in parts if p.name in (names & self.used) - {program.field.mode})

    def at(self, parts: tuple[Part, ...], points: Array) -> Array:
        """The values (N,) at points (N, d), in the units of the parts."""
        program, flow = self.flow.program, self.flow
        register = np.repeat(flow.defaults[np.newaxis], len(points), axis=0)
        names = program.register
        for name, value in self.held.items():
            if name:
                register[:, names.index(name)] = value
        for k, part in enumerate(parts):
            inside = points[:, k] * part.unit.scale
            # The rounding of a unit may step over the edge of a domain by a last digit.
            register[:, names.index(part.name)] = (
                points[:, k] if _axis(part).is_discrete else np.clip(inside, part.low, part.high)
            )
        what, scale = self.wanted.what, self.wanted.scale
        if isinstance(what, Code):
            return np.asarray(evaluate([what], names, register)[:, 0] / scale)
        n, p = len(program.states), len(program.controls)
        read = next_states if flow.is_map else rates
        found = read(flow, register[:, :n], register[:, n : n + p])
        return np.asarray(found[:, names.index(what)] / scale)


def _sheet(reader: _Reader, quantity: str, setting: str, moving: frozenset[str]) -> Sheet:
    parts = reader.axes(moving)
    grid = gridded(lambda points: reader.at(parts, points), tuple(map(_axis, parts)))
    names = tuple(part.name for part in parts)
    return Sheet(quantity, setting, reader.wanted.unit, names, grid)


def _axis(part: Part) -> Axis:
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        return Axis(0.0, len(part.values) - 1.0, is_discrete=True)
    return Axis(part.low / part.unit.scale, part.high / part.unit.scale)
