"""One tick of a behavior, compiled: take what is sensed, look a period ahead, say and command.

All in one file, because numba notices edits of a cached kernel in its own file only; the parts from
`runtime.kernels` are in the hash of the cache's folder.

What has rates moves by the classical Runge-Kutta method, in `PARTS` equal steps over the period,
with what is only sensed held. Where a guard opens within a step, the place is found by bisection of
the step itself, so that a timer of the behavior's own switches at its time and not at a tick.
Noise is added at the end of the period: one Euler-Maruyama increment (Kloeden, Platen 1992, 9.1).
"""

from typing import Any, Final, NamedTuple, final

import numba
import numba.experimental.structref
import numpy as np

from runtime.arrays import Array, Integers
from runtime.kernels.cache import kernel, part
from runtime.kernels.machine import run
from runtime.kernels.tape import Tape

NUMBA: Any = numba  # it has no types
structref: Any = NUMBA.experimental.structref

PARTS: Final = 8
STAGES: Final = 4
HALVINGS: Final = 50
MOST_SWITCHES: Final = 50
"""Switches of mode in one tick; more have no end."""

OUTSIDE, BARRED, BROKEN, CHATTERS, CLIPPED, SWITCHED = 1, 2, 4, 8, 16, 32
"""Flags of a tick: a reading is outside its domain, `acts_when` does not hold, the field has no
finite value there, modes switch without end, an own state was kept at the edge of its domain, the
mode changed."""

AS_RATE, AS_NEXT, AS_ENTRY, AS_OUTPUT = 0, 1, 2, 3
"""What a command takes: the rate of a state, its value one period on, an entry of the register as
it is at the sample, or an output."""
NOTHING, OWN, COMMANDS = 0, 1, 2
"""What looks ahead; where nothing is to be found out, it does not."""
ENTRY, INHIBITS = 0, 1
"""Columns of `Frame.inputs`."""
SCALE, LOW, HIGH, TURN = 0, 1, 2, 3
"""Columns of `Frame.scaling`."""
MODE, TARGET, FIRST, COUNT = 0, 1, 2, 3
"""Columns of `Frame.ways`."""


class Frame(NamedTuple):
    """What a behavior's ticks need and never change, besides room to work in.

    tape: gives the rates, or next values, of all n states.
    rest: gives acts_when, the outputs, the sizes of the noise, the guards' conditions, then the
    values to jump to. inputs: (m, 2) the entry, and whether a reading outside inhibits.
    scaling: (m, 4). ways: (g, 4), jumps: (j,) as of `runtime.kernels.events.Gates`.
    noisy: the states with noise. moving: states that the field moves. own: states that are the
    behavior's own: only driven, and the mode. edges: (3, n) lowest and highest value, and the
    period (0: not periodic) of each own state. commands: (c, 2) what it takes, and of which state,
    entry or output; signs: (c,).
    period: seconds. mode: the state that holds it, or -1. outputs: how many. is_map: 0 or 1.
    looks_ahead: what is taken from the state one period on: `NOTHING`, own states where it has its
    way (`OWN`), or commands too (`COMMANDS`). steady_rates, steady_guards: 1 where no rate of a
    state that is taken, or no guard, reads a state that moves: these are then all along what they
    were at the sample.
    work, rest_work: the rows of both tapes, literals in place. room: (9, n).
    """

    tape: Tape
    rest: Tape
    inputs: Integers
    scaling: Array
    ways: Integers
    jumps: Integers
    noisy: Integers
    moving: Integers
    own: Integers
    edges: Array
    commands: Integers
    signs: Array
    period: float
    mode: int
    outputs: int
    is_map: int
    looks_ahead: int
    steady_rates: int
    steady_guards: int
    work: Array
    rest_work: Array
    room: Array


@structref.register
class BenchType(NUMBA.types.StructRef):  # type: ignore[misc]  # numba has no types
    """The type of a bench, for numba."""


@final
class Bench(structref.StructRefProxy):  # type: ignore[misc]  # numba has no types
    """All that a behavior's ticks work on, held together: 50 arrays take longer to hand over.

    The arrays are those that it was made of. frame: what never changes.
    signals, values: (m,) for each input its place on the board, or -1 and its value.
    register: (r,) holds own states and constants before a tick; afterwards all as they are at the
    sample. kicks: (k,) standard normal numbers for the noise.
    told: filled with outputs, then commands.
    """


structref.define_boxing(BenchType, Bench)
structref.define_constructor(
    Bench, BenchType, ["frame", "signals", "values", "register", "kicks", "told"]
)


@kernel
def bench(
    frame: Frame, signals: Integers, values: Array, register: Array, kicks: Array, told: Array
) -> Bench:
    """Lay everything on a bench."""
    return Bench(frame, signals, values, register, kicks, told)


