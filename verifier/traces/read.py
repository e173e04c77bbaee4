"""A log, read for one program: the pipeline from a file to a `Trace`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from runtime.program import Binding, Kind, Program, State
from spec_schema.diagnostics import Diagnostic, SpecError
from verifier.traces.bindings import Bound, resolve, texts_of, wanted_by
from verifier.traces.cleaning import Ordering, order
from verifier.traces.clock import Clock, choose_clocks, stamp_fault
from verifier.traces.faults import binding_diagnostic, file_diagnostic, file_fault
from verifier.traces.files.log import LogFile, MessageLog, Progress, Sheet
from verifier.traces.files.open_log import open_log
from verifier.traces.messages.columns import Column
from verifier.traces.messages.fields import FieldError
from verifier.traces.messages.paths import MessagePath
from verifier.traces.samples import Samples, check_topic, sample_sheet, sample_topic
from verifier.traces.trace import Loss, Series, Trace
from verifier.traces.values import Meaning, Measured, NotNumbersError, measured

_BLOCK = 1 << 16

ClockWish: TypeAlias = Literal["auto", "sensor", "log"]


def read_trace(
    path: Path,
    program: Program,
    clock: ClockWish = "auto",
    progress: Progress | None = None,
    *,
    strict: bool = False,
) -> Trace:
    """What the log says about the program's variables, in SI, with every loss counted.

    clock: which stamps are the times; `auto` takes the sensors' where that can be done for all
    topics on one clock. progress: is told now and then how many bytes of how many were read.
    strict: any loss is an error. Raises SpecError V301 to V313, all at once, where nothing can
    be judged.
    """
    bare = _read_bare(path, program, clock, progress)
    readings = _readings(program, bare)
    start = min((int(reading.times[0]) for reading in readings), default=0)
    losses = _losses(bare, readings)
    if strict:
        refuse_losses(path, losses)
    return Trace(
        source=str(path),
        series=_all_series(readings, start),
        constants={b.name: b.constant for b in program.bindings if b.constant is not None},
        start=start / 1e9,
        losses=losses,
        notes=_notes(bare, readings),
    )


def refuse_losses(path: Path, losses: Sequence[Loss]) -> None:
    """Stops where something of a log was lost.

    Raises:
        SpecError: it was (V313).
    """
    if losses:
        message = "the log is not whole, as --strict wants it"
        raise file_fault(path, "V313", message, _damage(losses))


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Run:
    """The usable samples of a topic in order, at `times` (k,) in nanoseconds of one clock.

    columns: of all samples; `ordering` says which of them are usable.
    """

    topic: str
    clock: Clock
    times: Integers
    ordering: Ordering
    columns: Mapping[str, Column]
    losses: tuple[Loss, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Bare:
    """What the log holds for the program, in its own units: a run of each topic.

    Of a long log the times on the other clock are not kept any longer than this takes to make.
    """

    bound: tuple[Bound, ...]
    runs: Mapping[str, _Run]
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Reading:
    """A variable's samples: times (k,) in nanoseconds, the binding's delay taken off.

    logged: see `Series`.
    """

    bound: Bound
    clock: Clock
    times: Integers
    values: Array
    losses: tuple[Loss, ...]
    notes: tuple[str, ...]
    logged: Array | None


def _read_bare(path: Path, program: Program, clock: ClockWish, progress: Progress | None) -> _Bare:
    """The log, read and put in order; raises SpecError."""
    log = open_log(path, wanted_by(program), progress)
    if isinstance(log, MessageLog) and not any(stream.count for stream in log.streams):
        raise _nothing(path, log.losses)
    bound = resolve(program, log)
    topics = _sample(program, log, bound)
    if clock == "sensor":
        _require_stamps(path, topics)
    # The time column of a sheet is all there is, and already noted.
    clocks = choose_clocks(tuple(topics.values()), "log" if isinstance(log, Sheet) else clock)
    runs = {name: _run(samples, clocks.of[name]) for name, samples in topics.items()}
    return _Bare(bound, runs, log.losses, (*log.notes, *clocks.notes))


def _sample(program: Program, log: LogFile, bound: Sequence[Bound]) -> dict[str, Samples]:
    """The samples of each bound topic; raises SpecError with the faults of all of them."""
    if isinstance(log, Sheet):
        return {log.name: sample_sheet(log, sorted({b.column for b in bound}))} if bound else {}
    problems: list[Diagnostic] = []
    topics: dict[str, Samples] = {}
    for topic in dict.fromkeys(one.topic for one in bound):
        streams = tuple(s for s in log.streams if s.channel.topic == topic and s.count)
        here = [one for one in bound if one.topic == topic and one.path]
        faults = [
            _field_diagnostic(program, one.binding, one.path, error)
            for one in here
            if one.path and (error := check_topic(streams, one.path))
        ]
        problems += faults
        if not faults and streams:
            topics[topic] = sample_topic(streams)
    if problems:
        raise SpecError(problems)
    return topics


def _field_diagnostic(
    program: Program, binding: Binding, path: MessagePath, error: FieldError
) -> Diagnostic:
    part = None if error.depth is None else path.part(error.depth)
    return binding_diagnostic(
        program, binding, error.code, error.message, help=error.help, part=part
    )


def _require_stamps(path: Path, topics: Mapping[str, Samples]) -> None:
    faults = {topic: stamp_fault(samples) for topic, samples in topics.items()}
    problems = [
        file_diagnostic(
            path, "V312", f"{topic}: {fault}", "take the log times instead (--clock log)"
        )
        for topic, fault in faults.items()
        if fault
    ]
    if problems:
        raise SpecError(problems)


def _run(samples: Samples, clock: Clock) -> _Run:
    times = samples.log_times
    usable = np.ones(times.size, dtype=np.bool_)
    if clock is Clock.SENSOR and samples.stamps is not None:
        times = samples.stamps
        usable = times > 0
    ordering = order(samples.topic, times, usable)
    return _Run(
        topic=samples.topic,
        clock=clock,
        times=times if ordering.rows is None else times[ordering.rows],
        ordering=ordering,
        columns=samples.columns,
        losses=(*samples.losses, *ordering.losses),
    )


def _readings(program: Program, bare: _Bare) -> list[_Reading]:
    readings: list[_Reading] = []
    problems: list[Diagnostic] = []
    for one in bare.bound:
        run = bare.runs.get(one.topic)
        try:
            reading = _reading(program, one, run) if run else None
        except NotNumbersError as error:
            problems.append(
                binding_diagnostic(program, one.binding, "V305", error.message, help=error.help)
            )
            continue
        if run is None or reading is None:
            message = f"the topic {one.topic} has no messages"
            lost = _damage(bare.losses)
        elif not reading.times.size:
            message = f"no usable sample stands at {one.binding.path}"
            lost = _damage([*bare.losses, *run.losses, *reading.losses])
        else:
            readings.append(reading)
            continue
        problems.append(binding_diagnostic(program, one.binding, "V306", message, help=lost))
    if problems:
        raise SpecError(problems)
    return readings


def _reading(program: Program, bound: Bound, run: _Run) -> _Reading:
    """The variable's samples."""
    state = next((s for s in program.states if s.name == bound.binding.name), None)
    found = _measured(program, bound, state, run)
    finite: Booleans = np.isfinite(found.values)
    whole = bool(finite.all())
    values = found.values if whole else found.values[finite]
    times = run.times if whole else run.times[finite]
    logged = None
    if state is not None and state.kind is Kind.PERIODIC:
        if values.size and (values.min() < state.low or values.max() > state.high):
            logged = values
        values = np.unwrap(values, period=state.high - state.low)
    # A delay of decades leaves nothing to compare, as does one of centuries.
    delay = round(min(max(bound.binding.delay, -1e9), 1e9) * 1e9)
    times = times - delay if delay else times
    return _Reading(bound, run.clock, times, values, found.losses, found.notes, logged)


