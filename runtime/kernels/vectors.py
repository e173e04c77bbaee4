"""What numba cannot say: memory on the stack, calls by address, and weighted sums in vectors.

`contract` unrolls its sums into vector instructions while a kernel is compiled. Each sum has one
fixed order and explicit fused multiply-adds, so that a point gives the same bits wherever it
stands in a batch; a compiler that vectorises sums by itself needs licence to reorder them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias, final

import numba
import numba.extending
from llvmlite import ir  # type: ignore[import-untyped]  # no stubs
from numba.core import cgutils

Value: TypeAlias = Any  # of the untyped llvmlite
Vectors: TypeAlias = list[Value]

NUMBA: Any = numba  # its own types do not cover what is used of it here
types: Any = NUMBA.types
carray: Any = NUMBA.carray
codegen: Any = cgutils

F64 = ir.DoubleType()
I64 = ir.IntType(64)
WIDTH = 4
"""Numbers in a vector."""
BLOCK = 64
"""Points that are looked up together; their weights stay in the nearest cache."""
LAST, PLANE, OUTER = 0, 4, 8
"""First row of the weights of the last axis, the last but one, and all axes before (products)."""


def _intrinsic(function: Callable[..., Any]) -> Callable[..., Any]:
    """Make a function that kernels can call; numba asks it for types and instructions."""
    made: Callable[..., Any] = NUMBA.extending.intrinsic(prefer_literal=True)(function)
    return made


@_intrinsic
def stack_memory(_typing: Any, count: Any) -> Any:
    """A pointer to `count` numbers on the stack of the kernel; `count` is a constant."""
    size = count.literal_value

    def generate(_context: Any, builder: Any, _signature: Any, _arguments: Any) -> Value:
        return codegen.alloca_once(builder, F64, size=size)

    return types.CPointer(types.float64)(count), generate


@_intrinsic
def fma(_typing: Any, a: Any, b: Any, c: Any) -> Any:
    """Multiply a and b and add c, rounded once."""

    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Value:
        return _Emitter(builder).fma(*arguments)

    return types.float64(a, b, c), generate


@_intrinsic
def call(_typing: Any, address: Any, arguments: Any) -> Any:
    """Call the function at `address` with a tuple of numbers and arrays (by their first element).

    The machine code of the function stays where it is: kernels that call each other by name are
    copied into one another, and compiled as often.
    """

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Value:
        passed = []
        for i, kind in enumerate(signature.args[1]):
            value = builder.extract_value(values[1], i)
            if isinstance(kind, types.Array):
                passed.append(context.make_array(kind)(context, builder, value).data)
            else:
                passed.append(context.cast(builder, value, kind, types.int64))
        function = ir.FunctionType(ir.VoidType(), [value.type for value in passed])
        builder.call(builder.inttoptr(values[0], function.as_pointer()), passed)
        return context.get_dummy_value()

    return types.void(address, arguments), generate


@_intrinsic
def contract(_typing: Any, cubic: Any, d: Any, block: Any) -> Any:
    """For each lane, write the sums of weights times coefficients, one per column.

    block: the fields of `_Block`, as a tuple of integers and of arrays.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Value:
        parts = []
        for i, kind in enumerate(signature.args[2]):
            value = builder.extract_value(arguments[2], i)
            if isinstance(kind, types.Array):
                parts.append(context.make_array(kind)(context, builder, value).data)
            else:
                parts.append(context.cast(builder, value, kind, types.int64))
        taps = {True: 4, False: 2}
        emitted = _Block(_Emitter(builder), *parts)
        flat = builder.icmp_signed("<=", arguments[1], I64(2))
        _branch(
            builder,
            arguments[0],
            lambda is_cubic: _branch(
                builder, flat, lambda is_flat: _by_columns(emitted, taps[is_cubic], flat=is_flat)
            ),
        )
        return context.get_dummy_value()

    return types.void(cubic, d, block), generate


