"""`specc check`: every mistake at once, and on demand every claim."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from specc.cli.console import (
    print_annotations,
    print_json,
    print_styled,
    say,
    show_diagnostics,
    shown_bar,
)
from specc.cli.options import ReportFormat, ReportFormatOption
from specc.cli.status import Status
from specc.cli.warming import warmed

if TYPE_CHECKING:
    from runtime.program import Program
    from verifier.topology.claims.findings import Finding


def check(
    paths: Annotated[list[Path], typer.Argument(help="Specs, or folders of them.", metavar="SPEC")],
    claims: Annotated[
        bool,
        typer.Option("--claims", help="Compile the specs, and prove or refute their `expect:`."),
    ] = False,
    form: ReportFormatOption = ReportFormat.TEXT,
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
    from specc.loading import refuse_log

    files = spec_files(paths)
    for file in files:
        refuse_log(file)
    if not files:
        raise typer.BadParameter(f"no .yaml file is in {', '.join(map(str, paths))}")
    found = tuple(d for file in files for d in check_file(file))
    failed = any(d.severity == "error" for d in found)
    if claims and not failed:
        show_diagnostics(found)
        return _check_claims(files, form, [d.as_json() for d in found])
    match form:
        case ReportFormat.JSON:
            mistakes = [d.as_json() for d in found]
            print_json({"mistakes": mistakes, "claims": []} if claims else mistakes)
        case ReportFormat.GITHUB:
            print_annotations(found)
        case ReportFormat.TEXT:
            show_diagnostics(found)
            if not failed:
                say(f"{_specs(len(files))} without mistakes", "bold green")
    return Status.BAD_INPUT if failed else Status.YES


def _check_claims(
    files: Sequence[Path], form: ReportFormat, mistakes: list[dict[str, object]]
) -> int:
    """Put the claims of sound specs to the judge: 1 where one is refuted, 4 where one is open.

    Each is printed as soon as it is decided; 130 where the user does not wait for the rest.
    """
    from specc.texts.claims import finding_record, totals_text

    warmed(None)
    found: list[tuple[Program, Finding]] = []
    interrupted = False
    try:
        for program, finding in _judged(files, form):
            found.append((program, finding))
    except KeyboardInterrupt:
        interrupted = True
    if form is ReportFormat.JSON:
        records = [finding_record(program, finding) for program, finding in found]
        print_json({"mistakes": mistakes, "claims": records})
    if found if interrupted else form is not ReportFormat.JSON:
        say(totals_text([finding for _, finding in found]), "bold")
    if interrupted:
        say(f"interrupted; {_unjudged(files, found)} not judged", "bold yellow")
        return Status.INTERRUPTED
    rulings = {str(finding.ruling) for _, finding in found}
    if "refuted" in rulings:
        return Status.NO
    return Status.INCONCLUSIVE if "undecided" in rulings else Status.YES


def _judged(files: Sequence[Path], form: ReportFormat) -> "Iterator[tuple[Program, Finding]]":
    """The claims of all specs, each printed for people once it is decided."""
    from specc.loading import load_program
    from verifier.topology.claims.judge import judged

    for file in files:
        if not (_claims_in(file) or _is_sketch(file)):
            continue
        with shown_bar(file.name) as bar:
            program = load_program(file)
            for finding in judged(program, None, bar.advance):
                with bar.aside():
                    _print_claim(program, finding, form)
                yield program, finding


def _claims_in(file: Path) -> int:
    """How many claims the author of a spec made."""
    from spec_schema.behavior import BehaviorSpec
    from spec_schema.load import load

    spec = load(file).spec
    return len(spec.expect) if isinstance(spec, BehaviorSpec) else 0


def _is_sketch(file: Path) -> bool:
    """Whether the spec carries claims that its author drew."""
    from spec_schema.behavior import BehaviorSpec
    from spec_schema.field_sketch import Sketch
    from spec_schema.load import load

    spec = load(file).spec
    return isinstance(spec, BehaviorSpec) and isinstance(spec.field.form, Sketch)


def _unjudged(files: Sequence[Path], found: "Sequence[tuple[Program, Finding]]") -> str:
    """How many of the claims that authors made are left: `2 claims were`."""
    made = sum(not finding.claim.sketched for _, finding in found)
    left = sum(_claims_in(file) for file in files) - made
    return f"{left} claim was" if left == 1 else f"{left} claims were"


def _print_claim(program: "Program", finding: "Finding", form: ReportFormat) -> None:
    from specc.texts.claims import STYLES, finding_text
    from verifier.report.annotations import annotation

    if form is ReportFormat.TEXT:
        text = finding_text(program, finding)
        print_styled(text, f": {finding.ruling}: ", STYLES[finding.ruling])
    elif form is ReportFormat.GITHUB and not finding.ruling.holds:
        text = finding_text(program, finding)
        severity = "error" if finding.ruling == "refuted" else "warning"
        typer.echo(annotation(severity, finding.claim.origin, str(finding.ruling), text))


def _specs(count: int) -> str:
    return f"{count} spec" + ("" if count == 1 else "s")
