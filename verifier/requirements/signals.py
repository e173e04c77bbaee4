"""Sampled quantities, and the margin of a predicate over them as a course with bounds.

A margin is exact where it is made of straight pieces of its quantities (sums, abs, min, max, clip
...); one that is curved is straight between the samples of its quantities.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.code import ARITY, Code
from runtime.machine import evaluate
from verifier.requirements.course import BEYOND, Course, negated

LONGEST_GAP: Final = 10.0
"""Between samples, in usual periods: a quantity that is silent for longer is not known there."""
KINKED: Final = frozenset({"lt", "le", "gt", "ge", "eq", "ne", "min", "max"})
NESTED: Final = 2
"""How often kinks are looked for again, now that others have their place."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Signal:
    """A quantity: `times` (T,) seconds, strictly increasing, and `values` (T,) in SI.

    is_held: a value stays until the next sample; else it moves straight to it. period: of one that
    wraps at low + period, else 0. is_discrete: its values are counts, or places among `labels`.
    """

    name: str
    times: Array
    values: Array
    is_held: bool = False
    period: float = 0.0
    low: float = 0.0
    is_discrete: bool = False
    labels: tuple[str, ...] = ()

    @property
    def usual_period(self) -> float:
        """The median time between samples."""
        return float(np.median(np.diff(self.times))) if self.times.size > 1 else 0.0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Span:
    """The time of a run, seconds: a requirement speaks from `start`, and nothing is after `end`."""

    start: float
    end: float


def span_of(signals: Sequence[Signal], end: float | None) -> Span:
    """From the first sample of any to the `end` that is known, or else to the last sample."""
    start = min(float(each.times[0]) for each in signals)
    last = max(float(each.times[-1]) for each in signals)
    return Span(start, last if end is None else end)


def margins(
    code: Code, quantities: Sequence[str], signals: Mapping[str, Signal], span: Span
) -> tuple[Course, Course]:
    """The margin's lower and upper bound: one course, but apart where a quantity is not known."""
    read = [signals[name] for name in dict.fromkeys(names_in(code, quantities))]
    times, before, after = _sampled(code, quantities, read, span)
    known = _known(times[:-1], times[1:], read)
    known &= np.isfinite(after[:-1]) & np.isfinite(before[1:])
    lower = _bounded(times, before, after, known, span)
    upper = negated(_bounded(times, -before, -after, known, span))
    return lower, upper


def names_in(code: Code, quantities: Sequence[str]) -> tuple[str, ...]:
    """The quantities that the code reads."""
    tokens = set(code.tokens)
    return tuple(name for name in quantities if name in tokens)


def _sampled(
    code: Code, quantities: Sequence[str], read: Sequence[Signal], span: Span
) -> tuple[Array, Array, Array]:
    """Times that hold every sample and kink, and the margin's limits from both sides there."""
    ends = [np.array([span.start, span.end])]
    edges = [np.array([s.times[0] - s.usual_period, _until(s)]) for s in read]
    times = np.unique(np.concatenate([*ends, *edges, *(s.times for s in read)]))
    times = times[(times >= span.start) & (times <= span.end)]
    kinks = tuple(_kinks(code))
    for _ in range(NESTED if kinks else 0):
        before, after = _limits(kinks, quantities, read, times)
        times = np.union1d(times, _zeros(times, before, after))
    before, after = _limits((code,), quantities, read, times)
    return times, before[:, 0], after[:, 0]


def _limits(
    codes: Sequence[Code], quantities: Sequence[str], read: Sequence[Signal], times: Array
) -> tuple[Array, Array]:
    """The values of the codes (T, k) as `times` are reached from both sides."""
    both = []
    for side in ("left", "right"):
        register = np.full((times.size, len(quantities)), np.nan)
        for signal in read:
            register[:, quantities.index(signal.name)] = _values(signal, times, side == "left")
        both.append(evaluate(codes, tuple(quantities), register))
    return both[0], both[1]


def _values(signal: Signal, times: Array, is_left: bool) -> Array:  # noqa: FBT001  of two sides
    """The quantity's limits from one side; the nearest sample's beyond its samples."""
    place = np.searchsorted(signal.times, times, "left" if is_left else "right") - 1
    held: Array = signal.values[np.clip(place, 0, signal.values.size - 1)]
    if signal.is_held:
        return held
    moved: Array = np.interp(times, signal.times, signal.values)
    if signal.period > 0.0:
        then = signal.values[np.clip(place + 1, 0, signal.values.size - 1)]
        return np.where(np.abs(then - held) > 0.5 * signal.period, held, moved)
    return moved


def _zeros(times: Array, before: Array, after: Array) -> Array:
    """Where one of the courses (T, k) crosses zero between two of `times`."""
    start, end = after[:-1], before[1:]
    piece, which = np.nonzero(np.sign(start) * np.sign(end) < 0.0)
    share = start[piece, which] / (start[piece, which] - end[piece, which])
    zeros: Array = times[piece] + share * (times[piece + 1] - times[piece])
    return zeros


def _kinks(code: Code) -> Iterator[Code]:
    """Expressions at whose zeros the code has a kink or a jump."""
    stack: list[str] = []
    for word in code.tokens:
        operands = [stack.pop() for _ in range(ARITY.get(word, 0))][::-1]
        if word in {"abs", "sign"}:
            yield Code(operands[0])
        elif word in KINKED:
            yield Code(f"{operands[0]} {operands[1]} sub")
        elif word == "clip":
            yield Code(f"{operands[0]} {operands[1]} sub")
            yield Code(f"{operands[0]} {operands[2]} sub")
        stack.append(" ".join([*operands, word]))


def _until(signal: Signal) -> float:
    """Until when its last sample holds: as long as its samples usually do."""
    return float(signal.times[-1]) + signal.usual_period


def _known(starts: Array, ends: Array, read: Sequence[Signal]) -> Booleans:
    """Which pieces of time all quantities are known in."""
    known = np.ones(starts.shape, dtype=np.bool_)
    middle = 0.5 * (starts + ends)
    for signal in read:
        period = signal.usual_period
        known &= middle >= signal.times[0] - period
        if signal.is_held:
            continue
        known &= middle <= _until(signal)
        place = np.searchsorted(signal.times, middle)
        within = (place > 0) & (place < signal.times.size)
        place = np.clip(place, 1, signal.times.size - 1)
        gap = signal.times[place] - signal.times[place - 1]
        known &= ~within | (gap <= LONGEST_GAP * period)
    return known


def _bounded(times: Array, before: Array, after: Array, known: Booleans, span: Span) -> Course:
    """The lower bound: the margin where it is known, else -BEYOND, as after the run."""
    pad = 1e-13 * max(1.0, abs(span.end))
    lowest = np.full(times.size + 1, -BEYOND)
    start, end = lowest.copy(), lowest.copy()
    start[:-2][known] = np.clip(after[:-1][known], -BEYOND, BEYOND)
    end[1:-1][known] = np.clip(before[1:][known], -BEYOND, BEYOND)
    if (known.size == 0 or known[-1]) and np.isfinite(after[-1]):
        start[-2] = end[-1] = np.clip(after[-1], -BEYOND, BEYOND)
    end[0] = start[0]
    return Course(np.append(times, times[-1] + pad), end, start)
