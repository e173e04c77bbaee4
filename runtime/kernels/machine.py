"""The machine: runs a tape over a block of lanes, one instruction at a time.

rows: (R, LANES), one point per lane. Each instruction loops over the lanes, which the compiler
turns into vector instructions; every lane is computed by the same arithmetic, so a point's numbers
depend neither on its place in the batch nor on the batch's size. Operations follow IEEE 754:
nothing raises, 1/0 is inf, sqrt(-1) is NaN.
"""
# ruff: noqa: C901, PLR0912, PLR0917 - one branch per operation; kernels take arguments by place

import math
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.kernels.cache import kernel
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

PI: Final = math.pi
TURN: Final = 2.0 * math.pi


@kernel
def run(tape: Tape, rows: Array, points: Array, lanes: int) -> None:
    """Run every instruction; `points` (MOST_AXES, LANES) is scratch for the tables' arguments."""
    for k in range(tape.instructions.shape[0]):
        op = tape.instructions[k, 0]
        target = tape.instructions[k, 1]
        a = tape.instructions[k, 2]
        b = tape.instructions[k, 3]
        c = tape.instructions[k, 4]
        if op == TABLE:
            _look_up(tape, a, rows, target, points, lanes)
        elif op <= NEG:
            _arithmetic(op, rows, target, a, b, lanes)
        elif op <= WHERE:
            _logic(op, rows, target, a, b, c, lanes)
        elif op <= SQRT:
            _shape(op, rows, target, a, b, c, lanes)
        else:
            _analysis(op, rows, target, a, b, lanes)


@kernel
def _look_up(tape: Tape, t: int, rows: Array, target: int, points: Array, lanes: int) -> None:
    d = tape.shapes[t, 1]
    m = tape.shapes[t, 2]
    for i in range(d):
        for lane in range(lanes):
            points[i, lane] = rows[tape.axes[t, i], lane]
    lookup_lanes(
        tape.lookup,
        tape.shapes[t, 0] != 0,
        d,
        m,
        tape.counts[t],
        tape.lows[t],
        tape.inverse_steps[t],
        tape.periodic[t],
        tape.coefficients,
        tape.shapes[t, 3],
        points,
        lanes,
        rows[target : target + m],
    )


@kernel
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


@kernel
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


@kernel
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


@kernel
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


@kernel
def _modulo(x: float, y: float) -> float:
    """Python's `x % y`, which has the sign of y; NaN where y is 0."""
    rest: float = np.fmod(x, y)
    if rest != 0.0 and (rest < 0.0) != (y < 0.0):
        return rest + y
    return math.copysign(0.0, y) if rest == 0.0 else rest


@kernel
def _sign(x: float) -> float:
    if x > 0.0:
        return 1.0
    return -1.0 if x < 0.0 else x * 0.0


@kernel
def _smaller(x: float, y: float) -> float:
    """The smaller one; NaN where either is (C's fmin would hide it)."""
    return x if x < y or x != x else y  # noqa: PLR0124  # NaN is what differs from itself


@kernel
def _larger(x: float, y: float) -> float:
    return x if x > y or x != x else y  # noqa: PLR0124  # NaN is what differs from itself


@kernel
def _wrapped(x: float) -> float:
    """`x` in (-pi, pi]; exact for the double nearest to 2 pi: fmod and the shift do not round."""
    rest: float = np.fmod(x, TURN)
    if rest > PI:
        return rest - TURN
    return rest + TURN if rest <= -PI else rest


@kernel
def fill_literals(tape: Tape, rows: Array) -> None:
    """Put the literals into their rows, for all lanes: no instruction writes there."""
    for j in range(tape.literals.shape[0]):
        rows[tape.entries + j, :] = tape.literals[j]


@kernel
def evaluate_points(tape: Tape, register: Array, out: Array) -> None:
    """Fill `out` (N, q) with the results at the points `register` (N, r)."""
    rows = np.zeros((tape.rows, LANES))
    points = np.zeros((MOST_AXES, LANES))
    fill_literals(tape, rows)
    for first in range(0, register.shape[0], LANES):
        lanes = min(LANES, register.shape[0] - first)
        for lane in range(lanes):
            for i in range(tape.entries):
                rows[i, lane] = register[first + lane, i]
        run(tape, rows, points, lanes)
        for lane in range(lanes):
            for j in range(tape.results.shape[0]):
                out[first + lane, j] = rows[tape.results[j], lane]
