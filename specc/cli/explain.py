"""`specc explain`: why an arbiter decided as it did, from a recording."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from specc.cli.console import print_json, print_text, progress_bar, say
from specc.cli.options import Clock, ClockOption, Format, FormatOption, JudgedBy, one_spec
from specc.cli.portrait import StyleOption
from specc.figures.style_names import Style

if TYPE_CHECKING:
    from collections.abc import Sequence

    from specc.explaining import Explained

At: TypeAlias = Annotated[
    str | None, typer.Option("--at", metavar="TIME", help="One decision: the last by then.")
]
Begin: TypeAlias = Annotated[
    str | None, typer.Option("--from", metavar="TIME", help="Only what was decided from then on.")
]
End: TypeAlias = Annotated[
    str | None, typer.Option("--to", metavar="TIME", help="Only what was decided until then.")
]


def explain(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A run, by `specc simulate -o`, or a log with `trace:`.", metavar="RUN"
        ),
    ],
    nodes: Annotated[
        list[str],
        typer.Option("--node", metavar="ROBOT.NODE", help="An arbiter of the run; default all."),
    ] = [],  # noqa: B006  typer copies it
    spec: JudgedBy = [],  # noqa: B006  typer copies it
    at: At = None,
    start: Begin = None,
    end: End = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Also the timeline: .svg, .png, .pdf or .json."),
    ] = None,
    clock: ClockOption = Clock.AUTO,
    allow_code: Annotated[
        bool, typer.Option("--allow-code", help="Run arbiters that are Python of yours.")
    ] = False,
    style: StyleOption = Style.SCREEN,
    form: FormatOption = Format.TEXT,
) -> None:
    """Tell for each moment of a recording which rule decided and why, and how near another was.

    Decisions that are alike follow one another in stretches: the choice, the rule in words, what
    held it, what began it, and when which quantity was nearest to changing it. Where the robot
    chose otherwise than its spec, that is marked. With `--at` one decision is told in full.

    It looks only, so the exit status is 0 where robot and spec differ; `specc verify` judges.

    **Examples**

    `specc explain run.mcap -o timeline.svg`

    `specc explain run.mcap --node r.choose --at 12.3s`

    `specc explain specs/recordings/scitos/scitos.csv --from 20 --to 60 --format json`
    """
    from specc.explaining import cropped
    from specc.explaining import explain as explained
    from specc.files import require_suffix
    from specc.texts.moments import explained_record, explained_text

    require_suffix(output, ".svg", ".png", ".pdf", ".json")
    if at is not None and (start is not None or end is not None or output is not None):
        raise typer.BadParameter("--at tells of one decision: leave --from, --to and -o out")
    moment, low, high = (_time(text) for text in (at, start, end))
    with progress_bar(f"reading {recording.name}") as bar:
        found = explained(
            recording,
            one_spec(spec),
            nodes,
            allow_code=allow_code,
            clock=clock.value,
            reading=lambda done, of: bar("reading", done, of),
        )
    if moment is not None:
        _tell_moment(found, moment, form)
        return
    if low is not None or high is not None:
        found = tuple(cropped(each, low, high) for each in found)
    if form is Format.JSON:
        print_json([explained_record(each) for each in found])
    else:
        print_text("\n\n".join(explained_text(each) for each in found))
    if output is not None:
        _write(found, output, style)


def _time(text: str | None) -> float | None:
    """A time as `12.3`, `12.3s` or `2 min`, in seconds.

    Raises:
        SpecError: it is none (V342).
    """
    from specc.given import instant

    return None if text is None else instant(text)


def _tell_moment(found: "Sequence[Explained]", moment: float, form: Format) -> None:
    from specc.explaining import cropped
    from specc.texts.moments import moment_record, moment_text

    for each in found:
        cropped(each, moment, moment)
    if form is Format.JSON:
        print_json([moment_record(each, moment) for each in found])
    else:
        print_text("\n\n".join(moment_text(each, moment) for each in found))


def _write(found: "Sequence[Explained]", output: Path, style: Style) -> None:
    """The timeline of each arbiter: of several, each in a file of its own."""
    from specc.drawn import write_picture
    from specc.figures.decision_strip import draw_strip
    from specc.files import json_bytes, write_atomically
    from specc.texts.moments import explained_record

    for each in found:
        path = output
        if len(found) > 1:
            path = output.with_name(f"{output.stem}_{each.name.replace('.', '_')}{output.suffix}")
        if output.suffix.lower() == ".json":
            write_atomically(path, json_bytes(explained_record(each)))
        else:
            write_picture(draw_strip(each, style), path, style)
        say(f"wrote {path}", "bold")
