"""Recordings, each judged by one program."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, final

from runtime.program import Program
from specc.verifying import Clock
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.verify import judged
from verifier.report.report import Report
from verifier.traces.read import read_trace
from verifier.traces.trace import Trace

Tell: TypeAlias = Callable[[str], None]


@final
@dataclass(frozen=True, eq=False, slots=True)
class Case:
    """One recording under one program; without a study where nothing can be compared."""

    program: Program
    trace: Trace
    report: Report
    study: Study | None


@final
@dataclass(frozen=True, slots=True)
class Logs:
    """The files, and how they are read."""

    paths: tuple[Path, ...]
    clock: Clock
    is_strict: bool

    def judged(self, program: Program, tell: Tell) -> tuple[Case, ...]:
        """All of them, judged by `program`; `tell` hears what is done.

        Raises:
            SpecError: a log can't be used, or the spec does not say what is faithful.
        """
        cases = []
        for path in self.paths:
            tell(f"{path}, reading")
            trace = read_trace(path, program, self.clock, strict=self.is_strict)
            tell(f"{path}, judging")
            report, study = judged(program, trace)
            cases.append(Case(program, trace, report, study))
        return tuple(cases)


def logs_of(traces: Path | str | Sequence[Path | str], clock: Clock, *, is_strict: bool) -> Logs:
    """One file or several.

    Raises:
        ValueError: there is none.
    """
    paths = [traces] if isinstance(traces, Path | str) else list(traces)
    if not paths:
        raise ValueError("name at least one recording")
    return Logs(tuple(Path(path) for path in paths), clock, is_strict)
