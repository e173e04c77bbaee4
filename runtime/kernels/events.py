"""Events within a step: where a guard opens, and the jump that follows.

The conditions are looked at in several places of a step at once, one per column of a work space of
their own; the first place where one opens is then closed in on, between the neighbouring places,
as often as doubles allow. A guard opens where its condition is zero or more and was not before.

v: (rows of the gates' tape, LANES) the register, conditions and values to jump to, one place per
column. The other arrays are those of `adapt`.
"""

from typing import Final, NamedTuple

from runtime.arrays import Array, Integers
from runtime.kernels.blocks import Places, point
from runtime.kernels.cache import part
from runtime.kernels.machine import run
from runtime.kernels.tape import Tape

PARTS: Final = 24
"""Parts of a step, at whose ends conditions are looked at, and of each bracket thereafter."""
ROUNDS: Final = 40
"""Most brackets, one within the other: a 24th each, down to the smallest double."""
CLOSE: Final = 2.0**-52
"""The spacing of doubles."""
MODE, TARGET, FIRST, COUNT = range(4)


class Gates(NamedTuple):
    """The guards, packed.

    tape: gives the condition of each guard, then all values to jump to.
    ways: (g, 4) per guard the mode that it leaves and that it leads to, its first jump and how many
    it has. A section has -1 for both modes: it ends the trajectory, wherever its condition turns
    from negative to zero or more. jumps: (k,) the states that jump.
    state: the one that names the mode, or -1. last: the guard that ends the trajectory, or -1.
    """

    tape: Tape
    ways: Integers
    jumps: Integers
    state: int
    last: int


@part
def seek(
    gates: Gates, v: Array, w: Array, at: Places, lane: int, limit: float, spacing: float
) -> tuple[int, float, float]:
    """The guard that opens first in the step, up to `limit`, and the two places around that.

    The guard is -1 where none opens. Of several that open together it is the first one. The places
    are `spacing` apart, relative to the second one.
    """
    low, high = 0.0, limit
    guard = -1
    for _ in range(ROUNDS):
        _look(gates, v, w, at, lane, low, high)
        place, found = _first_opening(gates, v, _mode(gates, w, at, lane))
        if found < 0:
            break
        guard = found
        low, high = _place(low, high, place - 1), _place(low, high, place)
        if high - low <= spacing * high:
            break
    return guard, low, high


@part
def open_guard(gates: Gates, v: Array, w: Array, at: Places, lane: int) -> int:
    """The first guard of the lane's mode that is open in its state, or -1."""
    mode = _mode(gates, w, at, lane)
    if mode < 0:
        return -1
    _look_here(gates, v, w, at, lane)
    for guard in range(gates.ways.shape[0]):
        if gates.ways[guard, MODE] == mode and v[gates.tape.results[guard], 0] >= 0.0:
            return guard
    return -1


@part
def jump(gates: Gates, v: Array, w: Array, at: Places, lane: int, guard: int) -> None:
    """Take a guard in the lane's state: all its jumps together, then the mode."""
    _look_here(gates, v, w, at, lane)
    for j in range(gates.ways[guard, COUNT]):
        number = gates.ways[guard, FIRST] + j
        value = v[gates.tape.results[gates.ways.shape[0] + number], 0]
        w[at.x + gates.jumps[number], lane] = value
    w[at.x + gates.state, lane] = gates.ways[guard, TARGET]
    for i in range(at.n):
        w[i, lane] = w[at.x + i, lane]


@part
def _look_here(gates: Gates, v: Array, w: Array, at: Places, lane: int) -> None:
    """Work out everything in the lane's state."""
    for i in range(gates.tape.entries):
        v[i, 0] = w[at.x + i, lane] if i < at.n else w[i, lane]
    run(gates.tape, v, 1)


@part
def _mode(gates: Gates, w: Array, at: Places, lane: int) -> int:
    if gates.state < 0:
        return -1
    return int(w[at.x + gates.state, lane])


@part
def _place(low: float, high: float, place: int) -> float:
    """The ends of the parts from low to high, both exact."""
    return high if place == PARTS else low + (high - low) * (place / PARTS)


@part
def _look(gates: Gates, v: Array, w: Array, at: Places, lane: int, low: float, high: float) -> None:
    """Work out everything at the ends of the parts from low to high."""
    for i in range(gates.tape.entries):
        for place in range(PARTS + 1):
            theta = _place(low, high, place)
            v[i, place] = point(w, at.dense + 5 * i, lane, theta) if i < at.n else w[i, lane]
    run(gates.tape, v, PARTS + 1)


@part
def _first_opening(gates: Gates, v: Array, mode: int) -> tuple[int, int]:
    """The first place at which a guard of the mode, or a section, opens, and which; -1 if none."""
    for place in range(1, PARTS + 1):
        for guard in range(gates.ways.shape[0]):
            leaves = gates.ways[guard, MODE]
            row = gates.tape.results[guard]
            opens = v[row, place] >= 0.0 and not v[row, place - 1] >= 0.0
            if opens and (leaves == mode or leaves < 0):
                return place, guard
    return -1, -1
