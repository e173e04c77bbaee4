"""`specc fit`: the spec moved to what the robot does."""

from typing import TYPE_CHECKING, Annotated

import typer

from specc.cli.console import print_json, print_text, say, shown_bar
from specc.cli.options import (
    Clock,
    ClockOption,
    Format,
    FormatOption,
    JudgedBy,
    Logs,
    Strict,
    one_spec,
)
from specc.cli.status import Status
from specc.cli.warming import warmed

if TYPE_CHECKING:
    from specc.fitting.fitted import Fitted


def fit(
    traces: Logs,
    spec: JudgedBy = [],  # noqa: B006  typer copies it
    write: Annotated[
        bool, typer.Option("--write", help="Edit the spec's file; without it, only show the edit.")
    ] = False,
    anyway: Annotated[
        bool,
        typer.Option(
            "--anyway", help="Move numbers even where the structure differs, or nothing decides."
        ),
    ] = False,
    clock: ClockOption = Clock.AUTO,
    strict: Strict = False,
    form: FormatOption = Format.TEXT,
) -> int:
    """Move the spec's numbers to what the robot does, and show the edit and the new verdict.

    Controls held constant, constants, delays, scales and offsets of `trace:`, and the vectors of
    `arrows` and `grid`. Nothing else in the file changes, and nothing without --write. Exit status
    1: the structure differs, or no number was found that mends it; 4: the recordings can't tell.

    **Examples**

    `specc fit run.mcap`

    `specc fit runs/*.mcap --spec specs/patrol.yaml --write`

    `specc fit run.mcap --format json`
    """
    from specc.fitting.fit import fit as fitted_to
    from specc.fitting.fitted import Outcome

    named = one_spec(spec)
    warmed(named)
    with shown_bar("fit") as bar:
        found = fitted_to(
            traces,
            named,
            clock.value,
            strict=strict,
            anyway=anyway,
            progress=lambda phase: bar.advance(phase, 0, 1),
        )
    is_written = write and found.outcome is Outcome.MOVED
    if is_written:
        found.write()
    _show(found, form, is_written=is_written)
    statuses = {
        Outcome.STRUCTURE_DIFFERS: Status.NO,
        Outcome.NOTHING_MENDS_IT: Status.NO,
        Outcome.BY_HAND: Status.NO,
        Outcome.CANNOT_TELL: Status.INCONCLUSIVE,
    }
    return statuses.get(found.outcome, Status.YES)


def _show(found: "Fitted", form: Format, *, is_written: bool) -> None:
    from specc.fitting.fit_text import fit_record, fit_text

    if form is Format.JSON:
        print_json(fit_record(found, is_written=is_written))
    else:
        say(f"spec: {found.how}")
        print_text(fit_text(found))
    if is_written:
        say(f"wrote {found.path}", "bold")
    elif found.diff:
        say(f"{found.path} is as it was; --write edits it", "bold")
