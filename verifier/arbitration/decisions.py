"""The decisions of a log, and what was read at each of them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arrays import Array, Booleans, Integers
from runtime.machine import evaluate
from spec_schema.diagnostics import SpecError
from verifier.arbitration.reader import CHOICE
from verifier.report.report import Exclusion
from verifier.traces.faults import file_fault
from verifier.traces.trace import Series, Trace

STALE: Final = 5.0
"""What was read last so many usual periods ago is not what the robot decided by."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Decisions:
    """T decisions in order. times (T,) seconds; register (T, r) as the arbiter's, SI.

    chosen: (T,) the robot's choices. judged: (T,) which of them are held against the spec; the
    others are followed, because what is latched goes on.
    """

    times: Array
    register: Array
    chosen: Integers
    judged: Booleans
    exclusions: tuple[Exclusion, ...]

    @property
    def period(self) -> float:
        """The usual time between two decisions."""
        return float(np.median(np.diff(self.times))) if self.times.size > 1 else 0.0


def decisions_of(arbiter: Arbiter, trace: Trace) -> Decisions:
    """The robot's decisions, with the latest readings before each.

    Raises:
        SpecError: the choice, or something that is read, is not in the log (V310).
    """
    _refuse_unbound(arbiter, trace)
    choice = trace.series[CHOICE]
    times = choice.times
    register, known = _register(arbiter, trace, times)
    chosen = np.asarray(choice.values, dtype=np.int64)
    is_choice = (chosen >= 0) & (chosen < len(arbiter.choices))
    allowed = _allowed(arbiter, trace, register, times)
    period = float(np.median(np.diff(times))) if times.size > 1 else 0.0
    causes = (
        ("what it chose is none of the spec's choices", ~is_choice),
        ("something that it reads was not logged then", is_choice & ~known),
        ("judge_when does not hold", is_choice & known & ~allowed),
    )
    exclusions = tuple(
        Exclusion(cause, period * int(out.sum()), int(out.sum()))
        for cause, out in causes
        if out.any()
    )
    judged = is_choice & known & allowed
    return Decisions(times, register, chosen, judged, exclusions)


def _refuse_unbound(arbiter: Arbiter, trace: Trace) -> None:
    wanted = [CHOICE, *(read.name for read in arbiter.reads)]
    missing = [n for n in wanted if n not in trace.series and n not in trace.constants]
    if missing:
        message = f"nothing in the log is bound to '{missing[0]}'"
        remedy = f"write trace: {{{missing[0]}: WHERE IT STANDS IN THE LOG}}"
        error: SpecError = file_fault(Path(arbiter.source.file), "V310", message, remedy)
        raise error


def _register(arbiter: Arbiter, trace: Trace, times: Array) -> tuple[Array, Booleans]:
    """The register (T, r) at the decisions, and whether all of it is known."""
    columns, known = [], np.ones(times.shape, dtype=np.bool_)
    for read in arbiter.reads:
        if read.name in trace.constants:
            columns.append(np.full(times.shape, trace.constants[read.name]))
            continue
        values, fresh = _latest(trace.series[read.name], times)
        if read.kind.value == "periodic":
            values = read.low + np.mod(values - read.low, read.high - read.low)
        columns.append(values)
        known &= fresh
    for control in arbiter.controls:
        if control.name in trace.series:
            columns.append(_latest(trace.series[control.name], times)[0])
        else:
            held = trace.constants.get(control.name, control.default)
            columns.append(np.full(times.shape, held))
    columns += [np.full(times.shape, constant.value) for constant in arbiter.constants]
    register = np.stack(columns, axis=1) if columns else np.zeros((len(times), 0))
    return register, known


def _latest(series: Series, times: Array) -> tuple[Array, Booleans]:
    """The last value at or before each instant, and whether it is fresh."""
    place = np.searchsorted(series.times, times, "right") - 1
    values = series.values[np.maximum(place, 0)]
    usual = float(np.median(np.diff(series.times))) if series.times.size > 1 else np.inf
    age = times - series.times[np.maximum(place, 0)]
    return values, (place >= 0) & (age <= STALE * usual)


def _allowed(arbiter: Arbiter, trace: Trace, register: Array, times: Array) -> Booleans:
    """Where the arbiter's `judge_when` holds; a signal's last value counts."""
    if arbiter.judge_when is None:
        return np.ones(times.shape, dtype=np.bool_)
    tokens = set(arbiter.judge_when.tokens)
    signals = [s for s in trace.series.values() if s.name in tokens - set(arbiter.register)]
    columns = [_latest(signal, times)[0][:, None] for signal in signals]
    names = (*arbiter.register, *(signal.name for signal in signals))
    values = evaluate([arbiter.judge_when], names, np.hstack([register, *columns]))
    allowed: Booleans = values[:, 0] != 0.0
    return allowed
