"""What was recorded of each node of an architecture, and the node judged by it.

A behavior samples its states at its ticks: as a trace they are the measured ones, and they are
judged where it had its way. An arbiter's inputs and choice at its ticks are its decisions.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.arrays import Array, Booleans
from runtime.code import Code
from runtime.program import Binding, Control, Kind, Program, State, Unit
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.reader import CHOICE
from verifier.examination import examine
from verifier.report.examination import Examination
from verifier.traces.trace import Series, Trace

HAS_ITS_WAY: Final = "has_its_way"
"""The signal that `judge_when` of a recorded behavior reads."""
RECORDED: Final = "recorded"


@final
@dataclass(frozen=True, eq=False, slots=True)
class NodeRecord:
    """The ticks of one node of one robot.

    times: (T,) seconds, strictly increasing. columns: (T,) SI by the names of what it sampled: of
    a behavior states and controls, of an arbiter reads and controls. free: (T,) where it had its
    way from that tick on. chosen: (T,) of an arbiter, -1 where it chose nothing.
    """

    name: str
    times: Array
    columns: dict[str, Array]
    free: Booleans
    chosen: Array | None = None


def examine_behavior(
    program: Program, record: NodeRecord, source: str, *, only_verdict: bool = False
) -> Examination:
    """The behavior judged where it had its way; its own `judge_when` is for other logs.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    variables: tuple[State | Control, ...] = (*program.states, *program.controls)
    named = [each for each in variables if each.name in record.columns]
    periods = {s.name: s.high - s.low for s in program.states if s.kind is Kind.PERIODIC}
    series = {each.name: _series(each.name, record, periods) for each in named}
    free = record.free.astype(float)
    series[HAS_ITS_WAY] = Series(HAS_ITS_WAY, record.times, free, HAS_ITS_WAY, RECORDED)
    bindings = [_binding(each.name, each.unit, each.origin) for each in named]
    judged = replace(
        program,
        bindings=(*bindings, _binding(HAS_ITS_WAY, Unit("1", 1.0), program.source.file)),
        judge_when=Code(HAS_ITS_WAY),
    )
    return examine(judged, _trace(series, record, source), only_verdict=only_verdict)


def examine_decisions(
    arbiter: Arbiter,
    record: NodeRecord,
    source: str,
    running: Callable[[Array, float], Array] | None = None,
    *,
    only_verdict: bool = False,
) -> Examination:
    """The arbiter judged at each of its ticks at which it was free to choose."""
    assert record.chosen is not None, "an arbiter chooses"
    chosen = np.where(record.free, record.chosen, -1.0)
    names = [*(read.name for read in arbiter.reads), *(each.name for each in arbiter.controls)]
    series = {name: _series(name, record, {}) for name in names if name in record.columns}
    series[CHOICE] = Series(CHOICE, record.times, chosen, f"{record.name}.{CHOICE}", RECORDED)
    own = replace(arbiter, judge_when=None)
    trace = _trace(series, record, source)
    made = judge_arbiter(own, trace, running, only_verdict=only_verdict)
    origins = {"fidelity": made.section.origin}
    return Examination(made.report, origins=origins, arbitration=made.section)


def _series(name: str, record: NodeRecord, periods: dict[str, float]) -> Series:
    values = record.columns[name]
    if name in periods:
        values = np.unwrap(values, period=periods[name])
    return Series(name, record.times, values, f"{record.name}.{name}", RECORDED)


def _binding(name: str, unit: Unit, origin: str) -> Binding:
    return Binding(name, name, unit, 0.0, 1.0, 0.0, None, (), origin)


def _trace(series: dict[str, Series], record: NodeRecord, source: str) -> Trace:
    start = float(record.times[0]) if record.times.size else 0.0
    moved = {name: replace(each, times=each.times - start) for name, each in series.items()}
    return Trace(f"{source}: {record.name}", moved, {}, start, (), ())
