"""`specc compile`: from YAML to an artifact with measured error bounds."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, final

import typer

from specc.cli.console import print_json, print_text, progress_bar, say, show_diagnostics
from specc.cli.options import Format, FormatOption
from specc.cli.warming import warmed

if TYPE_CHECKING:
    from collections.abc import Callable

NAMED_BY: Final = {"body": "architecture", "arbiter": "architecture", "world": "scenario"}
"""What is compiled only with something else."""


@final
@dataclass(frozen=True, slots=True)
class Wanted:
    """What a user wants to be made of a spec."""

    output: Path | None
    dumps: bool
    allow_code: bool
    form: Format


def compile_(
    spec: Annotated[
        Path,
        typer.Argument(
            help="A behavior, architecture or scenario spec (.yaml), or a book.", metavar="SPEC"
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Where the artifact goes; default NAME.specc here."),
    ] = None,
    dump: Annotated[
        bool, typer.Option("--dump", help="Print the compiled program as text, and write nothing.")
    ] = False,
    allow_code: Annotated[
        bool,
        typer.Option(
            "--allow-code",
            help="Run fields that are Python of yours, of behaviors in an architecture.",
        ),
    ] = False,
    form: FormatOption = Format.TEXT,
) -> None:
    """Compile a behavior into interpolated tables with a *measured* error bound.

    An architecture or a scenario is compiled with all that it names, into one file. The same spec
    gives the same bytes. A field that is Python code (`module`) is run to make its table: of a
    behavior that you name, and with `--allow-code` of those that an architecture or a scenario
    names. What is compiled runs it no more.

    **Examples**

    `specc compile specs/van_der_pol.yaml`

    `specc compile specs/van_der_pol.yaml -o build/vdp.specc --format json`

    `specc compile specs/van_der_pol.yaml --dump`

    `specc compile specs/scenarios/first_light.yaml -o first_light.specc`

    `specc compile book/`
    """
    from specc.files import require_suffix

    require_suffix(output, ".specc")
    _compiler_of(spec)(spec, Wanted(output, dump, allow_code, form))


def _compiler_of(spec: Path) -> "Callable[[Path, Wanted], None]":
    """What compiles a spec of that kind.

    Raises:
        typer.BadParameter: it is compiled already, or with another one.
    """
    from spec_schema.wording import with_article
    from specc import loading

    if spec.is_dir():
        return _book
    if spec.suffix == ".specc":
        raise typer.BadParameter(f"{spec} is compiled already: name a spec (.yaml)")
    kind = loading.kind_of(spec)
    if kind in NAMED_BY:
        named = f"{with_article(kind)}, which is compiled with the {NAMED_BY[kind]} that names it"
        raise typer.BadParameter(f"{spec} is {named}")
    return {"architecture": _architecture, "scenario": _scenario}.get(kind, _behavior)


def _behavior(spec: Path, wanted: Wanted) -> None:
    from compiler.dump import dump as dumped
    from specc import loading
    from specc.texts import results

    warmed(spec)
    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_spec(spec, progress)
    show_diagnostics(compiled.warnings)
    if wanted.dumps:
        text = dumped(compiled.program, compiled.notes)
        print_json({"dump": text}) if wanted.form is Format.JSON else print_text(text)
        return
    path = wanted.output or Path(f"{compiled.program.name}.specc")
    data = loading.write_artifact(compiled.program, path)
    if wanted.form is Format.JSON:
        print_json(results.compile_record(compiled, path, data))
        return
    print_text(results.compile_summary(compiled))
    say(f"wrote {path} ({len(data):,} bytes)", "bold")


def _architecture(spec: Path, wanted: Wanted) -> None:
    """An architecture with its body and behaviors, in one artifact."""
    from specc import loading
    from specc.texts.architecture import conclusions, conclusions_record
    from specc.texts.wiring import record, summary
    from specc.wired import wired

    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_architecture_spec(spec, progress, allow_code=wanted.allow_code)
    show_diagnostics(compiled.warnings)
    if wanted.dumps:
        found = wired(compiled.architecture, compiled.body)
        print_json(record(found)) if wanted.form is Format.JSON else print_text(summary(found))
        return
    path = wanted.output or Path(f"{compiled.architecture.name}.specc")
    data = loading.write_architecture(compiled, path)
    if wanted.form is Format.JSON:
        written = {"name": compiled.architecture.name, "artifact": str(path), "bytes": len(data)}
        print_json({**written, **conclusions_record(compiled.architecture, compiled.notes)})
        return
    for sentence in conclusions(compiled):
        say(sentence)
    say(f"wrote {path} ({len(data):,} bytes)", "bold")


def _book(folder: Path, wanted: Wanted) -> None:
    """The program of a book, made anew from the specs in it."""
    from specc.book.folder import read_book
    from specc.book.loading import compile_book
    from specc.files import write_atomically

    if wanted.dumps:
        raise typer.BadParameter("--dump is for behaviors and architectures")
    book = read_book(folder)
    with progress_bar(f"compiling {book.name}") as progress:
        data = compile_book(folder, progress, allow_code=wanted.allow_code)
    own = folder / book.artifact
    is_same = own.read_bytes() == data
    path = wanted.output or Path(f"{book.name}.specc")
    write_atomically(path, data)
    if wanted.form is Format.JSON:
        written = {"name": book.name, "artifact": str(path), "bytes": len(data)}
        print_json({**written, "same_as_the_book": is_same})
        return
    told = "the same bytes as" if is_same else "another program than"
    say(f"wrote {path} ({len(data):,} bytes): {told} {own}", "" if is_same else "bold yellow")
    if not is_same:
        say(f"the book was made by specc {book.specc}")


def _scenario(spec: Path, wanted: Wanted) -> None:
    """A scenario with its world and robots, in one artifact."""
    from specc import loading

    if wanted.dumps:
        raise typer.BadParameter("--dump is for behaviors and architectures")
    with progress_bar(f"compiling {spec.name}") as progress:
        compiled = loading.compile_scenario_spec(spec, progress, allow_code=wanted.allow_code)
    show_diagnostics(compiled.warnings)
    scenario = compiled.scenario
    path = wanted.output or Path(f"{scenario.name}.specc")
    data = loading.write_scenario(scenario, path)
    if wanted.form is Format.JSON:
        written = {"name": scenario.name, "artifact": str(path), "bytes": len(data)}
        print_json({**written, "step": scenario.step, "notes": list(compiled.notes)})
        return
    robots = ", ".join(robot.name for robot in scenario.robots)
    say(f"{robots} in {scenario.world.name} for {scenario.duration:g} s, seed {scenario.seed}")
    say(f"wrote {path} ({len(data):,} bytes)", "bold")
