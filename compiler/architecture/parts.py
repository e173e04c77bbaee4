"""The nodes of an architecture with what they name: what each reads, tells, and may be set to."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

from compiler.architecture.arbiters import lower_arbiter
from compiler.architecture.bodies import FAR, BodyPart, lower_body
from compiler.architecture.library import Library
from compiler.findings import Findings
from compiler.quantities import si_time, unit_of
from runtime.arbiter import Arbiter, Paradigm
from runtime.program import Control, Kind, Program, Role, State, Unit
from spec_schema.arbiter import ArbiterSpec
from spec_schema.architecture import ArchitectureSpec, NodeSpec
from spec_schema.body import BodySpec
from spec_schema.diagnostics import Diagnostic
from spec_schema.load import Loaded
from spec_schema.places import Path


@final
@dataclass(frozen=True, slots=True)
class Entry:
    """Something of a node that a wire can lead to; `unit` is None where it has none of its own."""

    name: str
    unit: Unit | None
    low: float
    high: float
    kind: Kind
    values: tuple[str, ...]
    default: float | None


@final
@dataclass(frozen=True, eq=False, slots=True)
class Part:
    """A node, and what it names: a program, an arbiter, or neither where the file can't be used.

    warnings: of the behavior's own spec. period: seconds; 0 where it can't be told.
    """

    name: str
    spec: NodeSpec
    period: float
    response_time: float
    program: Program | None = None
    arbiter: Arbiter | None = None
    warnings: tuple[Diagnostic, ...] = ()
    reads: tuple[Entry, ...] = ()
    controls: tuple[Entry, ...] = ()
    tells: tuple[Entry, ...] = ()

    @property
    def path(self) -> Path:
        """Where it stands in the spec."""
        return ("nodes", self.name)

    @property
    def is_known(self) -> bool:
        """Whether what it names could be read."""
        return self.program is not None or self.arbiter is not None or self.spec.module is not None

    @property
    def lag(self) -> float:
        """The longest time (s) from a sample to the end of the action that answers it."""
        return self.period + self.response_time


@final
@dataclass(frozen=True, eq=False, slots=True)
class Parts:
    """An architecture with everything that it names.

    nodes: in the order of the spec.
    """

    spec: ArchitectureSpec
    loaded: Loaded
    body: BodyPart | None
    nodes: Mapping[str, Part] = field(default_factory=dict)

    def index(self, name: str) -> int:
        """The place of a node."""
        return list(self.nodes).index(name)


def gather(spec: ArchitectureSpec, loaded: Loaded, library: Library, findings: Findings) -> Parts:
    """The body and the nodes, with a finding for each file that can't be used."""
    body = library.lowered(loaded, ("body",), spec.body, BodySpec, lower_body, findings)
    nodes = {
        name: _part(name, node, loaded, library, findings) for name, node in spec.nodes.items()
    }
    return Parts(spec, loaded, body, nodes)


def _part(name: str, spec: NodeSpec, loaded: Loaded, library: Library, findings: Findings) -> Part:
    path: Path = ("nodes", name)
    period, response = _times(spec, path, findings)
    if spec.behavior is not None:
        found = library.behavior(loaded, (*path, "behavior"), spec.behavior, findings)
        if found is None:
            return Part(name, spec, period, response)
        program = found.program
        reads = tuple(_of_state(s) for s in program.states if is_read(s, program))
        return Part(
            name,
            spec,
            period,
            response,
            program=program,
            warnings=found.warnings,
            reads=reads,
            controls=tuple(map(_of_control, program.controls)),
            tells=tuple(_of_number(o.name, o.unit) for o in program.outputs),
        )
    if spec.arbiter is not None:
        arbiter = _arbiter(spec.arbiter, (*path, "arbiter"), loaded, library, findings)
        return _deciding(Part(name, spec, period, response), arbiter)
    return _module(name, spec, (period, response), path, findings)