@kernel
def tick(bench: Bench, board: Array, allowed: int) -> int:
    """Tick once; flags.

    Where the behavior has its way (`allowed` and no flag against it) its own states go a period
    on: they are left in row 6 of `frame.room`, which the next tick takes them from.
    """
    frame, register, told = bench.frame, bench.register, bench.told
    n = frame.room.shape[1]
    x, new, later = frame.room[0], frame.room[1], frame.room[6]
    flags = _sense(frame, board, bench.signals, bench.values, register)
    for i in range(register.shape[0]):
        frame.work[i, 0] = register[i]
        frame.rest_work[i, 0] = register[i]
    for i in range(n):
        x[i] = register[i]
    _look(frame, x)
    if frame.rest_work[frame.rest.results[0], 0] == 0.0:
        flags |= BARRED
    commits = allowed == 1 and flags == 0
    if commits and frame.mode >= 0:
        flags |= _settle(frame, x)
        for i in range(frame.own.shape[0]):
            register[frame.own[i]] = x[frame.own[i]]
            later[frame.own[i]] = x[frame.own[i]]
    for j in range(frame.outputs):
        told[j] = frame.rest_work[frame.rest.results[1 + j], 0]
    sizes, kicks = 1 + frame.outputs, bench.kicks
    for j in range(frame.noisy.shape[0]):
        frame.room[5, frame.noisy[j]] = kicks[j] * frame.rest_work[frame.rest.results[sizes + j], 0]
    flags |= _ahead(frame, x, new, int(commits), flags)
    flags |= _command(frame, register, new, told)
    if commits and flags & BROKEN == 0:
        for i in range(frame.own.shape[0]):
            state = frame.own[i]
            later[state] = new[state]
        flags |= _keep_inside(frame, later)
    return flags


@part
def _sense(frame: Frame, board: Array, signals: Integers, values: Array, register: Array) -> int:
    """Fill the register: own states from where they are, the rest from the board."""
    for i in range(frame.own.shape[0]):
        register[frame.own[i]] = frame.room[6, frame.own[i]]
    flags = 0
    for j in range(signals.shape[0]):
        value = board[signals[j]] * frame.scaling[j, SCALE] if signals[j] >= 0 else values[j]
        low, high = frame.scaling[j, LOW], frame.scaling[j, HIGH]
        if low <= value <= high:
            register[frame.inputs[j, ENTRY]] = value
            continue
        turn = frame.scaling[j, TURN]
        if turn > 0.0:
            value -= turn * np.floor((value - low) / turn)
        if np.isnan(value) or (frame.inputs[j, INHIBITS] == 1 and turn == 0.0):
            flags = OUTSIDE
        if not np.isnan(value):
            register[frame.inputs[j, ENTRY]] = min(max(value, low), high)
    return flags


@part
def _look(frame: Frame, x: Array) -> None:
    """Work out everything but the rates, in the state x."""
    for i in range(x.shape[0]):
        frame.rest_work[i, 0] = x[i]
    run(frame.rest, frame.rest_work, 1)


@part
def _rates(frame: Frame, x: Array, rates: Array) -> None:
    for i in range(x.shape[0]):
        frame.work[i, 0] = x[i]
    run(frame.tape, frame.work, 1)
    for i in range(x.shape[0]):
        rates[i] = frame.work[frame.tape.results[i], 0]


@part
def _condition(frame: Frame, guard: int) -> float:
    value: float = frame.rest_work[
        frame.rest.results[1 + frame.outputs + frame.noisy.shape[0] + guard], 0
    ]
    return value


@part
def _open_guard(frame: Frame, x: Array) -> int:
    """The first guard of the mode that is open, as it was looked at last, or -1."""
    for guard in range(frame.ways.shape[0]):
        if frame.ways[guard, MODE] == x[frame.mode] and _condition(frame, guard) >= 0.0:
            return guard
    return -1


@part
def _jump(frame: Frame, x: Array, guard: int) -> None:
    """Take a guard: all its jumps together, then the mode; then look again."""
    first = 1 + frame.outputs + frame.noisy.shape[0] + frame.ways.shape[0]
    for j in range(frame.ways[guard, COUNT]):
        number = frame.ways[guard, FIRST] + j
        x[frame.jumps[number]] = frame.rest_work[frame.rest.results[first + number], 0]
    x[frame.mode] = frame.ways[guard, TARGET]
    _look(frame, x)


@part
def _settle(frame: Frame, x: Array) -> int:
    """Take guards that are open in the state x, until none is."""
    for switches in range(MOST_SWITCHES):
        guard = _open_guard(frame, x)
        if guard < 0:
            return SWITCHED if switches > 0 else 0
        _jump(frame, x, guard)
    return CHATTERS | SWITCHED


