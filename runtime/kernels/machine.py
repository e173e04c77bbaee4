"""The machine: runs a tape over a block of lanes, one instruction at a time.

rows: (R, LANES), one point per lane. Each instruction loops over the lanes, which the compiler
turns into vector instructions; every lane is computed by the same arithmetic, so a point's numbers
depend neither on its place in the batch nor on the batch's size. Operations follow IEEE 754:
nothing raises, 1/0 is inf, sqrt(-1) is NaN.
"""
# ruff: noqa: C901, PLR0912 - one branch per operation; kernels take arguments by place

import math
from functools import cache
from typing import Any, Final

import numpy as np

from runtime.arrays import Array
from runtime.kernels.cache import compiled_for_c, inlined, kernel, part
from runtime.kernels.interpolate import lookup_lanes
from runtime.kernels.tape import (
    ABS,
    ACOS,
    ADD,
    AND,
    ASIN,
    ATAN,
    ATAN2,
    CLIP,
    COS,
    COSH,
    DIV,
    EQ,
    EXP,
    FLOOR,
    GE,
    GT,
    HYPOT,
    LANES,
    LE,
    LOG,
    LT,
    MAX,
    MIN,
    MOD,
    MOST_AXES,
    MUL,
    NE,
    NEG,
    NOT,
    OR,
    POW,
    SIGN,
    SIN,
    SINH,
    SQRT,
    SUB,
    TABLE,
    TAN,
    TANH,
    WHERE,
    WRAP,
    Tape,
)
from runtime.kernels.vectors import call, carray, stack_memory, types

ARGUMENTS: Final = MOST_AXES * LANES
PI: Final = math.pi
TURN: Final = 2.0 * math.pi


@inlined
def run(tape: Tape, rows: Array, lanes: int) -> None:
    """Run every instruction on the first `lanes` lanes; rows has at least `tape.rows` rows."""
    code = tape.instructions, tape.instructions.shape[0]
    tables = tape.shapes, tape.axes, tape.counts, tape.periodic, tape.lows, tape.inverse_steps
    call(
        tape.machine,
        (*code, rows, tape.rows, lanes, *tables, tape.coefficients, tape.lookup),
    )


@cache
def machine_address() -> int:
    """Where the machine's own machine code is; compiled on the first call."""
    numbers, integers = types.CPointer(types.float64), types.CPointer(types.int64)
    flags, i = types.CPointer(types.uint8), types.int64
    code, work = (integers, i), (numbers, i, i)
    tables = (integers, integers, integers, flags, numbers, numbers)
    return compiled_for_c(_machine, types.void(*code, *work, *tables, numbers, i))


def _machine(
    instructions_: Any,
    count: int,
    rows_: Any,
    size: int,
    lanes: int,
    shapes: Any,
    axes: Any,
    counts: Any,
    periodic: Any,
    lows: Any,
    inverse_steps: Any,
    coefficients: Any,
    lookup: int,
) -> None:
    rows = carray(rows_, (size, LANES))
    points = carray(stack_memory(ARGUMENTS), (MOST_AXES, LANES))
    instructions = carray(instructions_, (count, 5))
    for k in range(count):
        op = instructions[k, 0]
        target = instructions[k, 1]
        a = instructions[k, 2]
        b = instructions[k, 3]
        c = instructions[k, 4]
        if op == TABLE:
            tables = shapes, axes, counts, periodic, lows, inverse_steps, coefficients
            _look_up(lookup, tables, a, rows, target, points, lanes)
        elif op <= NEG:
            _arithmetic(op, rows, target, a, b, lanes)
        elif op <= WHERE:
            _logic(op, rows, target, a, b, c, lanes)
        elif op <= SQRT:
            _shape(op, rows, target, a, b, c, lanes)
        else:
            _analysis(op, rows, target, a, b, lanes)


@part
def _look_up(
    lookup: int, tables: Any, t: int, rows: Array, target: int, points: Array, lanes: int
) -> None:
    shapes, axes, counts, periodic, lows, inverse_steps, coefficients = tables
    shape = carray(shapes, (t + 1, 4))[t]
    d, m = shape[1], shape[2]
    entries = carray(axes, (t + 1, MOST_AXES))[t]
    for i in range(d):
        for lane in range(lanes):
            points[i, lane] = rows[entries[i], lane]
    lookup_lanes(
        lookup,
        shape[0] != 0,
        d,
        m,
        carray(counts, (t + 1, MOST_AXES))[t],
        carray(lows, (t + 1, MOST_AXES))[t],
        carray(inverse_steps, (t + 1, MOST_AXES))[t],
        carray(periodic, (t + 1, MOST_AXES))[t],
        carray(coefficients, 1),
        shape[3],
        points,
        lanes,
        rows[target : target + m],
    )


@part
def _arithmetic(op: int, rows: Array, target: int, a: int, b: int, lanes: int) -> None:
    if op == ADD:
        for i in range(lanes):
            rows[target, i] = rows[a, i] + rows[b, i]
    elif op == SUB:
        for i in range(lanes):
            rows[target, i] = rows[a, i] - rows[b, i]
    elif op == MUL:
        for i in range(lanes):
            rows[target, i] = rows[a, i] * rows[b, i]
    elif op == DIV:
        for i in range(lanes):
            rows[target, i] = rows[a, i] / rows[b, i]
    elif op == MOD:
        for i in range(lanes):
            rows[target, i] = _modulo(rows[a, i], rows[b, i])
    elif op == POW:
        for i in range(lanes):
            rows[target, i] = math.pow(rows[a, i], rows[b, i])
    elif op == NEG:
        for i in range(lanes):
            rows[target, i] = -rows[a, i]