def _arbiter(
    text: str, path: Path, loaded: Loaded, library: Library, findings: Findings
) -> Arbiter | None:
    found = library.spec(loaded, path, text, "arbiter", findings)
    if found is None or not isinstance(found.spec, ArbiterSpec):
        return None
    file = found.source.name
    if file not in library.arbiters:
        own = Findings(found)
        arbiter = lower_arbiter(found.spec, found, library, own)
        library.keep(found, own.diagnostics)
        library.arbiters[file] = None if own.has_errors else arbiter
    return library.arbiters[file]


def _deciding(part: Part, arbiter: Arbiter | None) -> Part:
    if arbiter is None:
        return part
    reads = tuple(
        Entry(
            read.name,
            _own(read.unit, read.values),
            read.low,
            read.high,
            read.kind,
            read.values,
            None,
        )
        for read in arbiter.reads
    )
    last = float(max(len(arbiter.choices) - 1, 0))
    tells = (
        *(_of_number(output.name, output.unit) for output in arbiter.outputs),
        *(Entry(c, Unit("1", 1.0), 0.0, FAR, Kind.CONTINUOUS, (), None) for c in arbiter.choices),
        Entry(
            "choice",
            None,
            _first(arbiter, part.response_time),
            last,
            Kind.DISCRETE,
            arbiter.choices,
            None,
        ),
    )
    controls = tuple(map(_of_control, arbiter.controls))
    return Part(
        part.name,
        part.spec,
        part.period,
        part.response_time,
        arbiter=arbiter,
        reads=reads,
        controls=controls,
        tells=tells,
    )


def _first(arbiter: Arbiter, response_time: float) -> float:
    """The least that `choice` may be: -1 for none of them.

    It is 0 where one always holds, from 0 s on: an arbiter with a response time says nothing yet.
    """
    return 0.0 if holds_always(arbiter) and response_time == 0.0 else -1.0


def holds_always(arbiter: Arbiter) -> bool:
    """Whether one of its choices holds at each of its ticks."""
    return arbiter.paradigm is Paradigm.PLAN or any(rule.when is None for rule in arbiter.rules)


def _module(
    name: str, spec: NodeSpec, times: tuple[float, float], path: Path, findings: Findings
) -> Part:
    """A node of user code: it reads what it is wired to, in any unit."""
    tells = []
    for told, text in spec.tells.items():
        unit = unit_of(text, (*path, "tells", told), findings)
        if unit is not None:
            tells.append(_of_number(told, Unit(unit.text, unit.scale)))
    reads = tuple(Entry(read, None, -FAR, FAR, Kind.CONTINUOUS, (), None) for read in spec.sense)
    return Part(name, spec, *times, reads=reads, tells=tuple(tells))


def is_read(state: State, program: Program) -> bool:
    """Whether a state takes its value from a wire: it is sensed, and not the mode."""
    return state.role is not Role.DRIVEN and state.name != program.field.mode


def _of_state(state: State) -> Entry:
    unit = _own(state.unit, state.values)
    return Entry(state.name, unit, state.low, state.high, state.kind, state.values, None)


def _own(unit: Unit, values: tuple[str, ...]) -> Unit | None:
    return None if values else unit


def _of_control(control: Control) -> Entry:
    return Entry(
        control.name, control.unit, control.low, control.high, Kind.CONTINUOUS, (), control.default
    )


def _of_number(name: str, unit: Unit) -> Entry:
    return Entry(name, unit, -FAR, FAR, Kind.CONTINUOUS, (), None)


def _times(spec: NodeSpec, path: Path, findings: Findings) -> tuple[float, float]:
    period = si_time(spec.period, (*path, "period"), findings)
    if period is not None and period <= 0.0:
        message = f"a period must be above 0 (got {spec.period})"
        findings.error("S212", (*path, "period"), message, "write 'period: 50 ms'")
    response = si_time(spec.response_time, (*path, "response_time"), findings) or 0.0
    if response < 0.0:
        message = f"nothing acts before it samples (got {spec.response_time})"
        findings.error("S212", (*path, "response_time"), message, "write 0 or more")
    return max(period or 0.0, 0.0), max(response, 0.0)
