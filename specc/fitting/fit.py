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
from specc.fitting.aims import Aims, named
from specc.fitting.cases import Case, Logs, Tell, logs_of
from specc.fitting.compiling import compiled
from specc.fitting.drawn import redrawn
from specc.fitting.explanations import Explanation, explanations_of, pooled_explanations
from specc.fitting.fitted import Fitted, Outcome, joined
from specc.fitting.moves import Move, moved, moves_of
from specc.fitting.own_text import own_text
from specc.fitting.pooling import pooled
from specc.fitting.reading import aims_of
from specc.fitting.weighing import Weighed, as_good, passed_over, weighed
from specc.verifying.spec_finding import find_spec
from specc.verifying.trace import Clock, behavior_for_verify, refuse_code
from verifier.diagnosis.diagnose import diagnose
from verifier.report.diagnosis import Diagnosis
from verifier.report.report import Report, Standing, Verdict
from verifier.report.wording import listed

OF_READING: Final = ("unit", "scale")
"""Edits that decide whether a log can be compared at all: what was out of its domain is in it."""
ROUNDS: Final = 3
"""So often the text is edited, at most, where each edit lets more of the log be compared."""
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
    task = _Task(found.how, logs, tell, anyway)
    first = last = _round(task, loaded, logs.judged(found.program, tell))
    whole = first.fitted
    for _ in range(ROUNDS - 1):
        if last.fitted.outcome is not Outcome.MOVED or not _opens_more(last.fitted):
            break
        tell("fitting again, since more can be compared")
        last = _round(task, last.loaded, last.cases)
        whole = joined(whole, last.fitted)
    return whole


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Task:
    """What all rounds share."""

    how: str
    logs: Logs
    tell: Tell
    anyway: bool


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Round:
    """What one round came to; the text with its edits, and the recordings judged by it."""

    fitted: Fitted
    loaded: Loaded
    cases: tuple[Case, ...]


def _round(task: _Task, loaded: Loaded, cases: tuple[Case, ...]) -> _Round:
    """From the recordings as `loaded` has them judged to its edit."""
    diagnoses = [_diagnosed(case, task.tell) for case in cases]
    each = [aims_of(c.program, d) for c, d in zip(cases, diagnoses, strict=True)]
    if len(cases) > 1:
        sources = [case.report.trace.source for case in cases]
        each = [named(aims, source) for aims, source in zip(each, sources, strict=True)]
    told = pooled(each)
    ways = [
        explanations_of(c.program, d, aims.aims)
        for c, d, aims in zip(cases, diagnoses, each, strict=True)
    ]
    case = _Fit(task.how, loaded, cases, told, moves_of(loaded, told.aims))
    case = _weighed(case, pooled_explanations(ways, told.aims), task)
    told = case.told
    if told.beyond or told.left or not case.moves:
        case = _with_vectors(case, task)
    return _ended(case, task)


def _opens_more(fitted: Fitted) -> bool:
    """Whether the log is read otherwise, so that more of it may be compared, and not all pass."""
    is_passed = all(report.verdict is Verdict.PASS for report in fitted.after)
    return not is_passed and any(move.edit.path[-1] in OF_READING for move in fitted.moves)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Fit:
    """A fit on its way: what the recordings say, and what would be moved.

    ways: explanations that are as good, the first of which `moves` are of; empty where one is
    best. instead: why others were not taken.
    """

    how: str
    loaded: Loaded
    cases: tuple[Case, ...]
    told: Aims
    moves: tuple[Move, ...]
    stays: tuple[str, ...] = ()
    ways: tuple[Weighed, ...] = ()
    instead: tuple[str, ...] = ()

    def ended(
        self, outcome: Outcome, edited: Source | None = None, after: tuple[Report, ...] = ()
    ) -> Fitted:
        """The result, with another text if one is given."""
        return Fitted(
            outcome=outcome,
            how=self.how,
            source=self.loaded.source,
            edited=edited or self.loaded.source,
            moves=self.moves,
            beyond=(*self.told.beyond, *self.told.by_hand),
            left=self.told.left,
            choices=self.told.choices,
            stays=self.stays,
            before=tuple(case.report for case in self.cases),
            after=after,
            ways=self.ways,
            instead=self.instead,
        )


