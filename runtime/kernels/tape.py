"""What a tape is, for the kernels that run it: operations by number, and the packed arrays.

`runtime.tape` makes tapes. The numbers mean nothing outside the process; `runtime.code` has the
names that are stored.
"""

from typing import Final, NamedTuple

from runtime.arrays import Array, Booleans, Integers

LANES: Final = 64
"""How many points a kernel works on at once: a row of lanes is eight cache lines."""
MOST_AXES: Final = 5

ADD, SUB, MUL, DIV, MOD, POW, NEG = range(7)
LT, LE, GT, GE, EQ, NE, AND, OR, NOT, WHERE = range(7, 17)
ABS, SIGN, MIN, MAX, CLIP, SQRT = range(17, 23)
HYPOT, EXP, LOG, SIN, COS, TAN, ASIN, ACOS, ATAN, ATAN2 = range(23, 33)
SINH, COSH, TANH, FLOOR, WRAP = range(33, 38)
TABLE: Final = 38
"""The instruction that looks up table `a`; its columns go to the rows from the target on."""


class Tape(NamedTuple):
    """What the kernels read; every array is read-only, so that one compiled type fits all calls.

    Rows 0 .. entries - 1 hold the register, the next ones the literals, then come the columns of
    the tables and intermediate values.

    rows: how many there are. instructions: (k, 5) operation, target row, operand rows a, b, c.
    literals: values for the rows from `entries` on. results: (q,) rows that hold them after a run.
    shapes: (t, 4) per table: cubic (0 or 1), axes d, columns m, offset into `coefficients`.
    axes: (t, 5) the row of each axis. counts: (t, 5) coefficients along each axis.
    periodic, lows, inverse_steps: (t, 5). coefficients: those of all tables, flat.
    machine, lookup: where the machine code of both is in this process; lookup is 0 without tables.
    """

    entries: int
    rows: int
    instructions: Integers
    literals: Array
    results: Integers
    shapes: Integers
    axes: Integers
    counts: Integers
    periodic: Booleans
    lows: Array
    inverse_steps: Array
    coefficients: Array
    machine: int
    lookup: int
