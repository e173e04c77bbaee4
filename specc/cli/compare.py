"""`specc compare`: hold one behavior against another, such as code against a sketch."""

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from specc.cli.console import print_json, print_styled, say
from specc.cli.options import Format, FormatOption, Settings, assignments, names_of
from specc.cli.status import Status
from specc.cli.warming import warmed

Found: TypeAlias = Annotated[
    Path, typer.Argument(help="The behavior that there is (.yaml, .specc).", metavar="SPEC")
]
Wanted: TypeAlias = Annotated[
    Path, typer.Argument(help="The one that is wanted, such as a sketch.", metavar="WANTED")
]
Output: TypeAlias = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="Draw where they differ: .svg, .png or .pdf."),
]
Axes: TypeAlias = Annotated[
    str | None, typer.Option("--axes", "-a", metavar="X,Y", help="The states to compare over.")
]
Tolerance: TypeAlias = Annotated[
    float,
    typer.Option(
        "--tolerance", "-t", min=0.0, help="Of each rate, as a share of its largest size."
    ),
]
Moved: TypeAlias = Annotated[
    float,
    typer.Option(
        "--moved", min=0.0, help="Of features' places, as a share of the domain; of periods."
    ),
]


def compare(
    found: Found,
    wanted: Wanted,
    output: Output = None,
    axes: Axes = None,
    settings: Settings = [],  # noqa: B006  typer copies it
    tolerance: Tolerance = 0.05,
    moved: Moved = 0.05,
    form: FormatOption = Format.TEXT,
) -> int:
    """Say where a behavior departs from another: place by place, and feature by feature.

    Exit status 0: the field is within tolerance everywhere, and every fixed point and cycle is
    where it should be and of its type. Else 1, and what moved, changed, is missing or extra.

    **Examples**

    `specc compare circling.yaml sketch.yaml`

    `specc compare code.yaml sketch.yaml --tolerance 0.2 --set speed=0.4 -o difference.svg`
    """
    from specc.comparing import compare_behaviors
    from specc.files import require_suffix
    from specc.loading import load_program
    from specc.texts.comparison import STYLES, comparison_record, comparison_text, verdict_text
    from verifier.topology.comparing.comparison import Tolerances

    require_suffix(output, ".svg", ".png", ".pdf")
    warmed(found)
    comparison = compare_behaviors(
        load_program(found),
        load_program(wanted),
        names_of(axes),
        assignments(settings),
        Tolerances(tolerance, moved),
    )
    if form is Format.JSON:
        print_json(comparison_record(comparison))
    else:
        style = STYLES[comparison.adheres]
        print_styled(comparison_text(comparison), verdict_text(comparison), style)
    if output is not None:
        from specc.drawn import write_picture
        from specc.figures.difference import draw_difference
        from specc.figures.style_names import Style

        write_picture(draw_difference(comparison), output, Style.SCREEN)
        say(f"wrote {output}", "bold")
    return Status.YES if comparison.adheres else Status.NO
