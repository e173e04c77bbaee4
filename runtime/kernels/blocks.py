"""What integration over a block of lanes shares: its arrays, domain checks, how a trajectory ends.

A lane is a trajectory. Between two accepted states of it runs a polynomial in theta, 0 .. 1, in
the nested form of Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (II.6):
r0 + theta (r1 + (1 - theta) (r2 + theta (r3 + (1 - theta) r4))); with r4 = 0 it is the cubic that
has the right states and slopes at both ends.
"""
# ruff: noqa: PLR0917 - kernels take arguments by place

from typing import Final, NamedTuple

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.kernels.cache import part
from runtime.kernels.machine import fill_literals
from runtime.kernels.tape import LANES, MOST_AXES, Tape

COMPLETED, LEFT_DOMAIN, DIVERGED, TOO_MANY_STEPS = range(4)
STAGES: Final = 7
LOOKS: Final = 8
"""Places within a step where an excursion out of the domain is looked for."""
HALVINGS: Final = 52
"""Bisections of one place: down to the spacing of doubles."""


class Block(NamedTuple):
    """The work space of a block.

    rows, points: the machine's. x, new: (n, LANES) states before and after the step.
    k: (STAGES, n, LANES) rates. t, h: (LANES,) time and step. alive: (LANES,).
    dense: (5, n) one lane's polynomial.
    """

    rows: Array
    points: Array
    x: Array
    new: Array
    k: Array
    t: Array
    h: Array
    alive: Booleans
    dense: Array


class Domain(NamedTuple):
    """The domain of each register entry, infinite where it has none; and which states move."""

    lows: Array
    highs: Array
    moving: Integers


class Results(NamedTuple):
    """Filled per trajectory: states (B, T, n), endings (B, 3), ended (B, 1 + n).

    endings: code, variable (register entry or -1), side (1 above the domain, -1 below, 0).
    ended: the time and the state where it ended.
    """

    states: Array
    endings: Integers
    ended: Array


@part
def new_block(tape: Tape) -> Block:
    """An empty block with the tape's literals in place."""
    n = tape.results.shape[0]
    rows = np.zeros((tape.rows, LANES))
    fill_literals(tape, rows)
    return Block(
        rows,
        np.zeros((MOST_AXES, LANES)),
        np.zeros((n, LANES)),
        np.zeros((n, LANES)),
        np.zeros((STAGES, n, LANES)),
        np.zeros(LANES),
        np.zeros(LANES),
        np.zeros(LANES, dtype=np.bool_),
        np.zeros((5, n)),
    )


@part
def load(block: Block, lane: int, register: Array) -> None:
    """Put a trajectory's register (r,) into a lane."""
    for i in range(register.shape[0]):
        block.rows[i, lane] = register[i]
    for i in range(block.x.shape[0]):
        block.x[i, lane] = register[i]
    block.alive[lane] = True


@part
def copy_lanes(source: Array, target: Array, lanes: int) -> None:
    """Copy the states of all lanes, (n, LANES) to the first n rows of the target."""
    for i in range(source.shape[0]):
        for lane in range(lanes):
            target[i, lane] = source[i, lane]


@part
def take_rates(tape: Tape, block: Block, stage: int, lanes: int) -> None:
    """Copy the results of a run to `k[stage]`."""
    for i in range(tape.results.shape[0]):
        row = tape.results[i]
        for lane in range(lanes):
            block.k[stage, i, lane] = block.rows[row, lane]


@part
def outside(values: Array, lane: int, first: int, last: int, domain: Domain) -> int:
    """The first row in first .. last - 1 whose value is outside its domain or NaN; else -1."""
    for i in range(first, last):
        value = values[i, lane]
        if not (domain.lows[i] <= value <= domain.highs[i]):
            return i
    return -1


@part
def is_finite(values: Array, lane: int) -> bool:
    """Whether all of a lane's values are finite."""
    total = 0.0
    for i in range(values.shape[0]):
        total += values[i, lane] * 0.0
    return total == 0.0


@part
def point(dense: Array, i: int, theta: float) -> float:
    """State i at theta of the step."""
    rest = 1.0 - theta
    inner: float = dense[2, i] + theta * (dense[3, i] + rest * dense[4, i])
    value: float = dense[0, i] + theta * (dense[1, i] + rest * inner)
    return value


@part
def outside_at(dense: Array, theta: float, domain: Domain) -> int:
    """The first state that is outside its domain at theta; else -1."""
    for i in range(dense.shape[1]):
        value = point(dense, i, theta)
        if not (domain.lows[i] <= value <= domain.highs[i]):
            return i
    return -1


@part
def first_exit(dense: Array, domain: Domain) -> tuple[float, int]:
    """Where in the step the domain is left first, by bisection, and by which state.

    The place is the last one found inside; (1, -1) where the polynomial stays inside.
    """
    inside = 0.0
    for look in range(1, LOOKS + 1):
        out = look / LOOKS
        variable = outside_at(dense, out, domain)
        if variable < 0:
            inside = out
            continue
        for _ in range(HALVINGS):
            middle = 0.5 * (inside + out)
            found = outside_at(dense, middle, domain)
            if found < 0:
                inside = middle
            else:
                out, variable = middle, found
        return inside, variable
    return 1.0, -1


@part
def end(results: Results, b: int, code: int, variable: int, side: int, time: float) -> None:
    """Note how and when trajectory b ended."""
    results.endings[b, 0] = code
    results.endings[b, 1] = variable
    results.endings[b, 2] = side
    results.ended[b, 0] = time


@part
def end_at(results: Results, b: int, values: Array, lane: int) -> None:
    """Note the state in which trajectory b ended."""
    for i in range(results.states.shape[2]):
        results.ended[b, 1 + i] = values[i, lane]


@part
def side_of(value: float, high: float) -> int:
    """1 above the domain, -1 below, 0 for NaN."""
    if value > high:
        return 1
    return -1 if value == value else 0  # noqa: PLR0124  # NaN is what differs from itself


@part
def nearer_side(value: float, variable: int, domain: Domain) -> int:
    """1 where a value at an edge of its domain is at the high one, else -1."""
    return 1 if 2.0 * value > domain.lows[variable] + domain.highs[variable] else -1


@part
def blank(results: Results, b: int, first: int) -> None:
    """No states from sample `first` on."""
    for s in range(first, results.states.shape[1]):
        for i in range(results.states.shape[2]):
            results.states[b, s, i] = np.nan
