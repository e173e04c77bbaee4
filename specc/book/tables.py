"""Fields as numbers: rates and outputs on grids, for readers who have numpy and no specc.

Each quantity gets a table of its own (in each mode one), over those states and wired controls that
change it there, so that a field of many states needs no grid over all of them. Between the nodes a
reader goes on linearly. Nodes are added where the values bend, or are off, until that is near
enough or the table is as large as it may be; then the error is measured at other random places.
Values are in the spec's own units.
"""

import csv
import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.code import Code
from runtime.flow import Flow, flow_of, next_states, rates
from runtime.machine import evaluate
from runtime.program import Control, Kind, Program, State
from spec_schema.expressions.algebra import is_number
from specc.book.formulas import in_mode, reads

FINE: Final = 2e-3
"""What a table may be off by, of the largest value in it, as its own bending tells."""
LARGEST: Final = 50_000
"""Nodes of a table at most."""
FIRST: Final = 5
"""Nodes along an axis at first."""
ROUNDS: Final = 24
"""So often nodes are added at most."""
PROBES: Final = 4000
"""Random places at which the error is measured."""
NARROWEST: Final = 1e-4
"""Of an axis: narrower intervals are not halved, as at a jump."""
SEED: Final = 36
Part: TypeAlias = State | Control


@final
@dataclass(frozen=True, eq=False, slots=True)
class Sheet:
    """One table. nodes: (n1,), ... in the axes' units; values: (n1, ...) in `unit`.

    error, size: the largest difference from the program, and the largest value, at `PROBES`
    random places.
    """

    quantity: str
    setting: str
    unit: str
    axes: tuple[str, ...]
    nodes: tuple[Array, ...]
    values: Array
    error: float
    size: float


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
            is_range = not _is_discrete(part)
            register[:, names.index(part.name)] = (
                np.clip(inside, part.low, part.high) if is_range else points[:, k]
            )
        what, scale = self.wanted.what, self.wanted.scale
        if isinstance(what, Code):
            return np.asarray(evaluate([what], names, register)[:, 0] / scale)
        n, p = len(program.states), len(program.controls)
        read = next_states if flow.is_map else rates
        found = read(flow, register[:, :n], register[:, n : n + p])
        return np.asarray(found[:, names.index(what)] / scale)


def _is_discrete(part: Part) -> bool:
    return isinstance(part, State) and part.kind is Kind.DISCRETE


def _sheet(reader: _Reader, quantity: str, setting: str, moving: frozenset[str]) -> Sheet:
    parts = reader.axes(moving)
    nodes: tuple[Array, ...] = tuple(map(_first_nodes, parts))
    values = _tabulated(reader, parts, nodes)
    for _ in range(ROUNDS):
        finer = _finer(parts, nodes, values) or _finer_where_off(reader, parts, nodes, values)
        if finer is None:
            break
        nodes, values = finer, _tabulated(reader, parts, finer)
    error, size = _measured(reader, parts, nodes, values)
    names = tuple(part.name for part in parts)
    return Sheet(quantity, setting, reader.wanted.unit, names, nodes, values, error, size)


def _first_nodes(part: Part) -> Array:
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        return np.arange(float(len(part.values)))
    return np.linspace(part.low / part.unit.scale, part.high / part.unit.scale, FIRST)


def _tabulated(reader: _Reader, parts: tuple[Part, ...], nodes: tuple[Array, ...]) -> Array:
    mesh = np.meshgrid(*nodes, indexing="ij") if nodes else []
    points = np.stack([m.ravel() for m in mesh], axis=-1) if nodes else np.zeros((1, 0))
    return reader.at(parts, points).reshape([len(own) for own in nodes])


def _finer(
    parts: tuple[Part, ...], nodes: tuple[Array, ...], values: Array
) -> tuple[Array, ...] | None:
    """More nodes where the values bend, along the axis that bends most; None where enough."""
    allowed = FINE * float(np.nanmax(np.abs(values), initial=0.0)) / max(len(parts), 1)
    bends = [
        np.zeros(len(own)) if _is_discrete(part) else _bending(own, values, k)
        for k, (part, own) in enumerate(zip(parts, nodes, strict=True))
    ]
    for k in sorted(range(len(parts)), key=lambda k: -bends[k].max()):
        if bends[k].max() <= allowed:
            return None
        finer = (*nodes[:k], _split(nodes[k], bends[k] > allowed), *nodes[k + 1 :])
        is_more = len(finer[k]) > len(nodes[k])
        if is_more and np.prod([len(own) for own in finer]) <= LARGEST:
            return finer
    return None