@part
def _logic(op: int, rows: Array, target: int, a: int, b: int, c: int, lanes: int) -> None:
    if op == LT:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] < rows[b, i] else 0.0
    elif op == LE:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] <= rows[b, i] else 0.0
    elif op == GT:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] > rows[b, i] else 0.0
    elif op == GE:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] >= rows[b, i] else 0.0
    elif op == EQ:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] == rows[b, i] else 0.0
    elif op == NE:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] != rows[b, i] else 0.0
    elif op == AND:
        for i in range(lanes):
            rows[target, i] = 1.0 if (rows[a, i] != 0.0) & (rows[b, i] != 0.0) else 0.0
    elif op == OR:
        for i in range(lanes):
            rows[target, i] = 1.0 if (rows[a, i] != 0.0) | (rows[b, i] != 0.0) else 0.0
    elif op == NOT:
        for i in range(lanes):
            rows[target, i] = 1.0 if rows[a, i] == 0.0 else 0.0
    elif op == WHERE:
        for i in range(lanes):
            rows[target, i] = rows[b, i] if rows[a, i] != 0.0 else rows[c, i]


@part
def _shape(op: int, rows: Array, target: int, a: int, b: int, c: int, lanes: int) -> None:
    if op == ABS:
        for i in range(lanes):
            rows[target, i] = abs(rows[a, i])
    elif op == SIGN:
        for i in range(lanes):
            rows[target, i] = _sign(rows[a, i])
    elif op == MIN:
        for i in range(lanes):
            rows[target, i] = _smaller(rows[a, i], rows[b, i])
    elif op == MAX:
        for i in range(lanes):
            rows[target, i] = _larger(rows[a, i], rows[b, i])
    elif op == CLIP:
        for i in range(lanes):
            rows[target, i] = _smaller(_larger(rows[a, i], rows[b, i]), rows[c, i])
    elif op == SQRT:
        for i in range(lanes):
            rows[target, i] = math.sqrt(rows[a, i])


@part
def _analysis(op: int, rows: Array, target: int, a: int, b: int, lanes: int) -> None:
    for i in range(lanes):
        x = rows[a, i]
        if op == SIN:
            y = math.sin(x)
        elif op == COS:
            y = math.cos(x)
        elif op == TAN:
            y = math.tan(x)
        elif op == EXP:
            y = math.exp(x)
        elif op == LOG:
            y = math.log(x)
        elif op == HYPOT:
            y = math.hypot(x, rows[b, i])
        elif op == ATAN2:
            y = math.atan2(x, rows[b, i])
        elif op == ASIN:
            y = math.asin(x)
        elif op == ACOS:
            y = math.acos(x)
        elif op == ATAN:
            y = math.atan(x)
        elif op == SINH:
            y = math.sinh(x)
        elif op == COSH:
            y = math.cosh(x)
        elif op == TANH:
            y = math.tanh(x)
        elif op == FLOOR:
            y = np.floor(x)  # math.floor would go through an integer
        elif op == WRAP:
            y = _wrapped(x)
        else:
            y = np.nan
        rows[target, i] = y


@part
def _modulo(x: float, y: float) -> float:
    """Python's `x % y`, which has the sign of y; NaN where y is 0."""
    rest: float = np.fmod(x, y)
    if rest != 0.0 and (rest < 0.0) != (y < 0.0):
        return rest + y
    return math.copysign(0.0, y) if rest == 0.0 else rest


@part
def _sign(x: float) -> float:
    if x > 0.0:
        return 1.0
    return -1.0 if x < 0.0 else x * 0.0


@part
def _smaller(x: float, y: float) -> float:
    """The smaller one; NaN where either is (C's fmin would hide it)."""
    return x if x < y or x != x else y  # noqa: PLR0124  # NaN is what differs from itself


@part
def _larger(x: float, y: float) -> float:
    return x if x > y or x != x else y  # noqa: PLR0124  # NaN is what differs from itself


@part
def _wrapped(x: float) -> float:
    """`x` in (-pi, pi]; exact for the double nearest to 2 pi: fmod and the shift do not round."""
    rest: float = np.fmod(x, TURN)
    if rest > PI:
        return rest - TURN
    return rest + TURN if rest <= -PI else rest


@part
def fill_literals(tape: Tape, rows: Array) -> None:
    """Put the literals into their rows, for all lanes: no instruction writes there."""
    for j in range(tape.literals.shape[0]):
        for lane in range(LANES):
            rows[tape.entries + j, lane] = tape.literals[j]


@kernel
def evaluate_points(tape: Tape, register: Array, out: Array) -> None:
    """Fill `out` (N, q) with the results at the points `register` (N, r)."""
    rows = np.zeros((tape.rows, LANES))
    fill_literals(tape, rows)
    for first in range(0, register.shape[0], LANES):
        lanes = min(LANES, register.shape[0] - first)
        for lane in range(lanes):
            for i in range(tape.entries):
                rows[i, lane] = register[first + lane, i]
        run(tape, rows, lanes)
        for lane in range(lanes):
            for j in range(tape.results.shape[0]):
                out[first + lane, j] = rows[tape.results[j], lane]
