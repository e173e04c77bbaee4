"""`specc portrait`: a phase portrait, as a picture and as numbers."""

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from specc.cli.console import print_json, print_text, progress_bar, say, show_diagnostics
from specc.cli.options import Format, FormatOption, SpecPath, assignments, names_of, one_assignment
from specc.cli.warming import warmed
from specc.figures.style_names import Style

Output: TypeAlias = Annotated[
    Path | None,
    typer.Option("--output", "-o", help=".svg, .png, .pdf or .json; default NAME.svg here."),
]
Axes: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--axes",
        "-a",
        metavar="X,Y",
        help="One to three states, default the first two; of an arbiter one or two of its reads.",
    ),
]
Held: TypeAlias = Annotated[
    list[str],
    typer.Option(
        "--set",
        "--at",
        "-s",
        metavar="NAME=VALUE",
        help="Set a control or hold a state, in its own unit or with one. Repeatable.",
    ),
]
Values: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--sweep",
        metavar="NAME=LOW:HIGH:COUNT",
        help="A panel for each value of a control or a mode: `mu=0.1:3:6`, "
        "`speed=0.1,0.5`, `going=forward,back`.",
    ),
]
Slices: TypeAlias = Annotated[
    str | None,
    typer.Option("--slices", metavar="NAME=COUNT", help="A panel for each slice of a state."),
]
Against: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--against",
        metavar="NAME[=LOW:HIGH]",
        help="Bifurcation diagram: fixed points and cycles against a control.",
    ),
]
StyleOption: TypeAlias = Annotated[
    Style, typer.Option("--style", help="For screens, for journals in grey, for dark pages.")
]


def portrait(
    spec: SpecPath,
    output: Output = None,
    axes: Axes = None,
    settings: Held = [],  # noqa: B006  typer copies it
    sweep: Values = None,
    slices: Slices = None,
    against: Against = None,
    style: StyleOption = Style.SCREEN,
    form: FormatOption = Format.TEXT,
) -> None:
    """Draw the phase portrait of a behavior: field, fixed points, cycles, separatrices, basins.

    States that are not drawn are held at `hold`, controls at their defaults; `--at` says else.
    Three axes give a view of the solid.

    Of an arbiter it draws which choice holds where, over two of what it reads: by default those
    that matter most. What else it reads is held in the middle of its domain.

    **Examples**

    `specc portrait specs/van_der_pol.yaml -o vdp.svg --at mu=2`

    `specc portrait specs/van_der_pol.yaml --sweep mu=0.1:3:6 --style journal -o vdp.pdf`

    `specc portrait specs/van_der_pol.yaml --against mu -o bifurcations.svg`

    `specc portrait specs/wall_follow.yaml --axes distance,heading --format json`

    `specc portrait specs/arbiters/who_goes.yaml --axes ahead,left --at goal=1 -o who_goes.svg`
    """
    from specc import loading, portraying
    from specc.files import require_suffix
    from specc.texts.portrait import record, summary

    require_suffix(output, ".svg", ".png", ".pdf", ".json")
    names = names_of(axes)
    held = assignments(settings)
    if loading.kind_of(spec) == "arbiter":
        if against is not None or (sweep and slices):
            raise typer.BadParameter("of an arbiter take one of --sweep and --slices")
        _of_arbiter(spec, names, held, sweep or slices, output, style, form)
        return
    warmed(spec)
    program = loading.load_program(spec)
    found: portraying.Found
    match sweep or slices, against:
        case None, None:
            found = portraying.portrait(program, names, held)
        case str(text), None if not (sweep and slices):
            name, values = one_assignment(text)
            found = portraying.sweep(program, name, values, names, held)
        case None, str(text) if names is None:
            name, _, ends = text.partition("=")
            with progress_bar(program.name) as progress:
                found = portraying.branches(program, name.strip(), ends or None, held, progress)
        case None, _:
            raise typer.BadParameter("--against looks at all states that move: leave --axes out")
        case _:
            raise typer.BadParameter("take one of --sweep, --slices and --against")
    if form is Format.JSON:
        print_json(record(found))
    else:
        print_text(summary(found))
    if output is not None or form is Format.TEXT:
        from specc.drawn import draw

        path = output or Path(f"{program.name}.svg")
        draw(found, path, style)
        say(f"wrote {path}", "bold")


def _of_arbiter(
    spec: Path,
    names: tuple[str, ...] | None,
    held: dict[str, str],
    swept: str | None,
    output: Path | None,
    style: Style,
    form: Format,
) -> None:
    """What an arbiter decides where."""
    from compiler.architecture.arbiters import compile_arbiter
    from specc.portraying_arbiters import FoundOfArbiter, arbiter_portrait, arbiter_sweep
    from specc.texts.arbiter_portraits import record_of_arbiter, summary_of_arbiter

    compiled = compile_arbiter(spec)
    show_diagnostics(compiled.warnings)
    found: FoundOfArbiter
    if swept is None:
        found = arbiter_portrait(compiled.arbiter, names, held)
    else:
        found = arbiter_sweep(compiled.arbiter, *one_assignment(swept), names, held)
    if form is Format.JSON:
        print_json(record_of_arbiter(found))
    else:
        print_text(summary_of_arbiter(found))
    if output is not None or form is Format.TEXT:
        from specc.drawn import draw

        path = output or Path(f"{compiled.arbiter.name}.svg")
        draw(found, path, style)
        say(f"wrote {path}", "bold")
