"""`specc simulate`: run a behavior alone and record it."""

from pathlib import Path
from typing import Annotated

import typer

from specc.cli.console import print_json, print_text, say
from specc.cli.options import Format, FormatOption, Settings, SpecPath, assignments
from specc.cli.status import Status
from specc.cli.warming import warmed


def simulate(
    spec: SpecPath,
    duration: Annotated[
        str, typer.Option("--duration", "-d", help="Simulated time: `20`, `20 s`, `2 min`.")
    ] = "20 s",
    start: Annotated[
        list[str],
        typer.Option("--start", metavar="NAME=VALUE", help="Initial value of a state. Repeatable."),
    ] = [],  # noqa: B006  typer copies it
    settings: Settings = [],  # noqa: B006
    every: Annotated[
        str | None, typer.Option("--every", help="Time between two samples; default duration/1000.")
    ] = None,
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="What chance follows from, where there is `noise`.")
    ] = 0,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Record to this .mcap or .csv file.")
    ] = None,
    form: FormatOption = Format.TEXT,
) -> int:
    """Run a behavior alone, from a start, with its controls held; record it as MCAP or CSV.

    Sensed-only variables follow their `closure` or stay at `hold`. A run that leaves the domain
    stops there and says so. The recording carries the compiled spec: `specc verify` on it needs
    nothing else. Exit status 1: it takes more steps than one run may have, and is incomplete.

    **Examples**

    `specc simulate specs/van_der_pol.yaml --start x=1 --start v=0 --set mu=1 -o run.mcap`

    `specc simulate specs/wall_follow.yaml --start distance='40 cm' -d 10 --format json`
    """
    from specc import loading, running
    from specc.files import require_suffix
    from specc.texts import results

    require_suffix(output, ".mcap", ".csv")
    warmed(spec)
    program = loading.load_program(spec)
    begin, held = assignments(start), assignments(settings)
    rollout = running.simulate(program, begin, duration, held, every, seed=seed)
    if output is not None:
        from specc.recorded import record

        record(program, rollout, output)
        say(f"wrote {output}", "bold")
    if form is Format.JSON:
        print_json(results.rollout_record(program, rollout))
    else:
        print_text(results.rollout_summary(program, rollout))
    if told := results.incomplete(program, rollout):
        say(told, "bold red")
        return Status.NO
    return Status.YES
