"""`fit`: from recordings to an edit of the spec that they were judged by.

Each recording is judged and diagnosed. What the diagnosis moved and the spec has a number for is
edited in the spec's text; the edited text is compiled, and judged by the same recordings.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, final

from spec_schema.load import Loaded
from spec_schema.source import Source
from specc.fitting.aims import Aims
from specc.fitting.cases import Case, Logs, Tell, logs_of
from specc.fitting.compiling import compiled
from specc.fitting.drawn import redrawn
from specc.fitting.fitted import Fitted, Outcome
from specc.fitting.moves import Move, moved, moves_of
from specc.fitting.own_text import own_text
from specc.fitting.pooling import pooled
from specc.fitting.reading import aims_of
from specc.spec_finding import find_spec
from specc.verifying import Clock, behavior_for_verify, refuse_code
from verifier.diagnosis.diagnose import diagnose
from verifier.report.report import Report, Standing, Verdict
from verifier.report.wording import listed

BY_HAND: Final = "specc verify says which numbers depart; edit them by hand, and compile the spec"


def fit(
    traces: Path | str | Sequence[Path | str],
    spec: Path | str | None = None,
    clock: Clock = "auto",
    *,
    strict: bool = False,
    anyway: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Fitted:
    """Move the spec's numbers to what the robot does, in its own text; writes nothing.

    The spec is found as `verify` finds it, for the first recording. `write` on the result
    replaces the file.

    Args:
        strict: any loss in a log is an error.
        anyway: edit even where the structure differs, or where something else explains as well.
        progress: is told what is done next, as a phrase.

    Raises:
        SpecError: the spec or a log can't be used, or the edited text can't (V371 to V373), or the
            spec's field is code (V336), which compiling the edited text would run.
    """
    tell = progress or _in_silence
    logs = logs_of(traces, clock, is_strict=strict)
    found = find_spec(logs.paths[0], None if spec is None else Path(spec), behavior_for_verify)
    loaded = own_text(found.program)
    refuse_code(loaded, "fit", BY_HAND)
    cases = logs.judged(found.program, tell)
    told = pooled([_aims(case, tell) for case in cases])
    moves = moves_of(loaded, told.aims)
    case = _Fit(found.how, loaded.source, cases, told, moves, ())
    if told.beyond or told.left or not moves:
        case = _with_vectors(case, loaded, logs, tell)
    return _ended(case, logs, tell, anyway=anyway)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Fit:
    """A fit on its way: what the recordings say, and what would be moved."""

    how: str
    source: Source
    cases: tuple[Case, ...]
    told: Aims
    moves: tuple[Move, ...]
    stays: tuple[str, ...]

    def ended(
        self, outcome: Outcome, edited: Source | None = None, after: tuple[Report, ...] = ()
    ) -> Fitted:
        """The result, with another text if one is given."""
        return Fitted(
            outcome=outcome,
            how=self.how,
            source=self.source,
            edited=edited or self.source,
            moves=self.moves,
            beyond=(*self.told.beyond, *self.told.by_hand),
            left=self.told.left,
            choices=self.told.choices,
            stays=self.stays,
            before=tuple(case.report for case in self.cases),
            after=after,
        )


def _aims(case: Case, tell: Tell) -> Aims:
    tell(f"{case.report.trace.source}, why it departs")
    trace, study = case.judged()
    diagnosis = diagnose(case.program, trace, study, case.report)
    return aims_of(case.program, diagnosis)


def _with_vectors(case: _Fit, loaded: Loaded, logs: Logs, tell: Tell) -> _Fit:
    """A drawn field can follow what no single number stands for.

    Numbers that were fitted beside what its vectors explain are left alone.
    """
    if all(each.report.verdict is Verdict.PASS for each in case.cases):
        return case
    found = redrawn(loaded, case.cases, logs, tell)
    if found is None or not found.moves:
        return case
    return replace(case, moves=found.moves, stays=found.stays, told=Aims(()))


def _ended(case: _Fit, logs: Logs, tell: Tell, *, anyway: bool) -> Fitted:
    """With the edited text and its verdicts, or with why there is none."""
    told = case.told
    if (told.beyond or told.left) and not (anyway and case.moves):
        return case.ended(Outcome.STRUCTURE_DIFFERS)
    if told.by_hand and not (anyway and case.moves):
        return case.ended(Outcome.BY_HAND)
    if told.choices and not (anyway and case.moves):
        return case.ended(Outcome.CANNOT_TELL)
    if not case.moves:
        return case.ended(_unmoved(case.cases))
    edited = moved(case.source, case.moves)
    _, program = compiled(edited)
    again = logs.judged_again(case.cases, program, tell)
    after = tuple(each.report for each in again)
    left = tuple(dict.fromkeys(sentence for each in again for sentence in _departures(each)))
    if left and not anyway:
        case = replace(case, told=replace(told, left=left))
        return case.ended(Outcome.STRUCTURE_DIFFERS, None, after)
    return case.ended(Outcome.MOVED, edited, after)


def _unmoved(cases: tuple[Case, ...]) -> Outcome:
    """What it means that no number would be moved."""
    failed = any(case.report.verdict is Verdict.FAIL for case in cases)
    return Outcome.NOTHING_MENDS_IT if failed else Outcome.NOTHING_TO_MOVE


def _departures(case: Case) -> tuple[str, ...]:
    """What the robot still does otherwise than the edited spec."""
    report, switching = case.report, case.switching
    found = [each.name for each in report.variables if each.standing is Standing.EXCEEDED]
    said = [f"{listed(found)} would still depart on {report.trace.source}"] if found else []
    if switching is not None and switching.standing is Standing.EXCEEDED:
        said.append(f"{switching.mode} would still change otherwise on {report.trace.source}")
    return tuple(said)


def _in_silence(_phase: str) -> None:
    """Nobody watches."""
