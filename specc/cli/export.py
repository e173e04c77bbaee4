"""`specc export`: the complete set of specifications, as a book for whoever builds the robot."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, say, show_diagnostics, shown_bar
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
    from specc.book.contents import gathered
    from specc.book.export import prepare, write_book
    from specc.texts.book import book_record, book_text

    prepare(output, with_pdf=not no_pdf)
    with shown_bar(f"book of {spec.name}") as bar:
        contents = gathered(spec, bar.advance, allow_code=allow_code)
        with bar.aside():
            show_diagnostics(contents.warnings)
        book = write_book(contents, output, bar.advance, with_pdf=not no_pdf)
    if form is Format.JSON:
        print_json(book_record(book, output))
        return
    print_text(book_text(book))
    size = sum(file.bytes for file in book.files)
    say(f"wrote {output}: {len(book.files) + 1} files, {size / 1e6:.1f} MB", "bold")
