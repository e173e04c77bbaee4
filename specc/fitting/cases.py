"""Recordings, each judged by one program."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias, final

from runtime.program import Program
from specc.verifying import Clock
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.verify import judgement_of
from verifier.report.report import Report
from verifier.report.switching import Switching
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace

Tell: TypeAlias = Callable[[str], None]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Case:
    """One recording under one program; without a study where nothing can be compared.

    switching: its changes of mode, None where there are none to judge.
    """

    program: Program
    trace: Trace
    report: Report
    study: Study | None
    switching: Switching | None


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
        return tuple(self._read(path, program, tell) for path in self.paths)

    def judged_again(self, cases: Sequence[Case], program: Program, tell: Tell) -> tuple[Case, ...]:
        """The recordings of `cases` by another `program`; read anew only if it reads otherwise.

        Raises:
            SpecError: a log can't be used.
        """
        return tuple(
            _judged(program, case.trace, tell)
            if _reads_alike(case.program, program)
            else self._read(path, program, tell)
            for path, case in zip(self.paths, cases, strict=True)
        )

    def _read(self, path: Path, program: Program, tell: Tell) -> Case:
        tell(f"{path}, reading")
        trace = read_trace(path, program, self.clock, strict=self.is_strict)
        return _judged(program, trace, tell)


def _judged(program: Program, trace: Trace, tell: Tell) -> Case:
    tell(f"{trace.source}, judging")
    found = judgement_of(program, trace)
    return Case(program, trace, found.report, found.study, found.switching)


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
