"""`specc verify`: does the robot do what the spec says?"""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from specc.cli.console import print_json, print_text, say
from specc.cli.options import (
    Clock,
    ClockOption,
    JudgedBy,
    Logs,
    ReportFormat,
    ReportFormatOption,
    Reports,
    Strict,
    names_of,
    one_spec,
)
from specc.cli.status import Status
from specc.cli.warming import warmed
from specc.cli.watching import judged_with_bar

if TYPE_CHECKING:
    from specc.verifying.runs import Outcome, Runs
    from verifier.report.examination import Depth

BOOK: Final = "book.json"
"""The file that makes a folder a book."""


def verify(
    traces: Logs,
    spec: JudgedBy = [],  # noqa: B006  typer copies it
    output: Reports = [],  # noqa: B006  typer copies it
    clock: ClockOption = Clock.AUTO,
    strict: Strict = False,
    allow_code: Annotated[
        bool,
        typer.Option("--allow-code", help="Run arbiters that are Python of yours, to judge them."),
    ] = False,
    quick: Annotated[
        bool, typer.Option("--quick", help="The verdict only, without what explains it.")
    ] = False,
    only: Annotated[
        str | None,
        typer.Option(
            "--only", metavar="NAME[,NAME]", help="Of a book these modules alone; all others wait."
        ),
    ] = None,
    procedures: Annotated[
        bool,
        typer.Option(
            "--procedures",
            help="Of a book also print what to record of modules without a recording.",
        ),
    ] = False,
    form: ReportFormatOption = ReportFormat.TEXT,
) -> int:
    """Judge recordings of a robot against its spec: PASS, FAIL or INCONCLUSIVE, and why.

    With several recordings it prints a table and judges all of one spec together: a FAIL of one
    counts, else the verdict on all, which short recordings may reach that decide nothing alone.

    In the recording of a scenario what is required is judged, and every behavior and arbiter of
    every robot by its own spec, a behavior where it had its way: a row for each, and one verdict.
    `--spec` may then be a scenario, an architecture, or one behavior or arbiter.

    Where a book (see `specc export`) comes first, its modules are judged, each by all recordings
    together: which are done, which fail, and which lack data, with what is still to be recorded.
    A log of which nothing says what it is of is taken for the module whose names it holds.
    `--spec` says where in the logs things stand, `--only` which modules count.

    **Examples**

    `specc verify run.mcap`

    `specc verify drive.bag --spec specs/husky_drive.yaml -o report.html`

    `specc verify runs/*.mcap --quick -o report.html -o report.junit.xml -o report.sarif`

    `specc verify drive.mcap --format json > verdict.json`

    `specc verify book/ runs/*.mcap --only seek,avoid`
    """
    _refuse_early(output)
    named = one_spec(spec)
    if (traces[0] / BOOK).is_file():
        from specc.cli.verify_book import verify_book

        return verify_book(
            traces[0],
            traces[1:],
            named,
            output,
            clock,
            form,
            "verdict" if quick else "all" if output else "reasons",
            only=names_of(only, "--only"),
            procedures=procedures,
            strict=strict,
            allow_code=allow_code,
        )
    if only is not None or procedures:
        raise typer.BadParameter("--only and --procedures are of a book, which comes first")
    return _verify_recordings(
        traces,
        named,
        output,
        form,
        clock,
        quick=quick,
        strict=strict,
        allow_code=allow_code,
    )


def _verify_recordings(
    traces: Sequence[Path],
    spec: Path | None,
    output: Sequence[Path],
    form: ReportFormat,
    clock: Clock,
    *,
    quick: bool,
    strict: bool,
    allow_code: bool,
) -> int:
    """Judge recordings, each by its own spec or all by one; the exit status."""
    from specc.verifying.runs import distinct, verify_each

    given, traces = traces, [Path(each) for each in distinct(traces)]
    if len(traces) < len(given):
        say("a recording that is named more than once counts once", "bold yellow")
    warmed(spec)
    judge = partial(
        verify_each,
        traces,
        spec,
        clock.value,
        allow_code=allow_code,
        strict=strict,
        depth="verdict" if quick else _depth(traces, spec, output, form),
    )
    outcomes, is_interrupted = judged_with_bar(judge, len(traces))
    return _told(outcomes, traces, output, form, is_interrupted=is_interrupted)


def _depth(
    traces: Sequence[Path], spec: Path | None, output: Sequence[Path], form: ReportFormat
) -> "Depth":
    """What is found out: all where it is written down, else what the table has room for."""
    from specc.verifying.standard import carries_architectures

    if output or form is ReportFormat.JSON:
        return "all"
    is_table = len(traces) > 1 or (spec is None and carries_architectures(traces[0]))
    return "reasons" if is_table else "all"


def _refuse_early(output: Sequence[Path]) -> None:
    """Stops before anything is judged whose report could not be written.

    Raises:
        typer.BadParameter: a file of another kind.
    """
    from specc.files import require_suffix
    from specc.reported import KINDS

    for path in output:
        require_suffix(path, *KINDS)


def _told(
    outcomes: "Sequence[Outcome]",
    traces: Sequence[Path],
    output: Sequence[Path],
    form: ReportFormat,
    *,
    is_interrupted: bool,
) -> int:
    """The exit status, after everything is printed and written.

    Raises:
        SpecError: the only recording can't be used.
    """
    from specc.verifying.runs import Unusable, runs_of

    if len(traces) == 1 and outcomes and isinstance(outcomes[0], Unusable):
        raise outcomes[0].error
    runs = runs_of(outcomes, is_whole=not is_interrupted)
    if outcomes:
        _print(runs, form)
        _write(runs, output)
    if is_interrupted:
        told = f"{_recordings(outcomes)} of {len(traces)} recordings were judged"
        say(f"interrupted: {told}", "bold red")
        return Status.INTERRUPTED
    return _status(runs)


def _recordings(outcomes: "Sequence[Outcome]") -> int:
    from specc.verifying.runs import recording_of

    return len({recording_of(each) for each in outcomes})


def _print(runs: "Runs", form: ReportFormat) -> None:
    from specc.reported import findings_by_source
    from specc.texts.runs import told_text
    from specc.verifying.runs import verifications
    from specc.verifying.runs_record import record_of
    from verifier.report.annotations import as_annotations

    match form:
        case ReportFormat.JSON:
            print_json(record_of(runs))
        case ReportFormat.GITHUB:
            lines = [as_annotations(each, source) for source, each in findings_by_source(runs)]
            print_text("\n".join(line for line in lines if line))
        case ReportFormat.TEXT:
            for how in dict.fromkeys(each.found.how for each in verifications(runs.outcomes)):
                say(f"spec: {how}")
            print_text(told_text(runs))


def _write(runs: "Runs", output: Sequence[Path]) -> None:
    from specc.reported import write_reports

    for path in output:
        write_reports(runs, path)
        say(f"wrote {path}", "bold")


def _status(runs: "Runs") -> int:
    """2 where a recording can't be used, else that of the verdict on all."""
    from specc.verifying.runs import unusable

    if unusable(runs.outcomes):
        return Status.BAD_INPUT
    verdicts = {"pass": Status.YES, "fail": Status.NO, "inconclusive": Status.INCONCLUSIVE}
    return verdicts[str(runs.verdict)]
