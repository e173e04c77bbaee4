"""Numbers in guards, as the robot has them: those that make a guard open where it switched.

The state just before each switch is fitted to the last samples of its own side. A guard is zero
where it opens, so each switch says by itself what a number in it would have to be.

K: changes that took a guard; D: predicted states; r: entries of the register.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.code import Code
from runtime.machine import evaluate
from verifier.fidelity.shooting.jumps import register_under
from verifier.fidelity.stretches.needs import Needs, names_read
from verifier.fidelity.switching.guards import room_at
from verifier.fidelity.switching.jumps import rates_at
from verifier.fidelity.switching.means import FEWEST, Mean, mean_of
from verifier.fidelity.switching.setting import Setting, inputs_at
from verifier.fidelity.switching.ways import Compared, bias_of
from verifier.report.switching import SwitchSort, Way

BARE: Final = "number"
"""What a bare number of a guard is called in code, so that it can be moved."""
ROUNDS: Final = 4
NUDGE: Final = 1e-4
"""The difference for slopes, as a share of the number."""
LITTLE: Final = 1e-3
"""A little while, as a share of the time to which states are fitted."""
ENOUGH: Final = 0.6
"""A number explains at least this share of what single switches say of it."""
SORTS: Final = (SwitchSort.EXPECTED, SwitchSort.UNEXPECTED)
Told: TypeAlias = tuple[Array, Array, float, float]
"""What single switches say of a number (N,), the deviations (N,); then its room and its bias."""


@final
@dataclass(frozen=True, slots=True)
class Number:
    """A number of guards: a constant or control by its name, else as it is written.

    place: of a bare number, which token of its guard.
    """

    name: str
    spec: float
    guards: tuple[int, ...]
    place: int = -1

    @property
    def is_bare(self) -> bool:
        """Whether it has no name."""
        return self.place >= 0


@final
@dataclass(frozen=True, slots=True)
class Threshold:
    """What a number would have to be for the robot's switches: a mean over them, minus the spec's.

    share: of the squared differences of single switches that the mean of all others explains.
    mends: the guards that would open in time with it.
    """

    number: Number
    mean: Mean
    share: float
    mends: tuple[int, ...]


@final
class Why(Enum):
    """Why no number mends a guard.

    TOO_FEW: of too few switches to tell. NOT_TRIED: it reads numbers that the field reads, too,
    and such a number is not moved for a guard's sake. NONE_FITS: none of its numbers would do.
    """

    TOO_FEW = "too few"
    NOT_TRIED = "not tried"
    NONE_FITS = "none fits"


@final
@dataclass(frozen=True, slots=True)
class Unmended:
    """A guard that stays off, by its place among the guards.

    switches: so many tell of its numbers. shared: those that the field reads, too.
    """

    guard: int
    why: Why
    switches: int
    shared: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True)
class Mended:
    """What mends the guards that are off, and those that nothing mends.

    Each of `groups` holds numbers among which the trace can't tell.
    """

    groups: tuple[tuple[Threshold, ...], ...]
    unmended: tuple[Unmended, ...]


def thresholds_of(
    compared: Compared, needs: Needs, ways: Sequence[Way], exceeded: Sequence[bool]
) -> Mended:
    """The numbers that would mend the guards that are off.

    exceeded: which guards are late or early on average. A number that the field reads, too, is
    left alone, and so is one that would put a guard off that is in time.
    """
    off = guards_off(ways, exceeded)
    found = [_threshold(compared, number) for number in _numbers(compared, needs)]
    able = [each for each in found if each is not None and each.share >= ENOUGH]
    left, chosen = set(off), list[tuple[Threshold, ...]]()
    while left:
        best = max((len(left & set(each.mends)) for each in able), default=0)
        if best == 0:
            break
        first = next(each for each in able if len(left & set(each.mends)) == best)
        mended = left & set(first.mends)
        chosen.append(tuple(each for each in able if left & set(each.mends) == mended))
        left -= mended
    open_ = [_unmended(compared, needs, g, ways[g], is_late=exceeded[g]) for g in sorted(left)]
    return Mended(tuple(chosen), tuple(open_))


def _unmended(compared: Compared, needs: Needs, guard: int, way: Way, *, is_late: bool) -> Unmended:
    """One of which nothing is known but a few odd switches is of too few, too."""
    told, odd = len(_taken(compared, guard)), way.unexpected + way.missed
    tokens = compared.setting.guards[guard].condition.tokens
    held = _held(compared, needs)
    shared = [name for name in names_read(compared.setting.program) if name in held]
    shared = [name for name in shared if name in tokens]
    if told < FEWEST or (not is_late and odd < FEWEST):
        return Unmended(guard, Why.TOO_FEW, told if is_late else min(told, odd), ())
    why = Why.NOT_TRIED if shared else Why.NONE_FITS
    return Unmended(guard, why, told, tuple(sorted(shared)))


def guards_off(ways: Sequence[Way], exceeded: Sequence[bool]) -> tuple[int, ...]:
    """The guards that the robot takes at other times than the spec, be it a single time."""
    return tuple(
        index
        for index, (way, is_late) in enumerate(zip(ways, exceeded, strict=True))
        if is_late or way.unexpected or way.missed
    )


def _numbers(compared: Compared, needs: Needs) -> list[Number]:
    """Those with names first."""
    read, values = names_read(compared.setting.program), _held(compared, needs)
    tokens = [guard.condition.tokens for guard in compared.setting.guards]
    named = [
        Number(name, value, tuple(i for i, each in enumerate(tokens) if name in each))
        for name, value in values.items()
        if name not in read
    ]
    bare = [
        Number(token, float(token), (index,), place)
        for index, each in enumerate(tokens)
        for place, token in enumerate(each)
        if _is_number(token) and each[place + 1 : place + 2] != ("pow",)
    ]
    return [each for each in (*named, *bare) if each.guards]


def _held(compared: Compared, needs: Needs) -> dict[str, float]:
    """The constants and the controls that stay as they are, with their values."""
    values = {each.name: each.value for each in compared.setting.program.constants}
    return values | {each.name: each.value for each in needs.inputs if each.series is None}


def _is_number(token: str) -> bool:
    try:
        float(token)
    except ValueError:
        return False
    return True


def _threshold(compared: Compared, number: Number) -> Threshold | None:
    """None where no switch tells the number, or it is not shown to be another one."""
    told = {guard: _told(compared, number, guard) for guard in number.guards}
    told = {guard: each for guard, each in told.items() if len(each[0])}
    if not told:
        return None
    values, doubts = (np.concatenate([each[i] for each in told.values()]) for i in (0, 1))
    bias = max(each[3] for each in told.values())
    mean = mean_of(values - number.spec, doubts, 0.0, bias)
    if mean.interval.low <= 0.0 <= mean.interval.high:
        return None
    near = {guard: agrees(each, number, mean) for guard, each in told.items()}
    if any(is_near is False for is_near in near.values()):
        return None
    mends = tuple(guard for guard, is_near in near.items() if is_near)
    return Threshold(number, mean, share_by_others(values - number.spec), mends)


def share_by_others(moved: Array) -> float:
    """What the mean of all others explains of each square (N,), together; 1 is all, N > 1.

    A value is N / (N - 1) times as far from the mean of the others as from the mean of all.
    """
    apart = len(moved) / (len(moved) - 1.0)
    square = float(np.mean(moved**2))
    return 1.0 - apart**2 * float(np.var(moved)) / max(square, 1e-300)


def agrees(told: Told, number: Number, mean: Mean) -> bool | None:
    """Whether a guard's own switches agree with the mean; None where they are too few to deny it.

    They do where they are off by no more than the tolerance, or by no more than the half-width of
    their own interval.
    """
    values, doubts, room, bias = told
    own = mean_of(values - number.spec, doubts, 0.0, bias)
    apart = abs(own.mean - mean.mean)
    if own.count < FEWEST:
        return True if apart <= room else None
    return apart <= max(room, 0.5 * (own.interval.high - own.interval.low))


def _taken(compared: Compared, guard: int) -> Integers:
    """The changes that took a guard, and whose states are told."""
    sorts = np.array([each.sort in SORTS for each in compared.switches], dtype=bool)
    good = sorts & compared.jumps.is_good & (compared.arrivals.guards == guard)
    return np.flatnonzero(good).astype(np.int64)


def _told(compared: Compared, number: Number, guard: int) -> Told:
    """By each switch of a guard: the number, its deviation; then what tolerances and stamps do."""
    setting, jumps = compared.setting, compared.jumps
    rows = _taken(compared, guard)
    code, names = _code(setting, number, guard)
    registers, rates = _registers(setting, compared, rows)
    step = NUDGE * (abs(number.spec) or 1.0)
    value = np.full(len(rows), number.spec)
    for _ in range(ROUNDS):
        high, low = (_guard(code, names, registers[0], number, value + d) for d in (step, -step))
        slope = (high - low) / (2.0 * step)
        here = _guard(code, names, registers[0], number, value)
        with np.errstate(divide="ignore", invalid="ignore"):
            value = value - here / slope
    here = _guard(code, names, registers[0], number, value)
    by_start = np.array([_guard(code, names, each, number, value) for each in registers[1:-1]])
    slopes = (by_start - here).T / jumps.before.nudge[rows]
    rise = (_guard(code, names, registers[-1], number, value) - here) / (LITTLE * setting.lead)
    variance = np.einsum("ki,kij,kj->k", slopes, jumps.before.covariance[rows], slopes)
    variance = variance + rise**2 * jumps.shift_variance[rows]
    with np.errstate(divide="ignore", invalid="ignore"):
        doubt = np.sqrt(np.maximum(variance, 0.0)) / np.abs(slope)
        room = room_at(setting, jumps.before.states[0][rows], jumps.before.at[rows])[:, guard]
        room, rise = room / np.abs(slope), np.abs(rise / slope)
    good = np.isfinite(value) & np.isfinite(doubt) & np.isfinite(rates)
    bias = bias_of(compared, rows, guard) * float(np.mean(rise[good])) if np.any(good) else 0.0
    typical = float(np.median(room[good])) if np.any(good) else 0.0
    return value[good], doubt[good], typical, bias


def _code(setting: Setting, number: Number, guard: int) -> tuple[Code, tuple[str, ...]]:
    """The guard, its bare number under a name of its own, and the names of the register."""
    tokens, names = setting.guards[guard].condition.tokens, setting.program.register
    if number.is_bare:
        tokens = (*tokens[: number.place], BARE, *tokens[number.place + 1 :])
    return Code(" ".join(tokens)), (*names, BARE)


def _guard(
    code: Code, names: tuple[str, ...], register: Array, number: Number, value: Array
) -> Array:
    """The guard (K,) at registers (K, r + 1) with another value (K,) of the number."""
    other = np.array(register)
    other[:, -1 if number.is_bare else names.index(number.name)] = value
    return evaluate([code], names, other)[:, 0]


def _registers(setting: Setting, compared: Compared, rows: Integers) -> tuple[Array, Array]:
    """The registers (1 + D + 1, K, r + 1) at the switches; and how fast the states move (K,).

    As fitted, from nudged starts, and a little later at the present rates.
    """
    jumps = compared.jumps
    at, modes = jumps.before.at[rows], setting.changes.left[rows].astype(np.float64)
    inputs = inputs_at(setting, np.maximum(at - 1, 0)[:, None], modes)[:, 0]
    states = jumps.before.states[:, rows]
    rates = rates_at(setting, states[0], inputs)
    states = states + rates * jumps.shift[rows][:, None]
    states = np.concatenate([states, states[:1] + LITTLE * setting.lead * rates])
    columns = setting.model.grid.columns
    found = np.stack([register_under(setting.flow, each, inputs, columns) for each in states])
    spare = np.zeros((*found.shape[:-1], 1))
    return np.concatenate([found, spare], axis=-1), np.max(np.abs(rates), axis=1)
