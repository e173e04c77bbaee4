"""`specc verify`: does the robot do what the spec says?"""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, final

import typer

from specc.cli.console import print_json, print_text, say
from specc.cli.options import Format, FormatOption
from specc.cli.status import Status
from specc.cli.warming import warmed


@final
class Clock(StrEnum):
    """Which stamps count as the time of a message."""

    AUTO = "auto"
    SENSOR = "sensor"
    LOG = "log"


def verify(
    trace: Annotated[
        Path, typer.Argument(help="A log: .mcap, ROS 1 .bag, ROS 2 bag, .csv.", metavar="TRACE")
    ],
    spec: Annotated[
        Path | None,
        typer.Option(
            "--spec",
            help="The spec (.yaml or .specc); default: what is attached to the log, else what "
            "`specc.yaml` says.",
        ),
    ] = None,
    output: Annotated[
        list[Path],
        typer.Option(
            "--output", "-o", help="Also write a report: .html, .json or .txt. Repeatable."
        ),
    ] = [],  # noqa: B006  typer copies it
    clock: Annotated[
        Clock, typer.Option("--clock", help="Sensor stamps, log times, or the better of both.")
    ] = Clock.AUTO,
    strict: Annotated[
        bool, typer.Option("--strict", help="Any loss in the log (torn, corrupt) is an error.")
    ] = False,
    form: FormatOption = Format.TEXT,
) -> int:
    """Judge a recording of a robot against its spec: PASS, FAIL or INCONCLUSIVE, and why.

    **Examples**

    `specc verify run.mcap`

    `specc verify drive.bag --spec specs/husky_drive.yaml -o report.html`

    `specc verify drive.mcap --format json > verdict.json`
    """
    from specc import verifying
    from specc.files import require_suffix
    from verifier.report.record import as_json
    from verifier.report.text import as_text

    for path in output:
        require_suffix(path, ".html", ".json", ".txt")
    warmed(spec)
    verification = verifying.verify(trace, spec, clock.value, strict=strict)
    report = verification.report
    if form is Format.JSON:
        print_json({**as_json(report), "found_by": verification.found.how})
    else:
        say(f"spec: {verification.found.how}")
        print_text(as_text(report))
    if output:
        from specc.reported import write_report

        for path in output:
            write_report(verification, path)
            say(f"wrote {path}", "bold")
    verdicts = {"pass": Status.YES, "fail": Status.NO, "inconclusive": Status.INCONCLUSIVE}
    return verdicts[str(report.verdict)]
