"""What integration over a block of lanes shares: its work space, domain checks, how a lane ends.

A lane is a trajectory. The work space w (rows, LANES) begins with the machine's rows; what each
lane needs besides stands in further rows, whose numbers are `Places`. One array, and no more than
a few others, because numba passes an array as seven values.

Between two accepted states runs a polynomial in theta, 0 .. 1, in the nested form of Hairer,
Norsett, Wanner, Solving Ordinary Differential Equations I (II.6):
r0 + theta (r1 + (1 - theta) (r2 + theta (r3 + (1 - theta) r4))); with r4 = 0 it is the cubic that
has the right states and slopes at both ends.

domain: (2, r) the lowest and highest allowed value of each register entry. Where there is no
limit it is that of the finite numbers, so that one comparison also finds what is not finite.
ended: (B, 4 + n) per trajectory: code, variable (register entry or -1), side (1 above the domain,
-1 below, 0), time and state.
"""

from typing import Final, NamedTuple

import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.cache import inlined, part
from runtime.kernels.machine import fill_literals
from runtime.kernels.tape import LANES, Tape

# Numbers with a point: numba compiles a function anew for every whole constant it is called with.
COMPLETED, LEFT_DOMAIN, DIVERGED, TOO_MANY_STEPS = 0.0, 1.0, 2.0, 3.0
CHATTERING, ARRIVED = 4.0, 5.0
"""Ends at modes: it switches without end; it came to the section or guard that was to end it."""
STAGES: Final = 7
LOOKS: Final = 8
"""Places within a step where an excursion out of the domain is looked for."""
HALVINGS: Final = 52
"""Bisections of one place: down to the spacing of doubles."""
LARGEST: Final = float(np.finfo(np.float64).max)


class Places(NamedTuple):
    """The first row of each quantity in the work space.

    register: the machine's, from row 0 on. x, new: states (n rows) before and after a step.
    k: rates (STAGES times n rows).
    dense: the step's polynomial (5 n rows, that of state i from dense + 5 i on).
    t, h: time and step. alive: 1 or 0. error: the last step's.
    theta, beyond: the places in the step around an event (beyond is -1 where there is one only).
    since: the time of the first of the last quick switches.
    """

    n: int
    register: int
    x: int
    new: int
    k: int
    dense: int
    t: int
    h: int
    alive: int
    error: int
    theta: int
    beyond: int
    since: int


@inlined
def places_of(tape: Tape) -> Places:
    """The places behind the rows of a tape."""
    n = tape.results.shape[0]
    x = tape.rows
    dense = x + (2 + STAGES) * n
    t = dense + 5 * n
    return Places(n, 0, x, x + n, x + 2 * n, dense, t, t + 1, t + 2, t + 3, t + 4, t + 5, t + 6)


@inlined
def work_space(tape: Tape, at: Places) -> Array:
    """An empty work space with the tape's literals in place."""
    w = np.zeros((at.since + 1, LANES))
    fill_literals(tape, w)
    return w


@inlined
def load(w: Array, at: Places, lane: int, start: Array, b: int) -> None:
    """Put the register `start[b]` into a lane."""
    for i in range(start.shape[1]):
        w[i, lane] = start[b, i]
    for i in range(at.n):
        w[at.x + i, lane] = start[b, i]
    w[at.alive, lane] = 1.0


@inlined
def take_rates(tape: Tape, w: Array, k: int, lanes: int) -> None:
    """Copy the results of a run to the rows from k on."""
    for i in range(tape.results.shape[0]):
        row = tape.results[i]
        for lane in range(lanes):
            w[k + i, lane] = w[row, lane]


@inlined
def copy_rows(w: Array, source: int, target: int, count: int, lanes: int) -> None:
    """Copy neighbouring rows."""
    for i in range(count):
        for lane in range(lanes):
            w[target + i, lane] = w[source + i, lane]


@part
def copy_lane(w: Array, source: int, target: int, count: int, lane: int) -> None:
    """Copy neighbouring rows of one lane."""
    for i in range(count):
        w[target + i, lane] = w[source + i, lane]


@inlined
def are_inside(w: Array, first: int, domain: Array, count: int, alive: int, lanes: int) -> bool:
    """Whether the values of all living lanes are in the domain, in rows from `first` on."""
    outside = 0.0
    for i in range(count):
        low, high = domain[0, i], domain[1, i]
        for lane in range(lanes):
            value = w[first + i, lane]
            outside += 0.0 if (value >= low) & (value <= high) else w[alive, lane]
    return outside == 0.0