@final
@dataclass(frozen=True, slots=True)
class _Emitter:
    """Instructions on vectors, written through `builder`."""

    builder: Any

    def at(self, pointer: Value, index: Value | int) -> Value:
        """The address of a number."""
        position = I64(index) if isinstance(index, int) else index
        return self.builder.gep(pointer, [position], source_etype=F64)

    def number(self, pointer: Value, index: Value | int) -> Value:
        """A number in memory."""
        return self.builder.load(self.at(pointer, index), typ=F64)

    def vector(self, pointer: Value, width: int) -> Value:
        """`width` neighbouring numbers in memory."""
        kind = ir.VectorType(F64, width)
        place = self.builder.bitcast(pointer, kind.as_pointer())
        return self.builder.load(place, align=8, typ=kind)

    def spread(self, number: Value, width: int) -> Value:
        """A vector of copies of a number."""
        kind = ir.VectorType(F64, width)
        first = self.builder.insert_element(ir.Constant(kind, ir.Undefined), number, I64(0))
        return self.pick(first, first, [0] * width)

    def pick(self, a: Value, b: Value, positions: list[int]) -> Value:
        """The vector of the entries at `positions` in a followed by b."""
        kind = ir.VectorType(ir.IntType(32), len(positions))
        return self.builder.shuffle_vector(a, b, ir.Constant(kind, positions))

    def fma(self, a: Value, b: Value, c: Value) -> Value:
        """Multiply a and b and add c, numbers or vectors, rounded once."""
        kind = a.type
        name = "llvm.fma.f64" if kind == F64 else f"llvm.fma.v{kind.count}f64"
        function = codegen.get_or_insert_function(
            self.builder.module, ir.FunctionType(kind, [kind] * 3), name
        )
        return self.builder.call(function, [a, b, c])

    def weighted(self, weight: Value, row: Vectors, onto: Vectors | None) -> Vectors:
        """`weight` times a row, added `onto` another if there is one."""
        weights = [self.spread(weight, vector.type.count) for vector in row]
        if onto is None:
            return [self.builder.fmul(w, v) for w, v in zip(weights, row, strict=True)]
        return [self.fma(w, v, t) for w, v, t in zip(weights, row, onto, strict=True)]


@final
@dataclass(frozen=True, slots=True)
class _Block:
    """A block of lanes.

    bases: per lane, the index (as a number) of the first tap's first column in `coefficients`.
    weights: (rows, BLOCK), see LAST, PLANE, OUTER. row_stride: between taps of the last axis but
    one. outer: how many products of outer weights; shifts: the distance (as a number) of each.
    """

    emit: _Emitter
    m: Value
    coefficients: Value
    bases: Value
    weights: Value
    row_stride: Value
    outer: Value
    shifts: Value
    lanes: Value
    out: Value
    start: Value
    column_stride: Value
    lane_stride: Value


@final
@dataclass(frozen=True, slots=True)
class _Taps:
    """The taps of the last axis around one point, `columns` of them side by side.

    vectors: (offset, width) of the loads that cover them; picks: per tap, the vectors (two, or the
    same one twice) and the positions therein of its columns.
    """

    count: int
    columns: int

    @property
    def is_wide(self) -> bool:
        """Whether each tap is a whole vector; the taps are then `m` apart."""
        return self.columns == WIDTH

    @property
    def vectors(self) -> list[tuple[int, int]]:
        """Where vectors are loaded and how wide they are."""
        size = self.count * self.columns
        if size % WIDTH == 0 or size < WIDTH:
            return [(start, min(WIDTH, size)) for start in range(0, size, WIDTH)]
        return [(0, WIDTH), (size - WIDTH, WIDTH)]  # two taps of three: the middle is read twice


def _branch(builder: Any, condition: Value, emit_case: Callable[[bool], None]) -> None:
    with builder.if_else(condition) as (then, otherwise):
        with then:
            emit_case(True)  # noqa: FBT003 - the case
        with otherwise:
            emit_case(False)  # noqa: FBT003 - as above


def _by_columns(block: _Block, taps: int, *, flat: bool, columns: int = 1) -> None:
    """Choose the code for the number of columns; more than WIDTH of them go in several rounds."""
    builder = block.emit.builder
    if columns == WIDTH:
        last = builder.sub(block.m, I64(WIDTH))
        rounds = builder.sdiv(builder.add(block.m, I64(WIDTH - 1)), I64(WIDTH))
        with codegen.for_range(builder, rounds) as loop:
            first = builder.mul(loop.index, I64(WIDTH))
            first = builder.select(builder.icmp_signed("<", first, last), first, last)
            _over_lanes(block, _Taps(taps, WIDTH), first, flat=flat)
        return
    with builder.if_else(builder.icmp_signed("==", block.m, I64(columns))) as (then, otherwise):
        with then:
            _over_lanes(block, _Taps(taps, columns), I64(0), flat=flat)
        with otherwise:
            _by_columns(block, taps, flat=flat, columns=columns + 1)


