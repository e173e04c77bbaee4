"""`specc simulate`: run a behavior alone, or a scenario in its world, and record it."""

from pathlib import Path
from time import perf_counter
from typing import Annotated, Final

import typer

from specc.cli.console import print_json, print_text, progress_bar, say
from specc.cli.options import Format, FormatOption, Settings, assignments
from specc.cli.status import Status
from specc.cli.warming import warmed

ALONE: Final = "20 s"
"""How long a behavior alone runs, where nothing is said."""
LIGHT_EVERY: Final = 1.0
"""Seconds between two recorded pictures of the light on the floor."""


def simulate(
    spec: Annotated[
        Path,
        typer.Argument(
            help="A scenario (.yaml), or a behavior spec (.yaml or .specc).", metavar="SPEC"
        ),
    ],
    duration: Annotated[
        str | None,
        typer.Option(
            "--duration",
            "-d",
            help="Simulated time: `20`, `20 s`, `2 min`; default 20 s, or the scenario's own.",
        ),
    ] = None,
    start: Annotated[
        list[str],
        typer.Option("--start", metavar="NAME=VALUE", help="Initial value of a state. Repeatable."),
    ] = [],  # noqa: B006  typer copies it
    settings: Settings = [],  # noqa: B006
    every: Annotated[
        str | None, typer.Option("--every", help="Time between two samples; default duration/1000.")
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed", min=0, help="What all chance follows from; default 0, or the scenario's own."
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Record to this .mcap or .csv file.")
    ] = None,
    allow_code: Annotated[
        bool,
        typer.Option("--allow-code", help="Run Python of yours that the scenario names."),
    ] = False,
    form: FormatOption = Format.TEXT,
) -> int:
    """Run a scenario in its world, or a behavior alone; record it.

    A scenario says what is required: exit status 0 where all of it holds, 1 where one requirement
    is violated, 4 where the run is too short to tell. The same seed gives the same run.

    A behavior alone runs from a start, with its controls held; sensed-only variables follow their
    `closure` or stay at `hold`. A run that leaves the domain stops there and says so. Exit status
    1: it takes more steps than one run may have, and is incomplete.

    The recording carries the compiled spec: `specc verify` on it needs nothing else.

    **Examples**

    `specc simulate specs/scenarios/first_light.yaml --seed 3 -o run.mcap`

    `specc simulate specs/van_der_pol.yaml --start x=1 --start v=0 --set mu=1 -o run.mcap`

    `specc simulate specs/wall_follow.yaml --start distance='40 cm' -d 10 --format json`
    """
    from specc import loading

    if spec.suffix != ".specc" and loading.kind_of(spec) == "scenario":
        if start or settings or every is not None:
            raise typer.BadParameter("--start, --set and --every are for a behavior alone")
        return _scenario(spec, duration, seed, output, form, allow_code=allow_code)
    return _behavior(
        spec,
        duration or ALONE,
        assignments(start),
        assignments(settings),
        every,
        seed,
        output,
        form,
    )


def _scenario(
    spec: Path,
    duration: str | None,
    seed: int | None,
    output: Path | None,
    form: Format,
    *,
    allow_code: bool,
) -> int:
    from specc.files import require_suffix
    from specc.recorded import record_run
    from specc.simulating import simulate_scenario
    from specc.texts.simulation import simulation_record, simulation_text
    from verifier.report.requirement_results import Outcome

    require_suffix(output, ".mcap")
    warmed(spec)
    began = took = 0.0
    with progress_bar("simulate") as bar:

        def tell(what: str, done: int, of: int) -> None:
            nonlocal began, took
            if what == "running":
                began = began or perf_counter()
                took = perf_counter() - began
            bar(what, done, of)

        made = simulate_scenario(
            spec,
            seed=seed,
            duration=duration,
            allow_code=allow_code,
            light_every=None if output is None else LIGHT_EVERY,
            progress=tell,
        )
        if output is not None:
            tell("recording", 1, 1)
            record_run(made.run, output)
    if output is not None:
        say(f"wrote {output}", "bold")
    if form is Format.JSON:
        print_json(simulation_record(made, took))
    else:
        print_text(simulation_text(made, took))
    statuses = {Outcome.SATISFIED: Status.YES, Outcome.VIOLATED: Status.NO}
    return statuses.get(made.outcome, Status.INCONCLUSIVE)


def _behavior(
    spec: Path,
    duration: str,
    begin: dict[str, str],
    held: dict[str, str],
    every: str | None,
    seed: int | None,
    output: Path | None,
    form: Format,
) -> int:
    from specc import loading, running
    from specc.files import require_suffix
    from specc.texts import results

    require_suffix(output, ".mcap", ".csv")
    warmed(spec)
    program = loading.load_program(spec)
    rollout = running.simulate(program, begin, duration, held, every, seed=seed or 0)
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
