"""The self-test: the smallest known faults that the verdict would have caught in this trace.

A fault counts as caught where the copy with it FAILs in either direction (too much and too
little). Its sizes stand on a ladder, which is searched. Only the verdict itself decides.
"""

from dataclasses import replace
from functools import partial

from runtime.program import Program
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import Needs, needs_of
from verifier.fidelity.verify import judged, verify
from verifier.limits.copies import Copies, Judge, copies_of, exceeded
from verifier.limits.excerpt import excerpt_of
from verifier.limits.faults import Planned, faults_of
from verifier.limits.saying import said
from verifier.limits.search import turning
from verifier.report.limits import Caught
from verifier.report.report import Report, Verdict
from verifier.report.wording import listed, number
from verifier.traces.trace import Trace


def smallest_caught(
    program: Program,
    trace: Trace,
    report: Report,
    judge: Judge = verify,
    study: Study | None = None,
) -> tuple[tuple[Caught, ...], tuple[str, ...]]:
    """What each planted fault would have to be to be caught, and on what that rests.

    report, study: the verdict on the trace as it is, and what it rests on, where that is at hand.
    Empty with the reason where that is FAIL, or where there is nothing to judge.
    """
    if report.verdict is Verdict.FAIL:
        return (), (
            "no fault was planted: the trace fails as it is, so there is nothing left to catch",
        )
    assert program.fidelity is not None, "a report needs a tolerance"
    known, notes = _declared(trace, needs_of(program, trace))
    base = report
    if notes or study is None:
        base, study = judged(program, known)
    part = known
    if study is not None:
        part, told = excerpt_of(known, program.fidelity, study)
        if told:
            notes.append(told)
            base, study = judged(program, part)
    if study is None:
        return (), ("no fault was planted: too little of this trace can be judged",)
    if base.verdict is Verdict.FAIL:
        return (), (*notes, "no fault was planted after all: that fails as it is")
    planned = faults_of(program, program.fidelity, study)
    return _searched(program, part, study, base, planned, judge), tuple(notes)


def _declared(trace: Trace, needs: Needs) -> tuple[Trace, list[str]]:
    """The trace with the inputs that it does not tell declared constant, as the spec assumes."""
    assumed = {each.name: each.value for each in needs.inputs if not each.is_known}
    if not assumed:
        return trace, []
    values = listed([f"{name} = {number(value)} (SI)" for name, value in assumed.items()])
    note = f"faults were planted as if {values} were known, which this trace does not tell"
    return replace(trace, constants=trace.constants | assumed), [note]


def _searched(
    program: Program,
    trace: Trace,
    study: Study,
    base: Report,
    planned: tuple[Planned, ...],
    judge: Judge,
) -> tuple[Caught, ...]:
    acting = tuple(each for each in planned if each.can_act)
    copies = copies_of(program, trace, study, base, acting, judge)
    return tuple(
        _caught(program, each, copies) if each.can_act else said(each, (None, None), (), ())
        for each in planned
    )


def _caught(program: Program, planned: Planned, copies: Copies) -> Caught:
    missed, caught = turning(
        partial(copies.is_caught, planned),
        partial(copies.expected, planned),
        planned.guess,
        len(planned.sizes),
    )
    sides = copies.sides(planned, len(planned.sizes) - 1 if caught is None else caught)
    verdicts = sides[0].verdict, sides[1].verdict
    shown_by = () if caught is None else _shown_by(program, sides)
    return said(planned, (missed, caught), copies.tried(planned), shown_by, verdicts)


def _shown_by(program: Program, sides: tuple[Report, Report]) -> tuple[str, ...]:
    """What gave a fault away in one or the other direction: variables, or the changes of mode."""
    names = tuple(dict.fromkeys(name for report in sides for name in exceeded(report)))
    return names if all(map(exceeded, sides)) else (*names, f"changes of {program.field.mode}")
