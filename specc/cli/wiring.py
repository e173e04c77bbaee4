"""`specc wiring`: which behaviors and modules an architecture has, and how they are wired."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, say, show_diagnostics
from specc.cli.options import Format, FormatOption
from specc.cli.portrait import StyleOption
from specc.figures.style_names import Style

TYPE_CHECKING = False
if TYPE_CHECKING:
    from specc.wired import Wired


def wiring(
    spec: Annotated[
        Path,
        typer.Argument(
            help="An architecture spec (.yaml) or a compiled one (.specc).", metavar="ARCHITECTURE"
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help=".svg, .png, .pdf or .json; default NAME.svg here."),
    ] = None,
    style: StyleOption = Style.SCREEN,
    form: FormatOption = Format.TEXT,
) -> None:
    """Draw how an architecture is wired: levels, control interfaces, channels and conflicts.

    No tables are made, and nothing that an author of its specs wrote is run.

    **Examples**

    `specc wiring specs/architectures/thesis_3_3.yaml -o wiring.svg`

    `specc wiring specs/architectures/thesis_3_2.yaml --style journal -o wiring.pdf`

    `specc wiring specs/architectures/thesis_3_3.yaml --format json`
    """
    from compiler.architecture.compile import wire_architecture
    from specc import loading
    from specc.files import require_suffix
    from specc.texts.wiring import record, summary
    from specc.wired import wired

    require_suffix(output, ".svg", ".png", ".pdf", ".json")
    if spec.suffix == ".specc":
        architecture, body = loading.load_architecture(spec)
    else:
        loading.refuse_log(spec)
        compiled = wire_architecture(spec)
        show_diagnostics(compiled.warnings)
        architecture, body = compiled.architecture, compiled.body
    found = wired(architecture, body)
    if form is Format.JSON:
        print_json(record(found))
    else:
        print_text(summary(found))
    if output is None and form is Format.JSON:
        return
    path = output or Path(f"{found.name}.svg")
    _write(path, style, found)
    say(f"wrote {path}", "bold")


def _write(path: Path, style: Style, found: "Wired") -> None:
    from specc.drawn import write_picture
    from specc.figures.wiring import draw_wiring
    from specc.files import json_bytes, write_atomically
    from specc.texts.wiring import record

    if path.suffix.lower() == ".json":
        write_atomically(path, json_bytes(record(found)))
    else:
        write_picture(draw_wiring(found, style), path, style)