@part
def any_alive(w: Array, at: Places, lanes: int) -> bool:
    """Whether a lane still goes on."""
    living = 0.0
    for lane in range(lanes):
        living += w[at.alive, lane]
    return living > 0.0


@part
def outsider(w: Array, first: int, domain: Array, count: int, lane: int) -> int:
    """The first entry of a lane whose value is outside its domain or not finite; else -1."""
    for i in range(count):
        value = w[first + i, lane]
        if not (domain[0, i] <= value <= domain[1, i]):
            return i
    return -1


@part
def is_finite(w: Array, first: int, count: int, lane: int) -> bool:
    """Whether all of a lane's values are finite."""
    zero = 0.0
    for i in range(count):
        zero += w[first + i, lane] * 0.0
    return zero == 0.0


@part
def point(w: Array, dense: int, lane: int, theta: float) -> float:
    """The state whose polynomial stands from row `dense` on, at theta."""
    rest = 1.0 - theta
    inner = w[dense + 2, lane] + theta * (w[dense + 3, lane] + rest * w[dense + 4, lane])
    value: float = w[dense, lane] + theta * (w[dense + 1, lane] + rest * inner)
    return value


@part
def begin_dense(w: Array, at: Places, moving: Integers, lane: int, last: int) -> None:
    """The cubic through the step, from the rates in k and in the rows from `last` on."""
    h = w[at.h, lane]
    for i in range(at.n):
        w[at.dense + 5 * i, lane] = w[at.x + i, lane]
        for j in range(1, 5):
            w[at.dense + 5 * i + j, lane] = 0.0
    for j in range(moving.shape[0]):
        i = moving[j]
        dense = at.dense + 5 * i
        rise = w[at.new + i, lane] - w[at.x + i, lane]
        bend = h * w[at.k + i, lane] - rise
        w[dense + 1, lane] = rise
        w[dense + 2, lane] = bend
        w[dense + 3, lane] = rise - h * w[last + i, lane] - bend


@part
def outsider_at(w: Array, at: Places, lane: int, theta: float, domain: Array) -> int:
    """The first state that is outside its domain at theta; else -1."""
    for i in range(at.n):
        value = point(w, at.dense + 5 * i, lane, theta)
        if not (domain[0, i] <= value <= domain[1, i]):
            return i
    return -1


@part
def first_exit(w: Array, at: Places, lane: int, domain: Array) -> tuple[float, int]:
    """Where in the step the domain is left first, by bisection, and by which state.

    The place is the last one found inside; (1, -1) where the polynomial stays inside.
    """
    inside = 0.0
    for look in range(1, LOOKS + 1):
        out = look / LOOKS
        variable = outsider_at(w, at, lane, out, domain)
        if variable < 0:
            inside = out
            continue
        for _ in range(HALVINGS):
            middle = 0.5 * (inside + out)
            found = outsider_at(w, at, lane, middle, domain)
            if found < 0:
                inside = middle
            else:
                out, variable = middle, found
        return inside, variable
    return 1.0, -1


@part
def note_end(w: Array, at: Places, lane: int, code: float, ended: Array, b: int) -> None:
    """A lane ends where it is now: at its t, in its x."""
    w[at.alive, lane] = 0.0
    ended[b, 0] = code
    ended[b, 1] = -1.0
    ended[b, 2] = 0.0
    ended[b, 3] = w[at.t, lane]
    for i in range(at.n):
        ended[b, 4 + i] = w[at.x + i, lane]


@part
def note_exit(variable: int, value: float, domain: Array, ended: Array, b: int) -> None:
    """The domain was left by a register entry, at the edge that is nearer to its value."""
    ended[b, 1] = variable
    if value == value:  # noqa: PLR0124  # NaN is what differs from itself
        middle = 0.5 * domain[0, variable] + 0.5 * domain[1, variable]
        ended[b, 2] = 1.0 if value > middle else -1.0


@part
def blank(states: Array, b: int, first: int) -> None:
    """No states from sample `first` on."""
    for s in range(first, states.shape[1]):
        for i in range(states.shape[2]):
            states[b, s, i] = np.nan
