"""What numba cannot say: memory on the stack, and the weighted sum over a table's taps in vectors.

The loops here are unrolled into vector instructions while a kernel is compiled. Each sum has one
fixed order and explicit fused multiply-adds, so that a point gives the same bits wherever it
stands in a batch; a compiler's own vectorising of sums would need licence to reorder them.
"""

from dataclasses import dataclass
from typing import Any, final

from llvmlite import ir  # type: ignore[import-untyped]  # no stubs
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

F64 = ir.DoubleType()
I64 = ir.IntType(64)
WIDTH = 4
"""Numbers in a vector."""
BLOCK = 32
"""Points that are looked up together; their weights stay in the nearest cache."""
LAST, PLANE, OUTER = 0, 4, 8
"""First row of the weights of the last axis, the last but one, and all axes before (products)."""


@final
@dataclass(frozen=True, slots=True)
class _Emitter:
    """Instructions on vectors, written through `builder`."""

    builder: Any

    def at(self, pointer: Any, index: Any) -> Any:
        """The address of element `index`."""
        position = index if isinstance(index, ir.Value) else I64(index)
        return self.builder.gep(pointer, [position], source_etype=F64)

    def load(self, pointer: Any, width: int) -> Any:
        """`width` neighbouring numbers."""
        kind = ir.VectorType(F64, width)
        return self.builder.load(
            self.builder.bitcast(pointer, kind.as_pointer()), align=8, typ=kind
        )

    def row(self, pointer: Any, count: int) -> list[Any]:
        """`count` neighbouring numbers, as vectors."""
        return [
            self.load(self.at(pointer, start), min(WIDTH, count - start))
            for start in range(0, count, WIDTH)
        ]

    def spread(self, number: Any, width: int) -> Any:
        """A vector of copies of a number."""
        kind = ir.VectorType(F64, width)
        first = self.builder.insert_element(ir.Constant(kind, ir.Undefined), number, I64(0))
        zeros = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
        return self.builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), zeros)

    def fma(self, a: Any, b: Any, c: Any) -> Any:
        """a * b + c of numbers or vectors, rounded once."""
        kind = a.type
        name = "llvm.fma.f64" if kind == F64 else f"llvm.fma.v{kind.count}f64"
        function = cgutils.get_or_insert_function(
            self.builder.module, ir.FunctionType(kind, [kind] * 3), name
        )
        return self.builder.call(function, [a, b, c])

    def scaled(self, weight: Any, row: list[Any], onto: list[Any] | None) -> list[Any]:
        """`weight` times a row, added `onto` another if there is one."""
        weights = [self.spread(weight, v.type.count) for v in row]
        if onto is None:
            return [self.builder.fmul(w, v) for w, v in zip(weights, row, strict=True)]
        return [self.fma(w, v, t) for w, v, t in zip(weights, row, onto, strict=True)]