def _diagnosed(case: Case, tell: Tell) -> Diagnosis:
    tell(f"{case.report.trace.source}, why it departs")
    trace, study = case.judged()
    return diagnose(case.program, trace, study, case.report)


def _weighed(case: _Fit, explanations: tuple[Explanation, ...], task: _Task) -> _Fit:
    """With the edits of what explains best; with several `ways` where nothing decides."""
    if case.told.beyond or case.told.contradicts or not explanations:
        return case
    task.tell("weighing explanations")
    found = weighed(case.loaded, case.cases, task.logs, explanations, _departures, task.tell)
    best = as_good(found)
    if not best:
        return case
    first = best[0]
    told = case.told
    if first.explanation.label != explanations[0].label:
        told = replace(told, aims=first.explanation.aims, left=(), choices=())
    if len(best) > 1:
        return replace(case, told=told, moves=first.moves, ways=best)
    return replace(case, told=told, moves=first.moves, instead=passed_over(found, first))


def _with_vectors(case: _Fit, task: _Task) -> _Fit:
    """A drawn field can follow what no single number stands for.

    Numbers that were fitted beside what its vectors explain are left alone.
    """
    if all(each.report.verdict is Verdict.PASS for each in case.cases):
        return case
    found = redrawn(case.loaded, case.cases, task.logs, task.tell)
    if found is None or not found.moves:
        return case
    return replace(case, moves=found.moves, stays=found.stays, told=Aims(()))


def _ended(case: _Fit, task: _Task) -> _Round:
    """With the edited text and its verdicts, or with why there is none."""
    why_not = _why_not(case)
    if why_not is not None and not (task.anyway and case.moves):
        return _Round(case.ended(why_not), case.loaded, case.cases)
    edited = moved(case.loaded.source, case.moves)
    loaded, program = compiled(edited)
    again = task.logs.judged_again(case.cases, program, task.tell)
    after = tuple(each.report for each in again)
    left = tuple(dict.fromkeys(sentence for each in again for sentence in _departures(each)))
    if left and not task.anyway:
        spoilt = _spoilt(case.cases, again)
        if spoilt:
            case = replace(case, told=replace(case.told, choices=spoilt, left=left))
            return _Round(case.ended(Outcome.CANNOT_TELL, None, after), case.loaded, case.cases)
        case = replace(case, told=replace(case.told, left=left))
        fitted = case.ended(Outcome.STRUCTURE_DIFFERS, None, after)
        return _Round(fitted, case.loaded, case.cases)
    return _Round(case.ended(Outcome.MOVED, edited, after), loaded, again)


def _spoilt(before: Sequence[Case], after: Sequence[Case]) -> tuple[str, ...]:
    """That recordings which keep to the spec as it is would depart from the edited one."""
    both = zip(before, after, strict=True)
    names = [a.report.trace.source for b, a in both if _departures(a) and not _departures(b)]
    if not names:
        return ()
    what = f"these numbers do for the others, but not for {listed(names)}"
    return (f"{what}: the recordings fall into groups; fit each group by itself",)


def _why_not(case: _Fit) -> Outcome | None:
    """How it ends without an edit; None where there is one to try."""
    told = case.told
    if told.contradicts:
        return Outcome.CANNOT_TELL
    if told.beyond or told.left:
        return Outcome.STRUCTURE_DIFFERS
    if told.by_hand:
        return Outcome.BY_HAND
    if told.choices or case.ways:
        return Outcome.CANNOT_TELL
    return None if case.moves else _unmoved(case.cases)


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
