"""`specc compile`: from YAML to an artifact with measured error bounds."""

from pathlib import Path
from typing import Annotated, Final

import typer

from specc.cli.console import print_json, print_text, progress_bar, say, show_diagnostics
from specc.cli.options import Format, FormatOption
from specc.cli.warming import warmed

NAMED_BY: Final = {"body": "architecture", "arbiter": "architecture", "world": "scenario"}
"""What is compiled only with something else."""


def compile_(
    spec: Annotated[
        Path,
        typer.Argument(help="A behavior, architecture or scenario spec (.yaml).", metavar="SPEC"),
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

    An architecture or a scenario is compiled with all that it names, into one file. The same spec
    gives the same bytes. A `module` field runs the user's Python, here only.

    **Examples**

    `specc compile specs/van_der_pol.yaml`

    `specc compile specs/van_der_pol.yaml -o build/vdp.specc --format json`

    `specc compile specs/van_der_pol.yaml --dump`

    `specc compile specs/scenarios/first_light.yaml -o first_light.specc`
    """
    from compiler.dump import dump as dumped
    from spec_schema.wording import with_article
    from specc import loading
    from specc.files import require_suffix
    from specc.texts import results

    require_suffix(output, ".specc")

    if spec.suffix == ".specc":
        raise typer.BadParameter(f"{spec} is compiled already: name a spec (.yaml)")
    kind = loading.kind_of(spec)
    if kind in NAMED_BY:
        named = f"{with_article(kind)}, which is compiled with the {NAMED_BY[kind]} that names it"
        raise typer.BadParameter(f"{spec} is {named}")
    if kind == "architecture":
        _architecture(spec, output, form, dumps=dump)
        return
    if kind == "scenario":
        if dump:
            raise typer.BadParameter("--dump is for behaviors and architectures")
        _scenario(spec, output, form)
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


def _architecture(spec: Path, output: Path | None, form: Format, *, dumps: bool) -> None:
    """An architecture with its body and behaviors, in one artifact."""
    from specc import loading
    from specc.texts.wiring import record, summary
    from specc.wired import wired

    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_architecture_spec(spec, progress)
    show_diagnostics(compiled.warnings)
    if dumps:
        found = wired(compiled.architecture, compiled.body)
        print_json(record(found)) if form is Format.JSON else print_text(summary(found))
        return
    path = output or Path(f"{compiled.architecture.name}.specc")
    data = loading.write_architecture(compiled, path)
    channels = {
        channel.name: channel.resolution.way.value for channel in compiled.architecture.channels
    }
    if form is Format.JSON:
        written = {"name": compiled.architecture.name, "artifact": str(path), "bytes": len(data)}
        print_json({**written, "channels": channels, "notes": list(compiled.notes)})
        return
    for channel in compiled.architecture.channels:
        proof = f": {channel.resolution.proof}" if channel.resolution.proof else ""
        say(f"{channel.name} {channel.resolution.way.value}{proof}")
    for note in compiled.notes:
        say(note)
    say(f"wrote {path} ({len(data):,} bytes)", "bold")


def _scenario(spec: Path, output: Path | None, form: Format) -> None:
    """A scenario with its world and robots, in one artifact."""
    from specc import loading

    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_scenario_spec(spec, progress)
    show_diagnostics(compiled.warnings)
    scenario = compiled.scenario
    path = output or Path(f"{scenario.name}.specc")
    data = loading.write_scenario(scenario, path)
    if form is Format.JSON:
        written = {"name": scenario.name, "artifact": str(path), "bytes": len(data)}
        print_json({**written, "step": scenario.step, "notes": list(compiled.notes)})
        return
    robots = ", ".join(robot.name for robot in scenario.robots)
    say(f"{robots} in {scenario.world.name} for {scenario.duration:g} s, seed {scenario.seed}")
    say(f"wrote {path} ({len(data):,} bytes)", "bold")
