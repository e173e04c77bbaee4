"""The examination of a trace: the verdict, and what else the trace tells, put together.

This is the one place where the sections of a report meet. The verdict is the report's own; the
other sections explain it, say how far it reaches, and never make it better.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

from runtime.program import Program
from verifier.fidelity.verify import verify
from verifier.report.report import Report
from verifier.traces.trace import Trace


@final
@dataclass(frozen=True, eq=False, slots=True)
class Examination:
    """The report with its sections; one that was not computed, or has nothing to say, is None."""

    report: Report


def examine(
    program: Program,
    trace: Trace,
    *,
    only_verdict: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Examination:
    """Judge `trace` against `program`, and explain the judgement.

    Args:
        only_verdict: leave out all but the report.
        progress: is told what is done next, as a phrase, before each phase.

    Raises:
        SpecError: the spec does not say what it would be verified against (V351).
    """
    tell = progress or _in_silence
    tell("judging")
    report = verify(program, trace)
    if only_verdict:
        return Examination(report)
    # The sections are filled in here, each by its own room.
    return Examination(report)


def _in_silence(_phase: str) -> None:
    """Nobody watches."""
