"""Fields as numbers: rates and outputs on grids, for readers who have numpy and no specc.

Each quantity gets a table of its own, over those states (and controls that are wired) that change
it, so that a field of many states needs no grid over all of them. Between the nodes a reader goes
on linearly. The grid is refined along the axis that bends most until that is near enough, or the
table is as large as it may be; then the error is measured at random places, against the program.
Values are in the spec's own units.
"""

import csv
import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.code import ARITY, Code
from runtime.flow import Flow, flow_of, next_states, rates
from runtime.machine import evaluate
from runtime.program import Control, Kind, Program, State

FINE: Final = 1e-3
"""What a table may be off by, of the largest value in it, as its own bending tells."""
LARGEST: Final = 60_000
"""Nodes of a table at most."""
FIRST: Final = 5
"""Nodes along an axis at first."""
PROBES: Final = 4000
"""Random places at which the error is measured."""
SEED: Final = 36


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
    """A table for each driven state and each output of a behavior.

    controls: at what values (SI) they are held; wired: those that move, and are axes instead.
    """
    flow = flow_of(program)
    moving = frozenset(wired)
    word = "next" if program.field.is_map else "rate"
    found = []
    for state in program.states:
        if state.name in program.field.driven:
            unit = state.unit.text if program.field.is_map else _per_second(state.unit.text)
            reader = _Reader(flow, state.name, dict(controls), state.unit.scale)
            found.append(_sheet(reader, f"{word} {state.name}", setting, unit, moving))
    for output in program.outputs:
        reader = _Reader(flow, output.code, dict(controls), output.unit.scale)
        found.append(_sheet(reader, f"output {output.name}", setting, output.unit.text, moving))
    return tuple(found)


def _per_second(unit: str) -> str:
    return "1/s" if unit in {"", "1"} else f"{unit}/s"


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Reader:
    """A rate (the name of a state) or an output (code) of a flow, in the users' units."""

    flow: Flow
    what: str | Code
    controls: dict[str, float]
    scale: float

    def reads(self, moving: frozenset[str]) -> tuple[State | Control, ...]:
        """The states and moving controls that it depends on."""
        program = self.flow.program
        parts: tuple[State | Control, ...] = (*program.states, *program.controls)
        used = self._used()
        return tuple(p for p in parts if p.name in used and (_is_state(p) or p.name in moving))

    def _used(self) -> set[str]:
        program = self.flow.program
        if isinstance(self.what, Code):
            return _names(self.what)
        place = program.field.driven.index(self.what)
        used: set[str] = set()
        inside = {c.name: _names(c.code) for c in program.field.coordinates}
        for term in program.field.terms:
            if term.component == place:
                used |= _names(term.coefficient)
                table = program.field.tables[term.table] if term.table >= 0 else None
                for axis in table.axes if table is not None else ():
                    used |= inside.get(axis.name, {axis.name})
        if not program.field.terms and program.field.formula is not None:
            used |= _names(program.field.formula[place])
        return used

    def at(self, parts: tuple[State | Control, ...], points: Array) -> Array:
        """The values (N,) at points (N, d), in the units of the parts."""
        program, flow = self.flow.program, self.flow
        register = np.repeat(flow.defaults[np.newaxis], len(points), axis=0)
        names = program.register
        for name, value in self.controls.items():
            register[:, names.index(name)] = value
        for k, part in enumerate(parts):
            register[:, names.index(part.name)] = points[:, k] * part.unit.scale
        if isinstance(self.what, Code):
            return np.asarray(evaluate([self.what], names, register)[:, 0] / self.scale)
        n, p = len(program.states), len(program.controls)
        read = next_states if flow.is_map else rates
        found = read(flow, register[:, :n], register[:, n : n + p])
        return np.asarray(found[:, names.index(self.what)] / self.scale)


def _is_state(part: State | Control) -> bool:
    return isinstance(part, State)


def _names(code: Code) -> set[str]:
    return {token for token in code.tokens if token not in ARITY}


def _is_discrete(part: State | Control) -> bool:
    return isinstance(part, State) and part.kind is Kind.DISCRETE


def _sheet(
    reader: _Reader, quantity: str, setting: str, unit: str, moving: frozenset[str]
) -> Sheet:
    parts = tuple(p for p in reader.reads(moving) if not _is_discrete(p) or len(_labels(p)) > 1)
    counts = [len(_labels(p)) if _is_discrete(p) else FIRST for p in parts]
    nodes, values = _tabulated(reader, parts, counts)
    while (finer := _finer(parts, counts, values)) is not None:
        counts = finer
        nodes, values = _tabulated(reader, parts, counts)
    error, size = _measured(reader, parts, nodes, values)
    names = tuple(part.name for part in parts)
    return Sheet(quantity, setting, unit, names, nodes, values, error, size)


def _labels(part: State | Control) -> tuple[str, ...]:
    return part.values if isinstance(part, State) else ()


def _tabulated(
    reader: _Reader, parts: tuple[State | Control, ...], counts: list[int]
) -> tuple[tuple[Array, ...], Array]:
    nodes = tuple(
        np.arange(float(count))
        if _is_discrete(part)
        else np.linspace(part.low / part.unit.scale, part.high / part.unit.scale, count)
        for part, count in zip(parts, counts, strict=True)
    )
    # The rounding of a unit may step over the edge of a domain by a last digit.
    mesh = np.meshgrid(*nodes, indexing="ij") if nodes else []
    points = np.stack([m.ravel() for m in mesh], axis=-1) if nodes else np.zeros((1, 0))
    return nodes, reader.at(parts, points).reshape(counts)


def _finer(
    parts: tuple[State | Control, ...], counts: list[int], values: Array
) -> list[int] | None:
    """Twice as many nodes along the axis that bends most; None where it bends too little."""
    size = float(np.nanmax(np.abs(values), initial=0.0))
    bends = [
        0.0 if _is_discrete(part) else float(np.nanmax(np.abs(np.diff(values, 2, axis=k)))) / 8.0
        for k, part in enumerate(parts)
    ]
    if sum(bends) <= FINE * size or not bends:
        return None
    axis = int(np.argmax(bends))
    finer = [2 * count - 1 if k == axis else count for k, count in enumerate(counts)]
    return finer if np.prod(finer) <= LARGEST else None


def _measured(
    reader: _Reader,
    parts: tuple[State | Control, ...],
    nodes: tuple[Array, ...],
    values: Array,
) -> tuple[float, float]:
    chance = np.random.default_rng(SEED)
    columns = [
        chance.integers(0, len(own), PROBES).astype(float)
        if _is_discrete(part)
        else chance.uniform(own[0], own[-1], PROBES)
        for part, own in zip(parts, nodes, strict=True)
    ]
    points = np.stack(columns, axis=-1) if columns else np.zeros((1, 0))
    exact = reader.at(parts, points)
    read = interpolated(nodes, values, points)
    known = np.isfinite(exact) & np.isfinite(read)
    if not known.any():
        return 0.0, 0.0
    return float(np.abs(read - exact)[known].max()), float(np.abs(exact[known]).max())


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