@intrinsic(prefer_literal=True)
def stack_memory(_typing: Any, count: Any) -> Any:
    """A pointer to `count` numbers on the stack of the kernel; `count` is a constant."""
    size = count.literal_value

    def generate(_context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        return cgutils.alloca_once(builder, F64, size=size)

    return types.CPointer(types.float64)(count), generate


@intrinsic
def fma(_typing: Any, a: Any, b: Any, c: Any) -> Any:
    """a * b + c, rounded once."""

    def generate(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return _Emitter(builder).fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


@intrinsic
def contract(
    _typing: Any,
    cubic: Any,
    m: Any,
    d: Any,
    coefficients: Any,
    bases: Any,
    row_stride: Any,
    outer_count: Any,
    outer_offsets: Any,
    weights: Any,
    lanes: Any,
    out: Any,
    start: Any,
    column_stride: Any,
    lane_stride: Any,
) -> Any:
    """Write the sums of weights times coefficients of all lanes and columns to `out`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kinds = signature.args

        def data(i: int) -> Any:
            return context.make_array(kinds[i])(context, builder, arguments[i]).data

        def index(i: int) -> Any:
            return context.cast(builder, arguments[i], kinds[i], types.int64)

        block = _Block(
            _Emitter(builder), index(1), data(3), data(4), index(5), index(6), data(7), data(8),
            index(9), data(10), index(11), index(12), index(13),
        )
        with builder.if_else(arguments[0]) as (then, otherwise):
            with then:
                block.depths(4, index(2))
            with otherwise:
                block.depths(2, index(2))
        return context.get_dummy_value()

    arguments = (
        cubic, m, d, coefficients, bases, row_stride,
        outer_count, outer_offsets, weights, lanes, out, start, column_stride, lane_stride,
    )
    return types.void(*arguments), generate


@final
@dataclass(frozen=True, slots=True)
class _Block:
    emit: _Emitter
    m: Any
    coefficients: Any
    bases: Any
    row_stride: Any
    outer_count: Any
    outer_offsets: Any
    weights: Any
    lanes: Any
    out: Any
    start: Any
    column_stride: Any
    lane_stride: Any

    def depths(self, taps, d):
        self._choose(d, [1, 2, 3], lambda depth: self.columns(taps, depth))

    def columns(self, taps, depth):
        def go(columns):
            if columns < WIDTH:
                self.sums(taps, depth, columns, I64(0))
            else:
                b = self.emit.builder
                last = b.sub(self.m, I64(WIDTH))
                chunks = b.sdiv(b.add(self.m, I64(WIDTH - 1)), I64(WIDTH))
                with cgutils.for_range(b, chunks) as loop:
                    k = b.mul(loop.index, I64(WIDTH))
                    k = b.select(b.icmp_signed("<", k, last), k, last)
                    self.sums(taps, depth, columns, k)
        self._choose(self.m, [1, 2, 3, 4], go)

    def _choose(self, value, options, emit_option):
        b = self.emit.builder
        if len(options) == 1:
            emit_option(options[0])
            return
        with b.if_else(b.icmp_signed("==", value, I64(options[0]))) as (then, otherwise):
            with then:
                emit_option(options[0])
            with otherwise:
                self._choose(value, options[1:], emit_option)

    def sums(self, taps, depth, columns, column):
        b = self.emit.builder
        with cgutils.for_range(b, self.lanes) as loop:
            lane = loop.index
            base = b.fptosi(b.load(self.emit.at(self.bases, lane)), I64)
            corner = self.emit.at(self.coefficients, b.add(base, column))
            weight = self.emit.at(self.weights, lane)
            values = _contraction(self.emit, (taps, columns, depth), corner, weight, self.m, self.row_stride, self.outer_count, self.outer_offsets)
            at = b.add(self.start, b.add(b.mul(lane, self.lane_stride), b.mul(column, self.column_stride)))
            for k, value in enumerate(values):
                b.store(value, self.emit.at(self.out, b.add(at, b.mul(I64(k), self.column_stride))))


def _contraction(emit, shape, corner, weight, tap_stride, row_stride, outer_count, outer_offsets):
    taps, columns, depth = shape
    builder = emit.builder

    def w(row):
        return builder.load(emit.at(weight, row * BLOCK))

    def row(pointer):
        if columns < WIDTH:
            return emit.row(pointer, taps * columns)
        return [emit.load(emit.at(pointer, builder.mul(tap_stride, I64(t))), WIDTH) for t in range(taps)]

    def plane(pointer):
        if depth == 1:
            return row(pointer)
        total = None
        for t in range(taps):
            total = emit.scaled(w(PLANE + t), row(emit.at(pointer, builder.mul(row_stride, I64(t)))), total)
        return total

    if depth < 3:
        total = plane(corner)
    else:
        kinds = [v.type for v in _row_types(columns, taps)]
        slots = [cgutils.alloca_once_value(builder, ir.Constant(kind, None)) for kind in kinds]
        for slot, kind in zip(slots, kinds):
            builder.store(ir.Constant(kind, None), slot)
        with cgutils.for_range(builder, outer_count) as loop:
            shift = builder.fptosi(builder.load(emit.at(outer_offsets, loop.index)), I64)
            factor = builder.load(emit.at(weight, builder.add(I64(OUTER * BLOCK), builder.mul(loop.index, I64(BLOCK)))))
            before = [builder.load(slot) for slot in slots]
            for slot, value in zip(slots, emit.scaled(factor, plane(emit.at(corner, shift)), before)):
                builder.store(value, slot)
        total = [builder.load(slot) for slot in slots]
    return _last(emit, total, [w(LAST + t) for t in range(taps)], columns)


class _T:
    def __init__(self, type): self.type = type

def _row_types(columns, taps):
    if columns >= WIDTH:
        return [_T(ir.VectorType(F64, WIDTH))] * taps
    n = taps * columns
    return [_T(ir.VectorType(F64, min(WIDTH, n - s))) for s in range(0, n, WIDTH)]


def _last(emit, total, weights, columns):
    builder = emit.builder
    if columns >= WIDTH:
        sums = None
        for w, v in zip(weights, total):
            sums = emit.scaled(w, [v], sums)
        return [builder.extract_element(sums[0], I64(k)) for k in range(WIDTH)]
    numbers = [builder.extract_element(v, I64(i)) for v in total for i in range(v.type.count)]
    sums = [builder.fmul(weights[0], numbers[k]) for k in range(columns)]
    for t in range(1, len(weights)):
        sums = [emit.fma(weights[t], numbers[t * columns + k], sums[k]) for k in range(columns)]
    return sums
