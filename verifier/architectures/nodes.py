"""What was recorded of each node of an architecture, and the node judged by it.

A behavior samples its states at its ticks: as a trace they are the measured ones, and they are
judged where it had its way. An arbiter's inputs and choice at its ticks are its decisions.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.architecture import Architecture, Outside
from runtime.arrays import Array, Booleans
from runtime.code import Code
from runtime.program import Binding, Control, Kind, Program, State, Unit
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.numbers import Running
from verifier.arbitration.reader import CHOICE
from verifier.architectures.telling import (
    BEYOND_DOMAIN,
    INHIBITED,
    OVERRULED,
    told_of_node,
    with_touches,
    without_logs,
)
from verifier.examination import explain
from verifier.fidelity.verify import Judgement, judgement_of
from verifier.report.examination import Depth, Examination
from verifier.report.wording import listed
from verifier.traces.trace import TICKS, Loss, Series, Trace

HAS_ITS_WAY: Final = "has_its_way"
"""The signal that `judge_when` of a recorded behavior reads."""
UNMEASURED: Final = "is not measured: the robot reckons it by itself, so nothing is said of it"


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeRecord:
    """The ticks of one node of one robot.

    times: (T,) seconds, strictly increasing. columns: (T,) SI by the names of what it sampled: of
    a behavior states and controls, of an arbiter reads and controls. held_back: by cause, (T,)
    from which ticks on what the robot does is not, or not fully, its doing. chosen: (T,) of an
    arbiter, -1 where it chose nothing. losses: of the recording. unmeasured: states of a behavior
    that nothing in the recording measures: they are its own reckoning. touches: (T,) whether the
    body touches something; None where that is not known.
    """

    name: str
    times: Array
    columns: dict[str, Array]
    held_back: dict[str, Booleans] = field(default_factory=dict)
    chosen: Array | None = None
    losses: tuple[Loss, ...] = ()
    unmeasured: tuple[str, ...] = ()
    touches: Booleans | None = None

    @property
    def free(self) -> Booleans:
        """(T,) where it had its way from that tick on."""
        out = np.zeros(self.times.size, dtype=np.bool_)
        for flags in self.held_back.values():
            out |= flags
        return ~out


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeExamination:
    """What a behavior's record shows, and the program and judgement that it rests on."""

    program: Program
    examination: Examination
    judgement: Judgement


def held_back(
    architecture: Architecture,
    place: int,
    columns: Mapping[str, Array],
    acts: Booleans,
    free: Booleans,
) -> dict[str, Booleans]:
    """By cause, at which ticks (T,) a behavior has not its way, each tick under its first cause.

    acts, free: (T,) whether it acts, and whether nobody else moves what it moves.
    """
    found = {INHIBITED: ~acts, OVERRULED: acts & ~free}
    taken = ~free
    for name, flags in _clipped(architecture, place, columns).items():
        found[f"{name} {BEYOND_DOMAIN}"] = flags & ~taken
        taken = taken | flags
    return found


def _clipped(
    architecture: Architecture, place: int, columns: Mapping[str, Array]
) -> dict[str, Booleans]:
    """By state, where its reading stands at an edge of its domain that the signal can leave."""
    node = architecture.nodes[place]
    if node.behavior < 0:
        return {}
    states = {state.name: state for state in architecture.programs[node.behavior].states}
    found: dict[str, Booleans] = {}
    for wire in node.inputs:
        state = states.get(wire.entry)
        if state is None or wire.signal < 0 or wire.outside is not Outside.CLIP:
            continue
        if state.kind is not Kind.CONTINUOUS:
            continue
        signal, values = architecture.board[wire.signal], columns[state.name]
        ends = sorted((wire.scale * signal.low, wire.scale * signal.high))
        below = (values <= state.low) & (ends[0] < state.low)
        found[state.name] = below | ((values >= state.high) & (ends[1] > state.high))
    return found


def examine_behavior(
    program: Program, record: NodeRecord, source: str, *, depth: Depth = "all"
) -> NodeExamination:
    """The behavior judged where it had its way; its own `judge_when` is for other logs.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351), or nothing
            measures it (V391).
    """
    judged, trace = _as_log(_of_measured(program, record), record, source)
    judgement = judgement_of(judged, trace)
    told = told_of_node(judgement.report, record.times, record.held_back)
    if record.touches is not None:
        told = with_touches(told, record.times, record.free, record.touches)
    judgement = replace(judgement, report=told)
    notes = (*(f"{name} {UNMEASURED}" for name in record.unmeasured), *judgement.report.notes)
    judgement = replace(judgement, report=replace(judgement.report, notes=notes))
    made = explain(judged, trace, judgement, _in_silence, depth=depth)
    return NodeExamination(judged, without_logs(made), replace(judgement, study=None))


