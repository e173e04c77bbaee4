"""What a program's rates, and their derivatives, may be over boxes of its states and controls.

m: axes, the states that a box spans; N: boxes; d: controls that are intervals. Everything else
stands still. The bounds hold for real arithmetic; see `runtime.intervals` and
`runtime.table_bounds`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.code import Code
from runtime.flow import Source, rate_of
from runtime.intervals import Interval, add, exactly, multiply, subtract
from runtime.jet_machine import run_over_boxes
from runtime.jets import Jet, constant, jet_sum, unbounded
from runtime.program import Kind, Program, State
from runtime.table_bounds import Columns, column_jets, columns_of, combined, held_at
from runtime.tape import Sum

Register: TypeAlias = dict[str, Jet]

CODE_WORK: Final = 4
"""What an operation of code costs beside one of a table, roughly."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Block:
    """Columns of one table, weighed for each rate that reads it.

    columns: first one per axis (its weighed sum), then those whose weights are uncertain.
    spread: (m, k) how far the weight of each of the latter may be from what was taken.
    drift: (m, k, d) bounds of the derivatives of these weights by the controls that are intervals.
    arguments: names of the register or of coordinates, one per axis of the table that moves.
    """

    columns: Columns
    spread: Array
    drift: Interval
    arguments: tuple[str, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Enclosure:
    """A field to be bounded over boxes of the states `axes`.

    register: all that does not span a box. controls: those that are intervals. blocks: the parts
    through tables, codes: the others, None where there is none. coordinates: codes of what tables
    stand over beside states. periods: of the axes, 0 for those that do not wrap. work: the cost of
    one box, roughly.
    """

    axes: tuple[str, ...]
    register: Register
    controls: tuple[str, ...]
    blocks: tuple[Block, ...]
    codes: tuple[Code | None, ...]
    coordinates: tuple[tuple[str, Code], ...]
    periods: tuple[float, ...]
    is_map: bool
    work: int


def enclosure_of(
    program: Program,
    axes: tuple[str, ...],
    x: Array,
    controls: Array,
    source: Source = Source.TABLES,
) -> Enclosure:
    """The field over boxes of `axes`, other states at `x` (n,), controls from (2, p) low to high.

    Raises:
        ValueError: the field has no formula, and `source` asks for it.
    """
    register = _register(program, axes, x, controls)
    intervals = tuple(
        control.name
        for control, low, high in zip(program.controls, *controls, strict=True)
        if low < high
    )
    index = {state.name: i for i, state in enumerate(program.states)}
    results = [rate_of(program, index[name], source) for name in axes]
    tables = sorted({t for r in results if isinstance(r, Sum) for _, t, _ in r.parts if t >= 0})
    blocks = tuple(_block(program, results, table, register, intervals) for table in tables)
    used = {name for block in blocks for name in block.arguments}
    codes = tuple(_code(result) for result in results)
    coordinates = [(c.name, c.code) for c in program.field.coordinates if c.name in used]
    tokens = sum(len(c.tokens) for c in (*codes, *(c for _, c in coordinates)) if c is not None)
    size = sum(_work(block) for block in blocks)
    return Enclosure(
        axes=axes,
        register=register,
        controls=intervals,
        blocks=blocks,
        codes=codes,
        coordinates=tuple(coordinates),
        periods=tuple(_period(program.states[index[name]]) for name in axes),
        is_map=program.field.is_map,
        work=CODE_WORK * tokens + size,
    )


def changes(field: Enclosure, low: Array, high: Array, *, coarse: bool = False) -> Interval:
    """Bounds (N, m) of the rates over boxes low to high (N, m).

    Of a map: of how far a step goes, the short way round where an axis is periodic; NaN where the
    field does not exist. coarse: many times faster through tables, and wider.
    """
    jets = _jets(field, low, high, (), coarse=coarse)
    lower, upper = np.empty(low.shape), np.empty(low.shape)
    for i, jet in enumerate(jets):
        lower[:, i], upper[:, i] = jet.value.low, jet.value.high
    return Interval(lower, upper)


def slopes(field: Enclosure, low: Array, high: Array) -> Interval:
    """Bounds (N, m, m) of the derivatives of `changes`, the last axis by what.

    All numbers where the field may jump in the box, or not exist somewhere in it.
    """
    return _gradients(field, low, high, field.axes)


def drifts(field: Enclosure, low: Array, high: Array) -> Interval:
    """Bounds (N, m, d) of the derivatives of `changes` by the controls that are intervals."""
    return _gradients(field, low, high, field.controls)


def _gradients(field: Enclosure, low: Array, high: Array, moves: tuple[str, ...]) -> Interval:
    """Bounds of the derivatives of `changes` by what `moves`, along the last axis."""
    jets = _jets(field, low, high, moves, coarse=False)
    m, n, d = len(field.axes), len(low), len(moves)
    lower, upper = np.zeros((n, m, d)), np.zeros((n, m, d))
    for i, jet in enumerate(jets):
        if jet.slopes is None:
            entry = exactly(np.zeros((d, n)))
        else:
            entry = Interval(
                *(np.broadcast_to(e, (d, n)) for e in (jet.slopes.low, jet.slopes.high))
            )
        lost = (
            ~np.broadcast_to(jet.sure, n) | np.isnan(jet.value.low) | ~_is_one_turn(field, i, jet)
        )
        entry = unbounded(entry, lost | np.isnan(entry.low))
        lower[:, i, :], upper[:, i, :] = entry.low.T, entry.high.T
    return Interval(lower, upper)


def _jets(
    field: Enclosure, low: Array, high: Array, moves: tuple[str, ...], *, coarse: bool
) -> list[Jet]:
    """The change along each axis over boxes, with its derivatives by what `moves`, if anything."""
    n, m = low.shape
    register = dict(field.register)
    for j, name in enumerate(field.axes):
        register[name] = constant(Interval(low[:, j], high[:, j]))
    register |= _moving(register, moves)
    names = [name for name, _ in field.coordinates]
    extra = run_over_boxes([code for _, code in field.coordinates], register)
    register |= dict(zip(names, extra, strict=True))
    totals = _code_jets(field, register)
    drifting = bool(moves) and moves == field.controls
    for block in field.blocks:
        parts = _block_jets(block, register, m, n, drifting=drifting, coarse=coarse)
        for i, jet in enumerate(parts):
            before = totals[i]
            totals[i] = jet if before is None else jet_sum(before, jet)
    known = [constant(exactly(0.0)) if jet is None else jet for jet in totals]
    return [_displacement(field, j, jet, register) for j, jet in enumerate(known)]


def _moving(register: Register, moves: tuple[str, ...]) -> Register:
    """The entries that move, each with its own direction."""
    units = np.eye(len(moves))[:, :, None]
    return {
        name: replace(register[name], slopes=exactly(unit))
        for name, unit in zip(moves, units, strict=True)
    }


def _code_jets(field: Enclosure, register: Mapping[str, Jet]) -> list[Jet | None]:
    codes = [code for code in field.codes if code is not None]
    found = iter(run_over_boxes(codes, register))
    return [None if code is None else next(found) for code in field.codes]


def _displacement(field: Enclosure, j: int, jet: Jet, register: Mapping[str, Jet]) -> Jet:
    """For a map: how far the step goes along axis j, by the nearest number of whole turns."""
    if not field.is_map:
        return jet
    here = register[field.axes[j]]
    ahead = jet.slopes
    if here.slopes is not None:
        ahead = subtract(ahead or exactly(0.0), here.slopes)
    value = subtract(jet.value, here.value)
    period = field.periods[j]
    if period:
        with np.errstate(invalid="ignore"):
            turns = np.nan_to_num(np.round(0.5 * (value.low + value.high) / period))
        value = subtract(value, multiply(exactly(turns), exactly(period)))
        around = (value.low <= -period) | (value.high >= period)
        value = Interval(
            *(np.where(around, w, v) for w, v in ((-np.inf, value.low), (np.inf, value.high)))
        )
    return Jet(value, ahead, jet.sure)


def _is_one_turn(field: Enclosure, j: int, jet: Jet) -> Booleans:
    """Where a map's step is known to be of one number of whole turns."""
    return np.asarray(np.isfinite(jet.value.low) | (not (field.is_map and field.periods[j])))


def _register(program: Program, axes: tuple[str, ...], x: Array, controls: Array) -> Register:
    held = {
        state.name: constant(exactly(float(x[i])))
        for i, state in enumerate(program.states)
        if state.name not in axes
    }
    for i, control in enumerate(program.controls):
        held[control.name] = constant(
            Interval(np.asarray(controls[0, i]), np.asarray(controls[1, i]))
        )
    return held | {c.name: constant(exactly(c.value)) for c in program.constants}


def _code(result: Code | Sum) -> Code | None:
    """What of a rate is code: all of it, or the terms without a table."""
    if isinstance(result, Code):
        return result
    loose = [code.text for code, table, _ in result.parts if table < 0]
    return Code(" ".join([*loose, *("add" for _ in loose[1:])])) if loose else None


def _block(
    program: Program,
    results: list[Code | Sum],
    table: int,
    register: Register,
    intervals: tuple[str, ...],
) -> Block:
    columns = columns_of(program.field.tables[table])
    moving: list[str] = []
    for axis in program.field.tables[table].axes:
        jet = register.get(axis.name)
        if jet is not None and jet.value.low == jet.value.high:
            columns = held_at(columns, len(moving), float(jet.value.low))
        else:
            moving.append(axis.name)
    known = {**register, **_moving(register, intervals)}
    factors, drift = _factors(results, table, len(columns.error), known, len(intervals))
    width = factors.high - factors.low
    size = np.maximum(np.abs(factors.low), np.abs(factors.high))
    spread = np.where(width > 0.0, 0.5 * width + 2.0**-50 * size, 0.0)
    sums = combined(columns, factors)
    uncertain = np.flatnonzero(np.any(spread > 0.0, axis=0))
    both = Columns(
        columns.axes,
        columns.method,
        np.concatenate([sums.coefficients, columns.coefficients[..., uncertain]], axis=-1),
        np.concatenate([sums.error, columns.error[uncertain]]),
    )
    ahead = Interval(drift.low[:, uncertain], drift.high[:, uncertain])
    return Block(both, spread[:, uncertain], ahead, tuple(moving))


def _factors(
    results: list[Code | Sum], table: int, columns: int, register: Mapping[str, Jet], d: int
) -> tuple[Interval, Interval]:
    """The weight (m, k) of each column of a table in each rate, and its derivatives (m, k, d)."""
    shape = (len(results), columns)
    low, high = np.zeros(shape), np.zeros(shape)
    falls, rises = np.zeros((*shape, d)), np.zeros((*shape, d))
    for i, result in enumerate(results):
        if not isinstance(result, Sum):
            continue
        for code, of, column in result.parts:
            if of == table:
                (jet,) = run_over_boxes([code], register)
                total = add(Interval(low[i, column], high[i, column]), jet.value)
                first = low[i, column] == 0.0 == high[i, column]
                chosen_ = jet.value if first else total
                low[i, column], high[i, column] = chosen_.low, chosen_.high
                if jet.slopes is not None:
                    own = unbounded(jet.slopes, ~jet.sure | np.isnan(jet.slopes.low))
                    own = Interval(*(np.broadcast_to(e, (d, 1))[:, 0] for e in (own.low, own.high)))
                    ahead = add(Interval(falls[i, column], rises[i, column]), own)
                    falls[i, column], rises[i, column] = ahead.low, ahead.high
    return Interval(low, high), Interval(falls, rises)


def _block_jets(
    block: Block, register: Mapping[str, Jet], m: int, n: int, *, drifting: bool, coarse: bool
) -> list[Jet]:
    """The part of each rate that a table gives. drifting: the controls move, not the axes."""
    arguments = [register[name] for name in block.arguments]
    jets = column_jets(block.columns, arguments, n, coarse=coarse)
    sums, others = jets[:m], jets[m:]
    for i in range(m):
        for k, jet in enumerate(others):
            radius = float(block.spread[i, k])
            if radius > 0.0:
                weight = Interval(np.asarray(-radius), np.asarray(radius))
                ahead = None if jet.slopes is None else multiply(weight, jet.slopes)
                sums[i] = jet_sum(sums[i], Jet(multiply(weight, jet.value), ahead, jet.sure))
            if radius > 0.0 and drifting:
                rise = Interval(block.drift.low[i, k][:, None], block.drift.high[i, k][:, None])
                by_weight = multiply(rise, jet.value)
                sums[i] = jet_sum(sums[i], Jet(exactly(0.0), by_weight, jet.sure))
    return sums


def _work(block: Block) -> int:
    shape = block.columns.coefficients.shape
    return int(4 ** (len(shape) - 1) * shape[-1])


def _period(state: State) -> float:
    return state.high - state.low if state.kind is Kind.PERIODIC else 0.0
