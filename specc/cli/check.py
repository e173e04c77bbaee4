"""`specc check`: every mistake at once, and on demand every claim."""

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, final

import typer

from specc.cli.console import print_json, print_styled, progress_bar, say, show_diagnostics
from specc.cli.status import Status
from specc.cli.warming import warmed

if TYPE_CHECKING:
    from runtime.program import Program
    from verifier.topology.claims.findings import Finding


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
    claims: Annotated[
        bool,
        typer.Option("--claims", help="Compile the specs, and prove or refute their `expect:`."),
    ] = False,
    form: Annotated[
        CheckFormat, typer.Option("--format", "-f", help="text, json, or github annotations.")
    ] = CheckFormat.TEXT,
) -> int:
    """Find every mistake in specs, each with its place and what to write instead.

    Nothing that a spec's author wrote is run. With `--claims` specs without mistakes are compiled,
    and each claim under `expect:` is proved, sampled, or refuted with a witness.

    **Examples**

    `specc check specs/`

    `specc check patrol.yaml --format json`

    `specc check patrol.yaml --claims`
    """
    from compiler.check import check as check_file
    from specc.files import spec_files

    files = spec_files(paths)
    if not files:
        raise typer.BadParameter(f"no .yaml file is in {', '.join(map(str, paths))}")
    found = tuple(d for file in files for d in check_file(file))
    failed = any(d.severity == "error" for d in found)
    if claims and not failed:
        show_diagnostics(found)
        return _check_claims(files, form)
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


def _check_claims(files: Sequence[Path], form: CheckFormat) -> int:
    """Put the claims of sound specs to the judge: 1 where one is refuted, 4 where one is open."""
    from specc.claims_text import finding_record

    warmed(None)
    found = [(program, one) for file in files for program, one in _judged(file)]
    if form is CheckFormat.JSON:
        print_json([finding_record(program, finding) for program, finding in found])
    else:
        _print_claims(found, form)
    rulings = {str(finding.ruling) for _, finding in found}
    if "refuted" in rulings:
        return Status.NO
    return Status.INCONCLUSIVE if "undecided" in rulings else Status.YES


def _judged(file: Path) -> "list[tuple[Program, Finding]]":
    from spec_schema.behavior import BehaviorSpec
    from spec_schema.load import load
    from specc.claiming import check_claims
    from specc.loading import load_program

    spec = load(file).spec
    if not isinstance(spec, BehaviorSpec) or not spec.expect:
        return []
    program = load_program(file)
    with progress_bar(file.name) as progress:
        return [(program, finding) for finding in check_claims(program, progress)]


def _print_claims(found: "list[tuple[Program, Finding]]", form: CheckFormat) -> None:
    from specc.claims_text import STYLES, finding_text, totals_text

    for program, finding in found:
        text = finding_text(program, finding)
        if form is CheckFormat.TEXT:
            print_styled(text, f": {finding.ruling}: ", STYLES[finding.ruling])
        elif not finding.ruling.holds:
            typer.echo(_claim_annotation(finding.claim.origin, str(finding.ruling), text))
    say(totals_text([finding for _, finding in found]), "bold")


def _specs(count: int) -> str:
    return f"{count} spec" + ("" if count == 1 else "s")


def _annotation(d: dict[str, object]) -> str:
    message = f"{d['message']} ({d['help']})" if d["help"] else f"{d['message']}"
    where = f"file={d['file']},line={d['line']},col={d['column']},endColumn={d['end_column']}"
    return f"::{d['severity']} {where},title={d['code']}::{_safe(message)}"


def _claim_annotation(origin: str, ruling: str, text: str) -> str:
    file, line, column = origin.rsplit(":", 2)
    severity = "error" if ruling == "refuted" else "warning"
    return f"::{severity} file={file},line={line},col={column},title={ruling}::{_safe(text)}"


def _safe(message: str) -> str:
    return message.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
