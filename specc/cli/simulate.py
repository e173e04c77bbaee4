"""`specc simulate`: run a behavior alone, or a scenario in its world, and record it."""

from pathlib import Path
from typing import Annotated, Final, TypeAlias

import typer

from specc.cli.console import print_json, print_text, say
from specc.cli.options import Format, FormatOption, Settings, assignments
from specc.cli.portrait import StyleOption
from specc.cli.scenario_run import Wanted, run_scenario
from specc.cli.showing import FilmOption, Pictures, PosterOption, SpeedOption, WatchOption
from specc.cli.status import Status
from specc.cli.warming import warmed
from specc.figures.style_names import Style

ALONE: Final = "20 s"
"""How long a behavior alone runs, where nothing is said."""

Spec: TypeAlias = Annotated[
    Path,
    typer.Argument(
        help="A scenario (.yaml), or a behavior spec (.yaml or .specc).", metavar="SPEC"
    ),
]
Duration: TypeAlias = Annotated[
    str | None,
    typer.Option(
        "--duration",
        "-d",
        help="Simulated time: `20`, `20 s`, `2 min`; default 20 s, or the scenario's own.",
    ),
]
Begin: TypeAlias = Annotated[
    list[str],
    typer.Option("--start", metavar="NAME=VALUE", help="Initial value of a state. Repeatable."),
]
Every: TypeAlias = Annotated[
    str | None, typer.Option("--every", help="Time between two samples; default duration/1000.")
]
Seed: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--seed", min=0, help="What all chance follows from; default 0, or the scenario's own."
    ),
]
Recording: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--output", "-o", metavar="FILE", help="Record to this .mcap; a behavior alone also .csv."
    ),
]
AllowCode: TypeAlias = Annotated[
    bool, typer.Option("--allow-code", help="Run Python of yours that the scenario names.")
]


def simulate(
    spec: Spec,
    duration: Duration = None,
    start: Begin = [],  # noqa: B006  typer copies it
    settings: Settings = [],  # noqa: B006
    every: Every = None,
    seed: Seed = None,
    output: Recording = None,
    poster: PosterOption = None,
    film: FilmOption = None,
    watch: WatchOption = False,
    speed: SpeedOption = None,
    style: StyleOption = Style.SCREEN,
    allow_code: AllowCode = False,
    form: FormatOption = Format.TEXT,
) -> int:
    """Run a scenario in its world, or a behavior alone; record it, draw it, watch it.

    A scenario says what is required: exit status 0 where all of it holds, 1 where one requirement
    is violated, 4 where the run is too short to tell. The same seed gives the same run, watched or
    not. Its recording can be looked at later: `specc replay`.

    A behavior alone runs from a start, with its controls held; sensed-only variables follow their
    `closure` or stay at `hold`. A run that leaves the domain stops there and says so. Exit status
    1: it takes more steps than one run may have, and is incomplete.

    The recording carries the compiled spec: `specc verify` on it needs nothing else.

    **Examples**

    `specc simulate specs/scenarios/first_light.yaml --seed 3 -o run.mcap`

    `specc simulate specs/scenarios/light_subsumption.yaml --poster run.svg --animate run.gif`

    `specc simulate specs/scenarios/light_subsumption.yaml --watch --speed 4`

    `specc simulate specs/scenarios/first_light.yaml --format json > run.json`

    `specc simulate specs/van_der_pol.yaml --start x=1 --start v=0 --set mu=1 -o run.mcap`
    """
    from specc import loading

    pictures = Pictures(poster, film, speed, style)
    kind = loading.kind_of(spec)
    if kind == "architecture":
        raise typer.BadParameter(
            f"{spec} is an architecture, which runs in a scenario: name one with it under `robots`"
        )
    if kind == "scenario":
        if start or settings or every is not None:
            raise typer.BadParameter("--start, --set and --every are for a behavior alone")
        beside = loading.beside_artifact(spec)
        wanted = Wanted(duration, seed, output, pictures, watch, allow_code, beside, form)
        return run_scenario(spec, wanted)
    if pictures.are_wanted or watch or speed is not None:
        raise typer.BadParameter(
            "--poster, --animate, --watch and --speed are for a scenario; `specc portrait` draws "
            "a behavior"
        )
    return _behavior(spec, duration or ALONE, start, settings, every, seed, output, form)


def _behavior(
    spec: Path,
    duration: str,
    start: list[str],
    settings: list[str],
    every: str | None,
    seed: int | None,
    output: Path | None,
    form: Format,
) -> int:
    from specc import loading, running
    from specc.files import require_suffix
    from specc.texts import results

    begin, held = assignments(start), assignments(settings)
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