def _measured(program: Program, bound: Bound, state: State | None, run: _Run) -> Measured:
    binding = bound.binding
    meaning = Meaning(
        texts=dict(binding.values or texts_of(state.values if state else ())),
        is_signal=binding.name not in program.register,
        derived=bound.derived,
    )
    column, rows = run.columns[bound.column], run.ordering.rows
    return measured(binding, meaning, column if rows is None else column.rows(rows))


def _all_series(readings: Sequence[_Reading], start: int) -> dict[str, Series]:
    """The series; those of one topic share their times where they can, which are many."""
    shared: dict[int, Array] = {}
    series = {}
    for reading in readings:
        key = id(reading.times)
        if key not in shared:
            shared[key] = _seconds(reading.times, start)
        binding = reading.bound.binding
        values = reading.values.view()
        values.setflags(write=False)
        series[binding.name] = Series(
            binding.name,
            shared[key],
            values,
            binding.path,
            str(reading.clock),
            reading.logged,
        )
    return series


def _seconds(times: Integers, start: int) -> Array:
    """Seconds since `start`, in an array that nobody can write to."""
    seconds = np.empty(times.size)
    for first in range(0, times.size, _BLOCK):
        block = slice(first, first + _BLOCK)
        seconds[block] = (times[block] - start) / 1e9
    seconds.setflags(write=False)
    return seconds


def _losses(bare: _Bare, readings: Sequence[_Reading]) -> tuple[Loss, ...]:
    by_topic = (loss for run in bare.runs.values() for loss in run.losses)
    by_variable = (loss for reading in readings for loss in reading.losses)
    return (*bare.losses, *by_topic, *by_variable)


def _nothing(path: Path, losses: Sequence[Loss]) -> SpecError:
    """A log without a message is at fault itself, whatever the spec wants of it."""
    if not losses:
        return file_fault(path, "V306", "the log holds no message")
    first = losses[0]
    message = f"no message of this log can be read: {first.cause}, {first.detail}"
    return file_fault(path, "V306", message, f"what was lost:\n{_damage(losses)}")


def _damage(losses: Sequence[Loss]) -> str:
    """The losses as help, one a line."""
    return "\n".join(f"{loss.cause}: {loss.count} ({loss.detail})" for loss in losses)


def _notes(bare: _Bare, readings: Sequence[_Reading]) -> tuple[str, ...]:
    notes = [*bare.notes]
    for run in bare.runs.values():
        notes += run.ordering.notes
        notes += _zero_note(run)
    for reading in readings:
        notes += reading.notes
    return tuple(notes)


def _zero_note(run: _Run) -> list[str]:
    """Samples in which all the numbers that are read are zero: often no measurement at all."""
    columns = [c.numbers for c in run.columns.values() if np.isfinite(c.numbers).any()]
    if len(columns) < 2:
        return []
    zero = int(np.count_nonzero(np.logical_and.reduce([column == 0.0 for column in columns])))
    whole = columns[0].size
    if not zero:
        return []
    return [f"{run.topic}: in {zero} of {whole} samples everything that is read is zero"]