def _over_lanes(block: _Block, taps: _Taps, column: Value, *, flat: bool) -> None:
    """Write the columns from `column` on, for all lanes."""
    emit, builder = block.emit, block.emit.builder
    with codegen.for_range(builder, block.lanes) as loop:
        base = builder.fptosi(emit.number(block.bases, loop.index), I64)
        corner = emit.at(block.coefficients, builder.add(base, column))
        weights = emit.at(block.weights, loop.index)
        sums = (_plane if flat else _outer)(block, taps, corner, weights)
        values = _last(block, taps, sums, weights)
        along = builder.mul(loop.index, block.lane_stride)
        across = builder.mul(column, block.column_stride)
        place = emit.at(block.out, builder.add(block.start, builder.add(along, across)))
        for k in range(taps.columns):
            shift = builder.mul(block.column_stride, I64(k))
            builder.store(builder.extract_element(values, I64(k)), emit.at(place, shift))


def _outer(block: _Block, taps: _Taps, corner: Value, weights: Value) -> Vectors:
    """Sum over all axes but the last."""
    emit, builder = block.emit, block.emit.builder
    slots = []
    for _, width in _loads(block, taps):
        nothing = ir.Constant(ir.VectorType(F64, width), None)
        slots.append(codegen.alloca_once(builder, nothing.type))
        builder.store(nothing, slots[-1])
    with codegen.for_range(builder, block.outer) as loop:
        shift = builder.fptosi(emit.number(block.shifts, loop.index), I64)
        row = builder.mul(builder.add(loop.index, I64(OUTER)), I64(BLOCK))
        plane = _plane(block, taps, emit.at(corner, shift), weights)
        before = [builder.load(slot) for slot in slots]
        after = emit.weighted(emit.number(weights, row), plane, before)
        for slot, vector in zip(slots, after, strict=True):
            builder.store(vector, slot)
    return [builder.load(slot) for slot in slots]


def _plane(block: _Block, taps: _Taps, corner: Value, weights: Value) -> Vectors:
    """Sum over the last axis but one."""
    emit, builder = block.emit, block.emit.builder
    total: Vectors | None = None
    for tap in range(taps.count):
        place = emit.at(corner, builder.mul(block.row_stride, I64(tap)))
        row = [emit.vector(emit.at(place, at), width) for at, width in _loads(block, taps)]
        total = emit.weighted(emit.number(weights, (PLANE + tap) * BLOCK), row, total)
    return total or []


def _loads(block: _Block, taps: _Taps) -> list[tuple[Value | int, int]]:
    if taps.is_wide:
        builder = block.emit.builder
        return [(builder.mul(block.m, I64(tap)), WIDTH) for tap in range(taps.count)]
    return list(taps.vectors)


def _last(block: _Block, taps: _Taps, sums: Vectors, weights: Value) -> Value:
    """Sum over the last axis: a vector with the columns first."""
    emit = block.emit
    total: Vectors | None = None
    for tap in range(taps.count):
        values = [sums[tap] if taps.is_wide else _pick(emit, taps, sums, tap)]
        total = emit.weighted(emit.number(weights, (LAST + tap) * BLOCK), values, total)
    return (total or [])[0]


def _pick(emit: _Emitter, taps: _Taps, sums: Vectors, tap: int) -> Value:
    """The columns of a tap, which may stand in two neighbouring vectors."""
    columns = range(tap * taps.columns, (tap + 1) * taps.columns)
    for i, (at, width) in enumerate(taps.vectors):
        if at <= columns[0] and columns[-1] < at + width:
            return emit.pick(sums[i], sums[i], [k - at for k in columns])
    i = columns[0] // WIDTH
    return emit.pick(sums[i], sums[i + 1], [k - i * WIDTH for k in columns])
