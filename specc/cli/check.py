"""`specc check`: every mistake at once, and on demand every claim."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

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
    from compiler.check_kinds import Wired
    from runtime.program import Program
    from spec_schema.diagnostics import Diagnostic
    from verifier.topology.claims.findings import Finding

TOLD: Final = 3
"""Of more files what was proved is told only where it is wanted."""


def check(
    paths: Annotated[list[Path], typer.Argument(help="Specs, or folders of them.", metavar="SPEC")],
    claims: Annotated[
        bool,
        typer.Option("--claims", help="Compile the specs, and prove or refute their `expect:`."),
    ] = False,
    notes: Annotated[
        bool | None,
        typer.Option(
            "--notes/--no-notes",
            help="Tell what was proved of architectures, what they leave open, and the rules of "
            "arbiters; default: "
            f"where at most {TOLD} files are checked, and in JSON not.",
        ),
    ] = None,
    allow_code: Annotated[
        bool, typer.Option("--allow-code", help="With --claims: run fields that are your Python.")
    ] = False,
    form: ReportFormatOption = ReportFormat.TEXT,
) -> int:
    """Find every mistake in specs, each with its place and what to write instead.

    Nothing that a spec's author wrote is run. With `--claims` specs without mistakes are compiled,
    and each claim under `expect:` is proved, sampled, or refuted with a witness.

    Of an architecture it tells how each channel is resolved and, where `exclusive` is claimed, the
    proof; then what is left open: controls at their defaults, outputs that no node reads. Of an
    arbiter it tells its rules as sentences, sorted by what they decide.

    **Examples**

    `specc check specs/`

    `specc check patrol.yaml --format json`

    `specc check patrol.yaml --claims`

    `specc check specs/architectures/ --notes`

    `specc check specs/arbiters/who_goes.yaml`
    """
    files = _files(paths)
    is_bare = notes is False
    if notes is None:
        notes = form is ReportFormat.TEXT and len(files) <= TOLD
    found, made = _checked(files)
    if any(each.severity == "error" for each in found):
        _print(found, made if notes and form is ReportFormat.JSON else None, form, claims=claims)
        return Status.BAD_INPUT
    wired = made if notes else None
    if claims:
        show_diagnostics(found)
        return _check_claims(files, found, wired, form, allow_code=allow_code)
    _print(found, wired, form)
    if form is ReportFormat.TEXT:
        further = "; `specc compile` makes the tables of fields, and looks at their values"
        done = f"{_specs(len(files))} without mistakes"
        is_open = not is_bare and (_has_fields(made) or len(files) > 1)
        say(done + further * bool(is_open), "bold green")
    return Status.YES


def _has_fields(made: "Sequence[Wired]") -> bool:
    """Whether there is more than arbiters, which have no tables."""
    if not made:
        return False
    from compiler.architecture.arbiters import CompiledArbiter

    return any(not isinstance(each, CompiledArbiter) for each in made)


def _files(paths: Sequence[Path]) -> Sequence[Path]:
    """The specs that are meant.

    Raises:
        typer.BadParameter: there is none.
        SpecError: one is a log.
    """
    from specc.files import spec_files
    from specc.loading import refuse_log

    files = spec_files(paths)
    for file in files:
        refuse_log(file)
    if not files:
        raise typer.BadParameter(f"no .yaml file is in {', '.join(map(str, paths))}")
    return files


def _checked(files: Sequence[Path]) -> "tuple[list[Diagnostic], list[Wired]]":
    """Everything that is wrong or doubtful, and the sound architectures and scenarios."""
    from compiler.check import check_file

    checked = [check_file(file) for file in files]
    found = list(dict.fromkeys(each for one in checked for each in one.diagnostics))
    return found, [one.made for one in checked if one.made is not None]


def _print(
    found: "Sequence[Diagnostic]",
    wired: "Sequence[Wired] | None",
    form: ReportFormat,
    *,
    claims: bool = False,
) -> None:
    """What was found without compiling; wired: None where nobody wants to be told of it."""
    match form:
        case ReportFormat.JSON:
            record = _record(found, wired)
            bare = wired is None and not claims
            print_json(record["mistakes"] if bare else record | ({"claims": []} if claims else {}))
        case ReportFormat.GITHUB:
            print_annotations(found)
        case ReportFormat.TEXT:
            show_diagnostics(found)
            _tell(wired or ())


def _record(
    found: "Sequence[Diagnostic]", wired: "Sequence[Wired] | None"
) -> dict[str, list[dict[str, object]]]:
    """Mistakes, and what was proved and left open where it is wanted."""
    record = {"mistakes": [each.as_json() for each in found]}
    if wired is not None:
        from compiler.architecture.arbiters import CompiledArbiter
        from specc.texts.architecture import conclusions_records

        arbiters = [each for each in wired if isinstance(each, CompiledArbiter)]
        others = [each for each in wired if not isinstance(each, CompiledArbiter)]
        record["architectures"] = [one for each in others for one in conclusions_records(each)]
        if arbiters:
            record["arbiters"] = [one for each in arbiters for one in conclusions_records(each)]
    return record


def _tell(wired: "Sequence[Wired]") -> None:
    """What was proved and left open, in a quiet style; of several with their names."""
    if not wired:
        return
    from specc.texts.architecture import conclusions

    for each in wired:
        for sentence in conclusions(each, named=len(wired) > 1):
            say(sentence, "dim")


def _check_claims(
    files: Sequence[Path],
    mistakes: "Sequence[Diagnostic]",
    wired: "Sequence[Wired] | None",
    form: ReportFormat,
    *,
    allow_code: bool,
) -> int:
    """Put the claims of sound specs to the judge: 1 where one is refuted, 4 where one is open.

    Each is printed as soon as it is decided; 130 where the user does not wait for the rest.
    """
    from specc.texts.claims import finding_record, totals_text

    warmed(None)
    if form is ReportFormat.TEXT:
        _tell(wired or ())
    found: list[tuple[Program, Finding]] = []
    interrupted = False
    try:
        for program, finding in _judged(files, form, allow_code=allow_code):
            found.append((program, finding))
    except KeyboardInterrupt:
        interrupted = True
    if form is ReportFormat.JSON:
        records = [finding_record(program, finding) for program, finding in found]
        print_json({**_record(mistakes, wired), "claims": records})
    if found if interrupted else form is not ReportFormat.JSON:
        say(totals_text([finding for _, finding in found]), "bold")
    if interrupted:
        say(f"interrupted; {_unjudged(files, found)} not judged", "bold yellow")
        return Status.INTERRUPTED
    rulings = {str(finding.ruling) for _, finding in found}
    if "refuted" in rulings:
        return Status.NO
    return Status.INCONCLUSIVE if "undecided" in rulings else Status.YES


def _judged(
    files: Sequence[Path], form: ReportFormat, *, allow_code: bool
) -> "Iterator[tuple[Program, Finding]]":
    """The claims of all specs, each printed for people once it is decided."""
    from specc.loading import load_program
    from verifier.topology.claims.judge import judged

    for file in files:
        if not (_claims_in(file) or _is_sketch(file)):
            continue
        with shown_bar(file.name) as bar:
            program = load_program(file, allow_code=allow_code)
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
