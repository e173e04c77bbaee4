"""`specc compile`: from YAML to an artifact with measured error bounds."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, progress_bar, say, show_diagnostics
from specc.cli.options import Format, FormatOption
from specc.cli.warming import warmed


def compile_(
    spec: Annotated[Path, typer.Argument(help="A behavior spec (.yaml).", metavar="SPEC")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Where the artifact goes; default NAME.specc here."),
    ] = None,
    dump: Annotated[
        bool, typer.Option("--dump", help="Print the compiled program as text, and write nothing.")
    ] = False,
    form: FormatOption = Format.TEXT,
) -> None:
    """Compile a behavior into interpolated tables with a *measured* error bound.

    The same spec gives the same bytes. A `module` field runs the user's Python, here only.

    **Examples**

    `specc compile specs/van_der_pol.yaml`

    `specc compile specs/van_der_pol.yaml -o build/vdp.specc --format json`

    `specc compile specs/van_der_pol.yaml --dump`
    """
    from compiler.dump import dump as dumped
    from specc import loading
    from specc.files import require_suffix
    from specc.texts import results

    require_suffix(output, ".specc")

    warmed(spec)
    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_spec(spec, progress)
    show_diagnostics(compiled.warnings)
    if dump:
        text = dumped(compiled.program, compiled.notes)
        print_json({"dump": text}) if form is Format.JSON else print_text(text)
        return
    path = output or Path(f"{compiled.program.name}.specc")
    data = loading.write_artifact(compiled.program, path)
    if form is Format.JSON:
        print_json(results.compile_record(compiled, path, data))
        return
    print_text(results.compile_summary(compiled))
    say(f"wrote {path} ({len(data):,} bytes)", "bold")