@part
def _ahead(frame: Frame, x: Array, new: Array, commits: int, settled: int) -> int:
    """The state one period on, without noise; the rates at the sample stay in row 2 of the room.

    Where nobody takes it, it is only told whether the rates are finite: by a single step of Euler.
    """
    for i in range(x.shape[0]):
        new[i] = x[i]
    first = frame.room[2]
    _rates(frame, x, first)
    if frame.is_map == 1:
        for j in range(frame.moving.shape[0]):
            i = frame.moving[j]
            new[i] = first[i]
            first[i] = (first[i] - x[i]) / frame.period
        return 0
    if frame.looks_ahead == NOTHING or (frame.looks_ahead == OWN and commits == 0):
        for i in range(x.shape[0]):
            new[i] = x[i] + frame.period * first[i]
        return 0
    h = frame.period / PARTS
    here = frame.room[4]
    guarded = commits == 1 and frame.mode >= 0 and settled & CHATTERS == 0
    guarded = guarded and frame.steady_guards == 0  # those that stand open were taken already
    known = STAGES if frame.steady_rates == 1 else 1
    flags = 0
    for _ in range(PARTS):
        for i in range(x.shape[0]):
            here[i] = new[i]
        _step(frame, here, h, new, known)
        known = STAGES if known == STAGES else 0
        if guarded:
            _look(frame, new)
            if _open_guard(frame, new) >= 0:
                flags |= _through_guards(frame, here, h, new)
                known = 0
                # What switches without end goes on in the mode that it came to.
                guarded = flags & CHATTERS == 0
    return flags


@part
def _step(frame: Frame, x: Array, h: float, new: Array, known: int) -> None:
    """From x to new, `h` later; known: of how many stages row 2 of the room has the rates."""
    total, stage_x = frame.room[3], frame.room[7]
    rates = frame.room[8]
    for i in range(x.shape[0]):
        total[i] = 0.0
        stage_x[i] = x[i]
    for stage in range(STAGES):
        if stage < known:
            for i in range(x.shape[0]):
                rates[i] = frame.room[2, i]
        else:
            _rates(frame, stage_x, rates)
        weight = 1.0 / 3.0 if 0 < stage < 3 else 1.0 / 6.0
        reach = 1.0 if stage == 2 else 0.5
        for j in range(frame.moving.shape[0]):
            i = frame.moving[j]
            total[i] += weight * rates[i]
            stage_x[i] = x[i] + reach * h * rates[i]
    for i in range(x.shape[0]):
        new[i] = x[i]
    for j in range(frame.moving.shape[0]):
        i = frame.moving[j]
        new[i] = x[i] + h * total[i]


@part
def _through_guards(frame: Frame, here: Array, h: float, new: Array) -> int:
    """A step in which a guard opens: to the place, the jump, and on to the step's end."""
    left = h
    for _ in range(MOST_SWITCHES):
        low, high = 0.0, left
        for _halving in range(HALVINGS):
            middle = 0.5 * (low + high)
            _step(frame, here, middle, new, 0)
            _look(frame, new)
            if _open_guard(frame, new) >= 0:
                high = middle
            else:
                low = middle
        _step(frame, here, high, new, 0)
        _look(frame, new)
        _jump(frame, new, _open_guard(frame, new))
        left -= high
        chatters = _settle(frame, new) & CHATTERS
        for i in range(new.shape[0]):
            here[i] = new[i]
        _step(frame, here, left, new, 0)
        if chatters != 0:
            return CHATTERS | SWITCHED
        _look(frame, new)
        if _open_guard(frame, new) < 0:
            return SWITCHED
    return CHATTERS | SWITCHED


@part
def _command(frame: Frame, register: Array, new: Array, told: Array) -> int:
    """Add the noise to the state one period on and to the rates, and fill the commands."""
    rates, kicks = frame.room[2], frame.room[5]
    spread = 1.0 if frame.is_map == 1 else np.sqrt(frame.period)
    for j in range(frame.noisy.shape[0]):
        i = frame.noisy[j]
        new[i] += spread * kicks[i]
        rates[i] += spread * kicks[i] / frame.period
    sound = 0.0
    for i in range(new.shape[0]):
        sound += 0.0 * new[i]
    for j in range(frame.commands.shape[0]):
        what, of = frame.commands[j, 0], frame.commands[j, 1]
        if what == AS_RATE:
            value = rates[of]
        elif what == AS_NEXT:
            value = new[of]
        elif what == AS_ENTRY:
            value = register[of]
        else:
            value = told[of]
        sound += 0.0 * value
        told[frame.outputs + j] = frame.signs[j] * value
    return 0 if sound == 0.0 else BROKEN


@part
def _keep_inside(frame: Frame, own: Array) -> int:
    """Wrap own states that are periodic, and keep the others within their domains."""
    flags = 0
    for j in range(frame.own.shape[0]):
        i = frame.own[j]
        low, high, period = frame.edges[0, i], frame.edges[1, i], frame.edges[2, i]
        if period > 0.0:
            own[i] -= period * np.floor((own[i] - low) / period)
        elif own[i] < low:
            own[i], flags = low, CLIPPED
        elif own[i] > high:
            own[i], flags = high, CLIPPED
    return flags
