"""Recordings, each judged by one program."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Final, TypeAlias, final

from runtime.program import Program
from specc.verifying.trace import Clock
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.verify import judgement_of
from verifier.report.report import Report
from verifier.report.switching import Switching
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace

Tell: TypeAlias = Callable[[str], None]
Judged: TypeAlias = tuple[Trace, Study | None]
"""A recording, and how it was predicted; no study where nothing can be compared."""

ROOM: Final = 10_000_000
"""Numbers in the traces that are kept at once. With a trace goes its study, together about 35 bytes
a number. Recordings beyond are read again when they are asked for, which costs time, not memory."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Case:
    """One recording under one program.

    switching: its changes of mode, None where there are none to judge. again: reads and judges it
    once more. kept: what that gives, where there is room for it.
    """

    program: Program
    report: Report
    switching: Switching | None
    again: Callable[[], Judged]
    kept: Judged | None

    def judged(self) -> Judged:
        """The trace and its study, which are large; read anew where they were not kept."""
        return self.kept or self.again()


@final
@dataclass(frozen=True, slots=True)
class Logs:
    """The files, and how they are read."""

    paths: tuple[Path, ...]
    clock: Clock
    is_strict: bool

    def judged(self, program: Program, tell: Tell) -> tuple[Case, ...]:
        """All of them, read and judged by `program`; `tell` hears what is done.

        Raises:
            SpecError: a log can't be used, or the spec does not say what is faithful.
        """
        cases: list[Case] = []
        for path in self.paths:
            cases.append(self._case(path, program, self._read(path, program, tell), tell, cases))
        return tuple(cases)

    def judged_again(self, cases: Sequence[Case], program: Program, tell: Tell) -> tuple[Case, ...]:
        """The recordings of `cases` by another `program`; read anew only if need be.

        Raises:
            SpecError: a log can't be used.
        """
        found: list[Case] = []
        for path, case in zip(self.paths, cases, strict=True):
            kept = case.kept if _reads_alike(case.program, program) else None
            trace = self._read(path, program, tell) if kept is None else kept[0]
            found.append(self._case(path, program, trace, tell, found))
        return tuple(found)

    def _case(
        self, path: Path, program: Program, trace: Trace, tell: Tell, before: Sequence[Case]
    ) -> Case:
        """The trace judged, and kept with its study if it finds room beside those `before` it."""
        tell(f"{trace.source}, judging")
        found = judgement_of(program, trace)
        taken = sum(_numbers(case.kept[0]) for case in before if case.kept)
        has_room = taken + _numbers(trace) <= ROOM
        again = partial(self._judged, path, program, tell)
        kept = (trace, found.study) if has_room else None
        return Case(program, found.report, found.switching, again, kept)

    def _judged(self, path: Path, program: Program, tell: Tell) -> Judged:
        trace = self._read(path, program, tell)
        return trace, judgement_of(program, trace).study

    def _read(self, path: Path, program: Program, tell: Tell) -> Trace:
        tell(f"{path}, reading")
        return read_trace(path, program, self.clock, strict=self.is_strict)


def _numbers(trace: Trace) -> int:
    """How many numbers a trace holds."""
    return sum(series.times.size + series.values.size for series in trace.series.values())


def _reads_alike(one: Program, other: Program) -> bool:
    """Whether both make the same trace of a log: places in the text say nothing about that."""
    return all(
        [replace(each, origin="") for each in first] == [replace(each, origin="") for each in last]
        for first, last in (
            (one.states, other.states),
            (one.controls, other.controls),
            (one.bindings, other.bindings),
        )
    )


def logs_of(traces: Path | str | Sequence[Path | str], clock: Clock, *, is_strict: bool) -> Logs:
    """One file or several.

    Raises:
        ValueError: there is none.
    """
    paths = [traces] if isinstance(traces, Path | str) else list(traces)
    if not paths:
        raise ValueError("name at least one recording")
    return Logs(tuple(Path(path) for path in paths), clock, is_strict)
