"""`specc export`: the complete set of specifications, as a book for whoever builds the robot."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, progress_bar, say
from specc.cli.options import Format, FormatOption


def export(
    spec: Annotated[
        Path,
        typer.Argument(
            help="An architecture or a scenario spec (.yaml).", metavar="ARCHITECTURE_OR_SCENARIO"
        ),
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="The folder of the book.", metavar="FOLDER")
    ] = Path("book"),
    no_pdf: Annotated[
        bool, typer.Option("--no-pdf", help="Without book.pdf, for which typst is needed.")
    ] = False,
    allow_code: Annotated[
        bool,
        typer.Option("--allow-code", help="Run Python of yours that the specs name."),
    ] = False,
    form: FormatOption = Format.TEXT,
) -> None:
    """Write the book of an architecture: all specs, portraits, tables and tests, for its builder.

    **Examples**

    `specc export specs/architectures/patrol_hierarchy.yaml -o book/`

    `specc export specs/scenarios/light_hierarchy.yaml -o book/`
    """
    from specc.book.export import export_book

    with progress_bar(f"book of {spec.name}") as progress:
        book = export_book(spec, output, progress, allow_code=allow_code, with_pdf=not no_pdf)
    if form is Format.JSON:
        print_json({"name": book.name, "folder": str(output), "files": len(book.files)})
        return
    print_text(f"{len(book.modules)} modules, {len(book.files)} files")
    say(f"wrote {output}", "bold")
