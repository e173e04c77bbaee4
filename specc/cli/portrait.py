"""`specc portrait`: a phase portrait, as a picture and as numbers."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, say
from specc.cli.options import Format, FormatOption, Settings, SpecPath, assignments
from specc.cli.warming import warmed


def portrait(
    spec: SpecPath,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help=".svg, .png, .pdf or .json; default NAME.svg here."),
    ] = None,
    axes: Annotated[
        str | None,
        typer.Option(
            "--axes", "-a", metavar="X,Y", help="The states to draw; default the first two."
        ),
    ] = None,
    settings: Settings = [],  # noqa: B006  typer copies it
    form: FormatOption = Format.TEXT,
) -> None:
    """Draw the phase portrait of a behavior: field, nullclines, fixed points, trajectories.

    States that are not drawn are held at `hold`, controls at their defaults; `--set` says else.

    **Examples**

    `specc portrait specs/van_der_pol.yaml -o vdp.svg --set mu=2`

    `specc portrait specs/wall_follow.yaml --axes distance,heading --format json`
    """
    from specc import loading, portraying
    from specc.files import require_suffix

    require_suffix(output, ".svg", ".png", ".pdf", ".json")

    warmed(spec)
    program = loading.load_program(spec)
    names = tuple(name.strip() for name in axes.split(",")) if axes else None
    portrayed = portraying.portrait(program, names, assignments(settings))
    if form is Format.JSON:
        from verifier.topology.portrait_json import as_json

        print_json(as_json(portrayed))
    else:
        from specc.portrait_text import portrait_summary

        print_text(portrait_summary(portrayed))
    if output is not None or form is Format.TEXT:
        from specc.drawn import draw

        path = output or Path(f"{program.name}.svg")
        draw(portrayed, path)
        say(f"wrote {path}", "bold")