def _of_measured(program: Program, record: NodeRecord) -> Program:
    """The program without tolerances for what nothing measures.

    Raises:
        SpecError: then nothing of it is left to be judged (V391).
    """
    fidelity = program.fidelity
    if fidelity is None or not fidelity.tolerance.keys() & set(record.unmeasured):
        return program
    kept = {k: v for k, v in fidelity.tolerance.items() if k not in record.unmeasured}
    if not kept:
        message = f"{listed(sorted(fidelity.tolerance))} {UNMEASURED}"
        place = Source(program.source.file, program.source.text)
        raise SpecError([Diagnostic("V391", Severity.ERROR, message, place, None)])
    return replace(program, fidelity=replace(fidelity, tolerance=kept))


def _as_log(program: Program, record: NodeRecord, source: str) -> tuple[Program, Trace]:
    """The record as a log, and the program as one that is judged by it."""
    variables: tuple[State | Control, ...] = (*program.states, *program.controls)
    named = [each for each in variables if each.name in record.columns]
    periods = {s.name: s.high - s.low for s in program.states if s.kind is Kind.PERIODIC}
    series = {each.name: _series(each.name, record, periods) for each in named}
    free = _within_modes(program, record).astype(float)
    series[HAS_ITS_WAY] = Series(HAS_ITS_WAY, record.times, free, HAS_ITS_WAY, TICKS)
    bindings = [_binding(each.name, each.unit, each.origin) for each in named]
    judged = replace(
        program,
        bindings=(*bindings, _binding(HAS_ITS_WAY, Unit("1", 1.0), program.source.file)),
        judge_when=Code(HAS_ITS_WAY),
    )
    return judged, _trace(series, record, source)


def _within_modes(program: Program, record: NodeRecord) -> Booleans:
    """Where it had its way, without a step into a tick where it has not that changes the mode.

    A mode is changed at a tick by what is read there, and there it is no longer judged.
    """
    free = record.free
    modes = record.columns.get(program.field.mode)
    if modes is None or not free.size:
        return free
    changes = np.append(np.diff(modes) != 0.0, False)
    judged: Booleans = free & ~(changes & np.append(~free[1:], False))
    return judged


def examine_decisions(
    arbiter: Arbiter,
    record: NodeRecord,
    source: str,
    running: Running | None = None,
    *,
    depth: Depth = "all",
) -> Examination:
    """The arbiter judged at each of its ticks at which it was free to choose."""
    own, trace = decision_log(arbiter, record, source)
    made = judge_arbiter(own, trace, running, depth=depth)
    origins = {"fidelity": made.section.origin}
    return Examination(made.report, origins=origins, arbitration=made.section)


def decision_log(arbiter: Arbiter, record: NodeRecord, source: str) -> tuple[Arbiter, Trace]:
    """The record of an arbiter as a log, and the arbiter as one that is judged by it.

    Its own `judge_when` is for other logs; times count from its first tick, the trace's start.
    """
    assert record.chosen is not None, "an arbiter chooses"
    chosen = np.where(record.free, record.chosen, -1.0)
    names = [*(read.name for read in arbiter.reads), *(each.name for each in arbiter.controls)]
    series = {name: _series(name, record, {}) for name in names if name in record.columns}
    series[CHOICE] = Series(CHOICE, record.times, chosen, f"{record.name}.{CHOICE}", TICKS)
    return replace(arbiter, judge_when=None), _trace(series, record, source)


def _series(name: str, record: NodeRecord, periods: dict[str, float]) -> Series:
    values = record.columns[name]
    if name in periods:
        values = np.unwrap(values, period=periods[name])
    return Series(name, record.times, values, f"{record.name}.{name}", TICKS)


def _binding(name: str, unit: Unit, origin: str) -> Binding:
    return Binding(name, name, unit, 0.0, 1.0, 0.0, None, (), origin)


def _trace(series: dict[str, Series], record: NodeRecord, source: str) -> Trace:
    start = float(record.times[0]) if record.times.size else 0.0
    moved = {name: replace(each, times=each.times - start) for name, each in series.items()}
    return Trace(f"{source}: {record.name}", moved, {}, start, record.losses, ())


def _in_silence(_phase: str) -> None:
    """Nobody watches."""