def _finer_where_off(
    reader: _Reader, parts: tuple[Part, ...], nodes: tuple[Array, ...], values: Array
) -> tuple[Array, ...] | None:
    """More nodes around places where the table is off though it does not bend: beside a kink."""
    points, off, size = _probed(reader, parts, nodes, values, SEED)
    bad = points[off > FINE * size]
    finer = []
    for k, (part, own) in enumerate(zip(parts, nodes, strict=True)):
        if _is_discrete(part):
            finer.append(own)
            continue
        cells = np.clip(np.searchsorted(own, bad[:, k], side="right") - 1, 0, len(own) - 2)
        wide = np.diff(own) > NARROWEST * (own[-1] - own[0])
        hit = np.zeros(len(own) - 1, dtype=np.bool_)
        hit[cells] = True
        finer.append(np.sort(np.concatenate([own, 0.5 * (own[1:] + own[:-1])[hit & wide]])))
    counts = [len(own) for own in finer]
    is_more = counts != [len(own) for own in nodes]
    return tuple(finer) if is_more and np.prod(counts) <= LARGEST else None


def _bending(nodes: Array, values: Array, axis: int) -> Array:
    """At each inner node (n,) what is lost beside it by going straight: a quarter of its bend."""
    rows = np.moveaxis(values, axis, 0).reshape(len(nodes), -1)
    share = ((nodes[1:-1] - nodes[:-2]) / (nodes[2:] - nodes[:-2]))[:, np.newaxis]
    straight = (1.0 - share) * rows[:-2] + share * rows[2:]
    off = np.nan_to_num(np.abs(rows[1:-1] - straight), nan=0.0).max(axis=1)
    return np.concatenate([[0.0], off / 4.0, [0.0]])


def _split(nodes: Array, bent: Booleans) -> Array:
    """The nodes with a new one in the middle of each interval beside a bent one."""
    wide = np.diff(nodes) > NARROWEST * (nodes[-1] - nodes[0])
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    return np.sort(np.concatenate([nodes, middles[(bent[1:] | bent[:-1]) & wide]]))


def _measured(
    reader: _Reader, parts: tuple[Part, ...], nodes: tuple[Array, ...], values: Array
) -> tuple[float, float]:
    """The largest error and value at places that did not choose the nodes."""
    _, off, size = _probed(reader, parts, nodes, values, SEED + 1)
    return float(off.max(initial=0.0)), size


def _probed(
    reader: _Reader, parts: tuple[Part, ...], nodes: tuple[Array, ...], values: Array, seed: int
) -> tuple[Array, Array, float]:
    """Random places (N, d), how far the table is off there (N,), and the largest value seen."""
    chance = np.random.default_rng(seed)
    columns = [
        chance.integers(0, len(own), PROBES).astype(float)
        if _is_discrete(part)
        else chance.uniform(own[0], own[-1], PROBES)
        for part, own in zip(parts, nodes, strict=True)
    ]
    points = np.stack(columns, axis=-1) if columns else np.zeros((1, 0))
    exact = reader.at(parts, points)
    off = np.nan_to_num(np.abs(interpolated(nodes, values, points) - exact), nan=0.0)
    return points, off, float(np.nan_to_num(np.abs(exact), nan=0.0).max())


def interpolated(nodes: tuple[Array, ...], values: Array, points: Array) -> Array:
    """The table (N,) at points (N, d), linear between its nodes, as `read_table` has it."""
    found = np.broadcast_to(values, (len(points), *values.shape))
    rows = np.arange(len(points))
    for k, own in enumerate(nodes):
        place = np.interp(points[:, k], own, np.arange(len(own)))
        i = np.minimum(place.astype(int), len(own) - 2)
        share = (place - i).reshape(-1, *[1] * (found.ndim - 2))
        found = found[rows, i] + share * (found[rows, i + 1] - found[rows, i])
    return found


def as_npz(sheets: Iterable[Sheet]) -> bytes:
    """All tables: `SETTING/QUANTITY`, with its `/axes`, `/unit`, and the nodes of each `/AXIS`."""
    arrays: dict[str, Array] = {}
    for sheet in sheets:
        key = f"{sheet.setting}/{sheet.quantity}"
        arrays[key] = sheet.values
        arrays[f"{key}/axes"] = np.array(sheet.axes, dtype=np.str_)
        arrays[f"{key}/unit"] = np.array(sheet.unit)
        for name, nodes in zip(sheet.axes, sheet.nodes, strict=True):
            arrays[f"{key}/{name}"] = nodes
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def as_csv(sheets: tuple[Sheet, ...]) -> bytes:
    """The same as one table: a row for each node; what does not matter to a quantity is empty."""
    names = tuple(dict.fromkeys(name for sheet in sheets for name in sheet.axes))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["setting", "quantity", "unit", *names, "value"])
    for sheet in sheets:
        head = [sheet.setting, sheet.quantity, sheet.unit]
        places = [sheet.axes.index(name) if name in sheet.axes else -1 for name in names]
        written = [[f"{node:.9g}" for node in own] for own in sheet.nodes]
        for index, value in zip(np.ndindex(sheet.values.shape), sheet.values.flat, strict=True):
            row = ["" if k < 0 else written[k][index[k]] for k in places]
            writer.writerow([*head, *row, f"{value:.9g}"])
    return text.getvalue().encode()
