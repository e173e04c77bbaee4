"""From what recordings say to where each module of a book stands."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from runtime.arbiter import Arbiter
from runtime.program import Program
from specc.book.loading import LoadedBook, load_book
from specc.book.manifest import Module
from specc.verifying.architecture import NotJudged
from specc.verifying.book import How, OfModules, Outcome, judge_each, only_of
from specc.verifying.book_missing import to_record, told_of
from specc.verifying.book_modules import (
    BookVerdict,
    ModuleVerdict,
    Piece,
    Place,
    Standing,
    pieces_of,
)
from specc.verifying.runs import Unusable
from specc.verifying.trace import Clock, Verification, program_for_verify
from verifier.arbitration.together import pooled_decisions
from verifier.architectures.telling import without_logs
from verifier.fidelity.together import pooled
from verifier.report.examination import Depth, Examination
from verifier.report.report import Verdict

NEVER = "no recording holds it"
NOTHING = "it is code of the author's own, which promises nothing that could be judged"
STANDINGS = {
    Verdict.PASS: Standing.DONE,
    Verdict.FAIL: Standing.FAILS,
    Verdict.INCONCLUSIVE: Standing.LACKS,
}


def verify_book(
    book: Path | str | LoadedBook,
    traces: Sequence[Path | str],
    spec: Path | str | None = None,
    clock: Clock = "auto",
    *,
    allow_code: bool = False,
    strict: bool = False,
    depth: Depth = "all",
    only: Sequence[str] | None = None,
) -> BookVerdict:
    """Hold recordings against a book: where each of its modules stands, by all of them together.

    Args:
        spec: of a behavior or arbiter; it says where in logs things stand, where no log does.
        allow_code: whether arbiters that are code of the user's own may be run.
        strict: any loss in a log is an error.
        depth: what is found out beside the verdict.
        only: the names of the modules that are judged; None: all.

    Raises:
        SpecError: the book can't be used, or has no module of such a name (V444).
    """
    loaded = book if isinstance(book, LoadedBook) else load_book(book)
    named = None if spec is None else Path(spec)
    program_of = cache(partial(program_for_verify, allow_code=allow_code))
    places = only_of(loaded, only)
    how = How(program_of, named, clock, allow_code, strict, depth, places)
    outcomes = tuple(judge_each(loaded, [Path(each) for each in traces], how))
    return book_verdict(loaded, outcomes, places)


def book_verdict(
    book: LoadedBook, outcomes: Sequence[Outcome], only: frozenset[Place] | None = None
) -> BookVerdict:
    """Every module of the book, or those that count, by all outcomes that are about it."""
    told = [each for each in outcomes if isinstance(each, OfModules)]
    modules = told_of(book)
    every = [piece for architecture, _ in book.architectures for piece in pieces_of(architecture)]
    pieces = [piece for piece in every if only is None or piece.place in only]
    return BookVerdict(
        name=book.book.name,
        modules=tuple(_module(piece, modules[piece.place], told) for piece in pieces),
        unusable=tuple(each for each in outcomes if isinstance(each, Unusable)),
        left_out=len(every) - len(pieces),
    )


def _module(piece: Piece, module: Module, told: Sequence[OfModules]) -> ModuleVerdict:
    mine = [each.outcome for each in told if piece.place in each.places]
    members = tuple(each for each in mine if isinstance(each, Verification))
    lost = tuple(each for each in mine if isinstance(each, NotJudged))
    if piece.spec is None:
        return ModuleVerdict(piece, Standing.FREE, (), lost, None, (NOTHING,), (), module.page)
    if not members:
        why = tuple(dict.fromkeys(each.why for each in lost)) or (NEVER,)
        needed = to_record(module.trial, None)
        return ModuleVerdict(piece, Standing.LACKS, (), lost, None, why, needed, module.page)
    together = _together(piece, members)
    failing = [each for each in members if each.report.verdict is Verdict.FAIL]
    standing = Standing.FAILS if failing else STANDINGS[together.report.verdict]
    why = _why(together, failing)
    needed = to_record(module.trial, together) if standing is Standing.LACKS else ()
    return ModuleVerdict(piece, standing, members, lost, together, why, needed, module.page)


def _together(piece: Piece, members: Sequence[Verification]) -> Examination:
    """What all recordings of a module say together."""
    if len(members) == 1:
        return members[0].examination
    if isinstance(piece.spec, Arbiter):
        return pooled_decisions([each.examination for each in members])
    report = pooled(_least(members), [each.judgement for each in members if each.judgement])
    examination = Examination(report, origins=members[0].examination.origins)
    return without_logs(examination) if any(each.part for each in members) else examination


def _least(members: Sequence[Verification]) -> Program:
    """The program without tolerances for what one of the recordings does not measure."""
    programs = [each.found.program for each in members if isinstance(each.found.program, Program)]
    kept = [set(p.fidelity.tolerance) for p in programs if p.fidelity is not None]
    first = programs[0]
    if first.fidelity is None or not kept:
        return first
    names = set.intersection(*kept)
    tolerance = {k: v for k, v in first.fidelity.tolerance.items() if k in names}
    return replace(first, fidelity=replace(first.fidelity, tolerance=tolerance))


def _why(together: Examination, failing: Sequence[Verification]) -> tuple[str, ...]:
    """What decides: of a recording that fails by itself, that; else what all say together."""
    if not failing:
        return together.report.reasons
    return tuple(
        f"{each.report.trace.source}: {each.report.reasons[0]}"
        for each in failing
        if each.report.reasons
    )
