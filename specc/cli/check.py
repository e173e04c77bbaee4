"""`specc check`: every mistake at once."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, final

import typer

from specc.cli.console import print_json, say, show_diagnostics
from specc.cli.status import Status


@final
class CheckFormat(StrEnum):
    """How the diagnostics are printed."""

    TEXT = "text"
    JSON = "json"
    GITHUB = "github"


def check(
    paths: Annotated[
        list[Path], typer.Argument(help="Specs, or folders of them.", metavar="SPEC...")
    ],
    form: Annotated[
        CheckFormat, typer.Option("--format", "-f", help="text, json, or github annotations.")
    ] = CheckFormat.TEXT,
) -> int:
    """Find every mistake in specs, each with its place and what to write instead.

    Nothing that a spec's author wrote is run.

    **Examples**

    `specc check specs/`

    `specc check patrol.yaml --format json`
    """
    from compiler.check import check as check_file
    from specc.files import spec_files

    files = spec_files(paths)
    if not files:
        raise typer.BadParameter(f"no .yaml file is in {', '.join(map(str, paths))}")
    found = tuple(d for file in files for d in check_file(file))
    failed = any(d.severity == "error" for d in found)
    match form:
        case CheckFormat.JSON:
            print_json([d.as_json() for d in found])
        case CheckFormat.GITHUB:
            for d in found:
                typer.echo(_annotation(d.as_json()))
        case CheckFormat.TEXT:
            show_diagnostics(found)
            if not failed:
                say(f"{_specs(len(files))} without mistakes", "bold green")
    return Status.BAD_INPUT if failed else Status.YES


def _specs(count: int) -> str:
    return f"{count} spec" + ("" if count == 1 else "s")


def _annotation(d: dict[str, object]) -> str:
    message = f"{d['message']} ({d['help']})" if d["help"] else f"{d['message']}"
    safe = message.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    where = f"file={d['file']},line={d['line']},col={d['column']},endColumn={d['end_column']}"
    return f"::{d['severity']} {where},title={d['code']}::{safe}"
