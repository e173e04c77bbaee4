"""What of a trace a verification needs, and what of it is there.

The driven states are predicted and compared. Everything else that the field reads (controls,
sensed-only states, discrete states) is an *input*: taken from the trace and held until its next
sample (zero-order hold). What the field does not read is not needed.
"""

from dataclasses import dataclass, replace
from typing import assert_never, final

import numpy as np

from runtime.arrays import Array
from runtime.code import Code
from runtime.program import Control, Kind, Program, State
from verifier.fidelity.stretches.changes import Changes, changes_in, halved, merged, no_changes
from verifier.fidelity.stretches.leaps import leaps_in
from verifier.traces.trace import Series, Trace


@final
@dataclass(frozen=True, slots=True)
class Input:
    """An input of the field: the register's `column`, and where its values come from.

    low, high: its domain, infinite where it has no ends.
    series is None for a constant; `value` is that constant. is_known is False where the trace
    neither holds nor declares it, and `value` is only the spec's default.
    is_sensed: a sensed-only quantity that the trace holds.
    """

    name: str
    column: int
    series: Series | None
    value: float
    low: float
    high: float
    is_known: bool
    is_sensed: bool

    @property
    def is_noisy(self) -> bool:
        """Whether the noise of its measurement reaches the prediction.

        It does not where the robot acted on these very values: then what looks like noise acted.
        """
        return self.is_sensed and self.series is not None and not self.series.was_acted_on


@final
@dataclass(frozen=True, slots=True)
class Needs:
    """The predicted states with their series, the inputs, and the signals of `judge_when`.

    columns: where each predicted state stands in the state vector. A signal's `column` is -1.
    missing: predicted states that the trace does not hold.
    leaps: switches of a mode to itself, told by the jumps of states.
    """

    columns: tuple[int, ...]
    driven: tuple[State, ...]
    series: tuple[Series, ...]
    inputs: tuple[Input, ...]
    signals: tuple[Input, ...]
    missing: tuple[str, ...]
    leaps: Changes

    @property
    def base(self) -> int:
        """Which predicted state is sampled slowest: its samples are the time base."""
        periods = [period_of(series.times) for series in self.series]
        return int(np.argmax(periods))

    @property
    def unknown(self) -> tuple[Input, ...]:
        """Inputs and signals that the trace does not tell."""
        return tuple(each for each in (*self.inputs, *self.signals) if not each.is_known)


def needs_of(program: Program, trace: Trace) -> Needs:
    """What verifying `program` needs, found in `trace`."""
    predicted = [
        (column, state)
        for column, state in enumerate(program.states)
        if state.is_driven and state.kind is not Kind.DISCRETE
    ]
    present = [(c, s) for c, s in predicted if _series(trace, s.name) is not None]
    needs = Needs(
        columns=tuple(column for column, _ in present),
        driven=tuple(state for _, state in present),
        series=tuple(trace.series[state.name] for _, state in present),
        inputs=_inputs(program, trace, {column for column, _ in predicted}),
        signals=_signals(program, trace),
        missing=tuple(s.name for _, s in predicted if _series(trace, s.name) is None),
        leaps=no_changes(),
    )
    return replace(needs, leaps=_leaps(program, needs))


def parts_of(program: Program) -> dict[str, State | Control]:
    """The states and controls by name."""
    states: dict[str, State | Control] = {state.name: state for state in program.states}
    return states | {control.name: control for control in program.controls}


def names_read(program: Program) -> set[str]:
    """The names that the field depends on."""
    field = program.field
    coefficients = tuple(term.coefficient for term in field.terms)
    coordinates = tuple(coordinate.code for coordinate in field.coordinates)
    axes = {axis.name for table in field.tables for axis in table.axes}
    return axes | _tokens((*(field.formula or ()), *coefficients, *coordinates))


def names_guarded(program: Program) -> set[str]:
    """The names that guards and their resets depend on."""
    guards = program.field.guards
    resets = (code for guard in guards for _, code in guard.resets)
    return _tokens((*(guard.condition for guard in guards), *resets))


