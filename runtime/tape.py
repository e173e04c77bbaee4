"""Packing: from postfix code and tables to the flat arrays that the machine runs.

The machine works on *rows*, one number per lane each; an instruction is `(operation, target row,
operand rows)`. Register entries and literals need no instructions, equal subexpressions are
computed once, and a row is used again as soon as nothing reads it any more, so that a block of
lanes stays in the cache.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np
import numpy.typing as npt

from runtime.arrays import Array, Booleans, Integers, frozen
from runtime.code import ARITY, Code
from runtime.kernels import tape as numbers
from runtime.kernels.interpolate import block_address
from runtime.kernels.machine import machine_address
from runtime.kernels.tape import MOST_AXES, TABLE, Tape
from runtime.program import Coordinate
from runtime.table import Axis, Method, Table

MOST_TOKENS: Final = 200_000
"""More in one piece of code is refused: packing takes memory in proportion."""
OPERATIONS: Final = {name: getattr(numbers, name.upper()) for name in ARITY}

Value: TypeAlias = tuple[int, ...]


@final
@dataclass(frozen=True, slots=True)
class Sum:
    """The sum of `code * tables[table][column]` over the parts; 0 where there are none.

    A table of -1 stands for the constant 1.
    """

    parts: tuple[tuple[Code, int, int], ...]


def pack(
    results: Sequence[Code | Sum],
    names: tuple[str, ...],
    tables: Sequence[Table],
    coordinates: Sequence[Coordinate] = (),
) -> Tape:
    """The tape that computes `results` from a register with the entries `names`.

    Tables stand over entries of the register and over `coordinates`, which are worked out first.

    Raises:
        ValueError: a token is neither operation, number nor name, or the code does not leave
            exactly one value.
    """
    graph = _Graph(names)
    spots = {coordinate.name: graph.code(coordinate.code) for coordinate in coordinates}
    roots = [_root(graph, result) for result in results]
    layout = _Layout(graph, roots, tables, spots)
    return Tape(
        len(names),
        layout.rows,
        read_only_integers(np.reshape(layout.instructions, (-1, 5))),
        frozen(graph.literals),
        read_only_integers([layout.place[root] for root in roots]),
        *_packed_tables(tables, layout.axis_rows(tables)),
        machine_address(),
        block_address() if tables else 0,
    )


def check_code(code: Code, names: tuple[str, ...]) -> None:
    """Do nothing, if `code` can be run where `names` are known.

    Raises:
        ValueError: it cannot; the text says why.
    """
    _Graph(names).code(code)


def _root(graph: "_Graph", result: Code | Sum) -> int:
    match result:
        case Code():
            return graph.code(result)
        case Sum():
            return graph.sum(result)


@final
class _Graph:
    """Values by number, each made once: register entries, then whatever code asks for.

    A value is `(operation, operands...)`, `("literal" = -2, index)`, `("entry" = -1, index)` or
    `("column" = -3, table, column)`. Operands have smaller numbers than what is made of them.
    """

    ENTRY, LITERAL, COLUMN = -1, -2, -3

    def __init__(self, names: tuple[str, ...]) -> None:
        self.entries = {name: index for index, name in enumerate(names)}
        self.values: list[Value] = [(self.ENTRY, index) for index in range(len(names))]
        self.known = {value: number for number, value in enumerate(self.values)}
        self.literals: list[float] = []
        self.literal_places: dict[str, int] = {}

    def number(self, value: Value) -> int:
        if value not in self.known:
            self.known[value] = len(self.values)
            self.values.append(value)
        return self.known[value]

    def literal(self, value: float) -> int:
        # By its text, because 0.0 == -0.0 but they are not the same number.
        text = repr(value)
        if text not in self.literal_places:
            self.literal_places[text] = len(self.literals)
            self.literals.append(value)
        return self.number((self.LITERAL, self.literal_places[text]))

    def literal_at(self, number: int) -> float | None:
        kind, *rest = self.values[number]
        return self.literals[rest[0]] if kind == self.LITERAL else None

    def code(self, code: Code) -> int:
        stack: list[int] = []
        tokens = code.tokens
        if len(tokens) > MOST_TOKENS:
            raise ValueError(f"code has {len(tokens)} tokens, more than {MOST_TOKENS}")
        for token in tokens:
            if token in ARITY:
                arity = ARITY[token]
                if len(stack) < arity:
                    raise ValueError(f"'{token}' lacks an operand in the code '{_short(code)}'")
                operands = stack[-arity:]
                del stack[-arity:]
                stack.append(self.apply(token, operands))
            elif token in self.entries:
                stack.append(self.entries[token])
            else:
                stack.append(self.literal(_number(token, code)))
        if len(stack) != 1:
            raise ValueError(f"the code '{_short(code)}' leaves {len(stack)} values, not one")
        return stack[0]

    def apply(self, operation: str, operands: list[int]) -> int:
        if operation == "pow":
            exponent = self.literal_at(operands[1])
            if exponent in (1.0, 2.0, 3.0, 4.0):
                return self.power(operands[0], int(exponent))
        return self.number((OPERATIONS[operation], *operands))

    def power(self, base: int, exponent: int) -> int:
        """Small whole powers are products: faster, and the same on every machine."""
        if exponent == 1:
            return base
        half = self.power(base, exponent // 2)
        square = self.number((OPERATIONS["mul"], half, half))
        if exponent % 2 == 0:
            return square
        return self.number((OPERATIONS["mul"], square, base))

    def sum(self, result: Sum) -> int:
        total: int | None = None
        for code, table, column in result.parts:
            part = factor = self.code(code)
            if table >= 0:
                part = self.number((self.COLUMN, table, column))
                if self.literal_at(factor) != 1.0:
                    part = self.number((OPERATIONS["mul"], factor, part))
            total = part if total is None else self.number((OPERATIONS["add"], total, part))
        return self.literal(0.0) if total is None else total


@final
class _Layout:
    """Rows for the values that the roots need, and the instructions in order.

    First come the coordinates of the tables (`spots`: name and number), then the tables, then
    everything else.
    """

    def __init__(
        self,
        graph: _Graph,
        roots: list[int],
        tables: Sequence[Table],
        spots: Mapping[str, int],
    ) -> None:
        needed = _needed(graph, roots)
        used = sorted({graph.values[n][1] for n in needed if graph.values[n][0] == graph.COLUMN})
        places = [spots[axis.name] for t in used for axis in tables[t].axes if axis.name in spots]
        first = _needed(graph, places)
        then = [number for number in needed if number not in set(first)]
        self.spots = spots
        self.entries = graph.entries
        self.place: dict[int, int] = {}
        self.instructions: list[tuple[int, int, int, int, int]] = []
        self.rows = len(graph.entries) + len(graph.literals)
        self.first_column = self._columns(tables, used)
        self.kept = {*roots, *places}
        self.last_use = {o: n for n in [*first, *then] for o in _operands(graph, n)}
        self.free: list[int] = []
        self._give_fixed(graph, [*first, *then])
        self._give_computed(graph, first)
        self.instructions += [(TABLE, self.first_column[table], table, 0, 0) for table in used]
        self._give_computed(graph, then)

    def axis_rows(self, tables: Sequence[Table]) -> list[list[int]]:
        """The row of each axis of each table; 0 for an axis of a table that nothing reads."""
        return [[self._axis_row(axis) for axis in table.axes] for table in tables]

    def _axis_row(self, axis: Axis) -> int:
        if axis.name in self.entries:
            return self.entries[axis.name]
        return self.place.get(self.spots[axis.name], 0)

    def _columns(self, tables: Sequence[Table], used: list[int]) -> dict[int, int]:
        """The row of the first column of each table used."""
        columns = {}
        for table in used:
            columns[table] = self.rows
            self.rows += tables[table].coefficients.shape[-1]
        return columns

    def _give_fixed(self, graph: _Graph, needed: list[int]) -> None:
        for number in needed:
            kind, *rest = graph.values[number]
            if kind == graph.ENTRY:
                self.place[number] = rest[0]
            elif kind == graph.LITERAL:
                self.place[number] = len(graph.entries) + rest[0]
            elif kind == graph.COLUMN:
                self.place[number] = self.first_column[rest[0]] + rest[1]

    def _give_computed(self, graph: _Graph, needed: list[int]) -> None:
        for number in needed:
            if graph.values[number][0] < 0:
                continue
            # The target is taken before the operands are given back: no row is read and
            # written by one instruction, so its loop vectorises.
            target = self.free.pop() if self.free else self.rows
            self.rows = max(self.rows, target + 1)
            self.place[number] = target
            operands = _operands(graph, number)
            a, b, c = (*(self.place[operand] for operand in operands), 0, 0)[:3]
            self.instructions.append((graph.values[number][0], target, a, b, c))
            for operand in set(operands):
                done = self.last_use[operand] == number and operand not in self.kept
                if done and graph.values[operand][0] >= 0:
                    self.free.append(self.place[operand])


def _operands(graph: _Graph, number: int) -> tuple[int, ...]:
    value = graph.values[number]
    return value[1:] if value[0] >= 0 else ()


def _needed(graph: _Graph, roots: list[int]) -> list[int]:
    """The values that the roots are made of, in an order that makes operands first."""
    needed = set(roots)
    for number in range(len(graph.values) - 1, -1, -1):
        if number in needed:
            needed.update(_operands(graph, number))
    return sorted(needed)


def _number(token: str, code: Code) -> float:
    # float() also takes "nan", "1_0" and "infinity", which no printer of ours writes.
    if token[:1].isdigit() or token[:2] in {f"-{digit}" for digit in "0123456789"}:
        try:
            value = float(token)
        except ValueError:
            value = np.nan
        if "_" not in token and np.isfinite(value):
            return value
    raise ValueError(
        f"'{token[:40]}' in the code '{_short(code)}' is no operation, number or known name"
    )


def _short(code: Code) -> str:
    return code.text if len(code.text) <= 60 else f"{code.text[:57]}..."


def _packed_tables(
    tables: Sequence[Table], rows: Sequence[list[int]]
) -> tuple[Integers, Integers, Integers, Booleans, Array, Array, Array]:
    offsets = np.cumsum([0, *(table.coefficients.size for table in tables)])
    count = len(tables)
    shapes = np.zeros((count, 4), dtype=np.int64)
    axes, counts = (np.zeros((count, MOST_AXES), dtype=np.int64) for _ in range(2))
    periodic = np.zeros((count, MOST_AXES), dtype=np.bool_)
    lows, inverse_steps = (np.zeros((count, MOST_AXES)) for _ in range(2))
    for t, table in enumerate(tables):
        d = len(table.axes)
        cubic = table.method is Method.CUBIC
        shapes[t] = (cubic, d, table.coefficients.shape[-1], offsets[t])
        counts[t, :d] = table.coefficients.shape[:-1]
        axes[t, :d] = rows[t]
        periodic[t, :d] = [axis.periodic for axis in table.axes]
        lows[t, :d] = [axis.low for axis in table.axes]
        inverse_steps[t, :d] = [1.0 / axis.step for axis in table.axes]
    periodic.setflags(write=False)
    return (
        read_only_integers(shapes),
        read_only_integers(axes),
        read_only_integers(counts),
        periodic,
        read_only_view(lows),
        read_only_view(inverse_steps),
        _flat([table.coefficients for table in tables]),
    )


def _flat(coefficients: list[Array]) -> Array:
    """All coefficients in one array; a single table's are not copied (they may be a file's)."""
    if len(coefficients) == 1:
        return read_only_view(coefficients[0]).reshape(-1)
    if not coefficients:
        return frozen([])
    return read_only_view(np.concatenate([c.reshape(-1) for c in coefficients]))


def read_only_view(array: Array) -> Array:
    """The same numbers, not writeable through this view: the type that every kernel is given."""
    view = np.ascontiguousarray(array, dtype=np.float64).view(np.ndarray)
    view.setflags(write=False)
    return view


def read_only_integers(values: npt.ArrayLike) -> Integers:
    """A copy of `values` as the kernels are given integers."""
    array = np.array(values, dtype=np.int64)
    array.setflags(write=False)
    return array
