"""`specc verify book/ runs/*.mcap`: which modules of a book are done."""

from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path

from specc.book.loading import load_book
from specc.book_reported import annotations_of, write_book_report
from specc.cli.console import print_json, print_text, say
from specc.cli.options import Clock, ReportFormat
from specc.cli.status import Status
from specc.cli.watching import judged_with_bar
from specc.faults import fault
from specc.texts.book_verdict import book_text, taken_text
from specc.verifying.book import How, judge_each, only_of
from specc.verifying.book_modules import BookVerdict, Standing
from specc.verifying.book_record import book_record
from specc.verifying.book_verdict import book_verdict
from specc.verifying.trace import program_for_verify
from verifier.report.examination import Depth


def verify_book(
    path: Path,
    traces: Sequence[Path],
    spec: Path | None,
    output: Sequence[Path],
    clock: Clock,
    form: ReportFormat,
    depth: Depth,
    *,
    only: tuple[str, ...] | None,
    procedures: bool,
    strict: bool,
    allow_code: bool,
) -> int:
    """The exit status, after everything is printed and written: 0 where all modules are done.

    Raises:
        SpecError: the book can't be used, no recording is named (V441), or no such module (V444).
    """
    if not traces:
        raise fault("V441", path, "no recording is named", f"specc verify {path} runs/*.mcap")
    book = load_book(path)
    how = How(
        cache(partial(program_for_verify, allow_code=allow_code)),
        spec,
        clock.value,
        allow_code=allow_code,
        strict=strict,
        depth=depth,
        only=only_of(book, only),
    )
    judge = partial(judge_each, book, traces, how)
    outcomes, is_interrupted = judged_with_bar(judge, len(traces))
    if is_interrupted:
        say("interrupted: nothing is said of the book", "bold red")
        return Status.INTERRUPTED
    verdict = book_verdict(book, outcomes, how.only)
    _print(verdict, form, procedures=procedures)
    for file in output:
        write_book_report(verdict, file, procedures=procedures)
        say(f"wrote {file}", "bold")
    return _status(verdict)


def _print(verdict: BookVerdict, form: ReportFormat, *, procedures: bool) -> None:
    match form:
        case ReportFormat.JSON:
            print_json(book_record(verdict))
        case ReportFormat.GITHUB:
            print_text(annotations_of(verdict))
        case ReportFormat.TEXT:
            for told in taken_text(verdict):
                say(told)
            print_text(book_text(verdict, procedures=procedures))


def _status(verdict: BookVerdict) -> int:
    """2 where a recording can't be used, unless a module fails."""
    if verdict.standing is Standing.FAILS:
        return Status.NO
    if verdict.unusable:
        return Status.BAD_INPUT
    return Status.YES if verdict.standing is Standing.DONE else Status.INCONCLUSIVE