def changes_of(program: Program, needs: Needs) -> Changes:
    """All switches: changes of the measured mode, and those of a mode to itself."""
    mode = mode_of(program, needs)
    return merged(changes_in(None if mode is None else mode.series), needs.leaps)


def mode_of(program: Program, needs: Needs) -> Input | None:
    """The input that tells the mode; None where there are no modes."""
    return next((each for each in needs.inputs if each.name == program.field.mode), None)


def held(series: Series, times: Array) -> Array:
    """The latest value at each time: zero-order hold; before the first sample, the first."""
    at = np.searchsorted(series.times, times, side="right") - 1
    return np.asarray(series.values[np.clip(at, 0, None)])


def period_of(times: Array) -> float:
    """The median distance of samples; infinite for fewer than two."""
    return float(np.median(np.diff(times))) if len(times) > 1 else np.inf


def _leaps(program: Program, needs: Needs) -> Changes:
    """The switches of a mode to itself, each in the middle of two samples of the time base."""
    if needs.missing or not any(guard.mode == guard.target for guard in program.field.guards):
        return no_changes()
    times = needs.series[needs.base].times
    register = {state.name: np.full(len(times), state.hold) for state in program.states}
    register |= {each.name: np.full(len(times), each.default) for each in program.controls}
    for state, series in zip(needs.driven, needs.series, strict=True):
        register[state.name] = np.interp(times, series.times, series.values)
    for each in needs.inputs:
        known = np.full(len(times), each.value)
        register[each.name] = known if each.series is None else held(each.series, times)
    values = np.stack(list(register.values()), axis=-1)
    count = len(program.states)
    steps, modes = leaps_in(program, times, values[:, :count], values[:, count:])
    doubt = times[steps + 1] - times[steps]
    return Changes(times[steps] + doubt / 2.0, doubt, modes, modes)


def _series(trace: Trace, name: str) -> Series | None:
    series = trace.series.get(name)
    return series if series is not None and len(series.times) > 0 else None


def _signals(program: Program, trace: Trace) -> tuple[Input, ...]:
    read = _tokens(_condition(program))
    names = [b.name for b in program.bindings if b.name in read - set(program.register)]
    return tuple(_input(trace, name, -1, None) for name in names)


def _inputs(program: Program, trace: Trace, predicted: set[int]) -> tuple[Input, ...]:
    parts: list[tuple[int, State | Control]] = [
        (column, state) for column, state in enumerate(program.states) if column not in predicted
    ]
    offset = len(program.states)
    parts += [(offset + i, control) for i, control in enumerate(program.controls)]
    read = names_read(program) | names_guarded(program) | _tokens(_condition(program))
    found = (_input(trace, part.name, column, part) for column, part in parts if part.name in read)
    return tuple(_with_changes_halved(each, program.field.mode) for each in found)


def _with_changes_halved(given: Input, mode: str) -> Input:
    if given.name != mode or given.series is None:
        return given
    return replace(given, series=halved(given.series))


def _condition(program: Program) -> tuple[Code, ...]:
    return () if program.judge_when is None else (program.judge_when,)


def _tokens(codes: tuple[Code, ...]) -> set[str]:
    return {token for code in codes for token in code.tokens}


def _input(trace: Trace, name: str, column: int, part: State | Control | None) -> Input:
    series = _series(trace, name)
    low, high = _domain(part)
    return Input(
        name=name,
        column=column,
        series=series,
        value=trace.constants.get(name, _assumed(part)),
        low=low,
        high=high,
        is_known=series is not None or name in trace.constants,
        is_sensed=isinstance(part, State) and part.kind is not Kind.DISCRETE and series is not None,
    )


def _assumed(part: State | Control | None) -> float:
    match part:
        case State():
            return part.hold
        case Control():
            return part.default
        case None:
            return np.nan
    assert_never(part)


def _domain(part: State | Control | None) -> tuple[float, float]:
    if part is None or (isinstance(part, State) and part.kind is not Kind.CONTINUOUS):
        return -np.inf, np.inf
    return part.low, part.high
