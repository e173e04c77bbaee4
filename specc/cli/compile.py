"""`specc compile`: from YAML to an artifact with measured error bounds."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, progress_bar, say, show_diagnostics
from specc.cli.options import Format, FormatOption
from specc.cli.warming import warmed


def compile_(
    spec: Annotated[
        Path, typer.Argument(help="A behavior or architecture spec (.yaml).", metavar="SPEC")
    ],
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

    An architecture is compiled with all that it names, into one file. The same spec gives the same
    bytes. A `module` field runs the user's Python, here only.

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

    if loading.kind_of(spec) == "architecture":
        _architecture(spec, output, form)
        return
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


def _architecture(spec: Path, output: Path | None, form: Format) -> None:
    """An architecture with its body and behaviors, in one artifact."""
    from specc import loading

    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_architecture_spec(spec, progress)
    show_diagnostics(compiled.warnings)
    path = output or Path(f"{compiled.architecture.name}.specc")
    data = loading.write_architecture(compiled, path)
    channels = {
        channel.name: channel.resolution.way.value for channel in compiled.architecture.channels
    }
    if form is Format.JSON:
        record = {"name": compiled.architecture.name, "artifact": str(path), "bytes": len(data)}
        print_json({**record, "channels": channels, "notes": list(compiled.notes)})
        return
    for channel in compiled.architecture.channels:
        proof = f": {channel.resolution.proof}" if channel.resolution.proof else ""
        say(f"{channel.name} {channel.resolution.way.value}{proof}")
    for note in compiled.notes:
        say(note)
    say(f"wrote {path} ({len(data):,} bytes)", "bold")
