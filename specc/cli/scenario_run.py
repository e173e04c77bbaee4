"""A scenario that is run by `specc simulate`: watched, recorded, drawn, and told of."""

from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Final, final

from runtime.progress import Progress
from specc.cli.console import messages, print_json, print_text, progress_bar, say, show_diagnostics
from specc.cli.options import Format
from specc.cli.showing import Pictures, size_text
from specc.cli.status import Status
from specc.cli.warming import warmed

if TYPE_CHECKING:
    from runtime.scenario import Scenario
    from specc.scenarios.simulating import Simulation
    from specc.scenarios.watching import Onlooker

LIGHT_EVERY: Final = 1.0
"""Seconds between two pictures of the light on the floor."""


@final
@dataclass(frozen=True, slots=True)
class Wanted:
    """What a user wants of a run; beside: where code is looked for, as of `simulate_scenario`."""

    duration: str | None
    seed: int | None
    output: Path | None
    pictures: Pictures
    is_watched: bool
    allow_code: bool
    beside: Path | None
    form: Format


def run_scenario(spec: Path, wanted: Wanted) -> Status:
    """Run it, and say whether it went as required."""
    from specc.files import require_suffix
    from specc.loading import load_scenario

    require_suffix(wanted.output, ".mcap")
    wanted.pictures.refuse_early()
    warmed(spec)
    with progress_bar(f"compiling {spec.name}") as bar:
        compiled = load_scenario(spec, bar, wanted.seed, allow_code=wanted.allow_code)
    show_diagnostics(compiled.warnings)
    if wanted.is_watched:
        made, took = _watched(compiled.scenario, wanted), None
    else:
        made, took = _unwatched(compiled.scenario, wanted)
    _write(made, wanted)
    _tell(made, took, wanted.form)
    return _status(made)


def _unwatched(scenario: "Scenario", wanted: Wanted) -> tuple["Simulation", float]:
    """The run with a bar, and how many seconds of the computer it took."""
    began = ended = 0.0
    with progress_bar("simulate") as bar:

        def tell(what: str, done: int, of: int) -> None:
            nonlocal began, ended
            if what == "running":
                ended = perf_counter()
                began = began or ended
            bar(what, done, of)

        made = _simulated(scenario, wanted, tell)
    return made, ended - began


def _watched(scenario: "Scenario", wanted: Wanted) -> "Simulation":
    """The run while it is looked at, at the speed that is wanted."""
    from specc.scenarios.watching import watching

    with watching(
        scenario, messages(), speed=wanted.pictures.speed or 1.0, style=wanted.pictures.style
    ) as onlooker:
        return _simulated(scenario, wanted, onlooker=onlooker)


def _simulated(
    scenario: "Scenario",
    wanted: Wanted,
    tell: Progress | None = None,
    onlooker: "Onlooker | None" = None,
) -> "Simulation":
    from specc.scenarios.simulating import simulate_scenario

    keeps_light = wanted.output is not None or wanted.pictures.are_wanted
    return simulate_scenario(
        scenario,
        duration=wanted.duration,
        allow_code=wanted.allow_code,
        beside=wanted.beside,
        light_every=LIGHT_EVERY if keeps_light else None,
        progress=tell,
        observer=onlooker,
        seen=None if onlooker is None else onlooker.seen,
    )


def _write(made: "Simulation", wanted: Wanted) -> None:
    """The recording first: who interrupts a film keeps it."""
    from specc.recorded import record_run
    from specc.scenarios.pictured import pictured

    if wanted.output is not None:
        with progress_bar("recording") as bar:
            bar(str(wanted.output), 0, 1)
            record_run(made.run, wanted.output)
        size = size_text(wanted.output.stat().st_size)
        say(f"wrote {wanted.output} ({size})", "bold")
    if wanted.pictures.are_wanted:
        with progress_bar(made.run.scenario.name) as bar:
            wanted.pictures.draw(*pictured(made.run, made.requirements), bar)
        wanted.pictures.tell_written()


def _tell(made: "Simulation", took: float | None, form: Format) -> None:
    from specc.texts.simulation import simulation_record, simulation_text

    if form is Format.JSON:
        print_json(simulation_record(made, took))
    else:
        print_text(simulation_text(made, took))


def _status(made: "Simulation") -> Status:
    from verifier.report.requirement_results import Outcome

    statuses = {Outcome.SATISFIED: Status.YES, Outcome.VIOLATED: Status.NO}
    return statuses.get(made.outcome, Status.INCONCLUSIVE)
