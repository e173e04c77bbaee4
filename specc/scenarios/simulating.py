"""A scenario run, and judged by what is required of it."""

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import final

from runtime.progress import Progress, in_silence
from runtime.run import Run, Seen, run
from runtime.run_size import MOST, bytes_of, gigabytes
from runtime.scenario import Scenario
from runtime.scheduler.observer import Observer
from specc.faults import fault
from specc.given import Value, seconds
from specc.loading import beside_artifact, load_scenario
from specc.scenarios.failures import ALLOW, told_failures
from verifier.architectures.required import results_on
from verifier.report.requirement_results import Outcome, RequirementResult


@final
@dataclass(frozen=True, eq=False, slots=True)
class Simulation:
    """A run, and whether it is as required."""

    run: Run
    requirements: tuple[RequirementResult, ...]

    @property
    def outcome(self) -> Outcome:
        """Violated where one requirement is, else open where one is, else satisfied."""
        outcomes = {each.outcome for each in self.requirements}
        worst = (one for one in (Outcome.VIOLATED, Outcome.OPEN) if one in outcomes)
        return next(worst, Outcome.SATISFIED)


def simulate_scenario(
    spec: Scenario | Path | str,
    *,
    seed: int | None = None,
    duration: Value | None = None,
    allow_code: bool = False,
    beside: Path | None = None,
    light_every: float | None = None,
    progress: Progress | None = None,
    observer: Observer | None = None,
    seen: Seen | None = None,
) -> Simulation:
    """Run a scenario, and judge the run by its requirements.

    Args:
        spec: a compiled scenario, or the path of one.
        seed, duration: in the place of the scenario's own.
        allow_code: whether Python that the scenario names may be run.
        beside: the folder where it is looked for; None for that of the artifact, or else of the
            spec that names it.
        light_every: seconds between two pictures of the light on the floor; None for none.
        progress: is told what is done, how much of it, and of how much.
        observer, seen: are told everything as it happens, and where all are; see `run`.

    Raises:
        SpecError: the spec is wrong, there is no room (V381), or code of the user's own may not
            be run (V336, V382) or fails (V382).
    """
    tell = progress or in_silence
    if not isinstance(spec, Scenario):
        beside = beside or beside_artifact(Path(spec))
        spec = load_scenario(spec, tell, allow_code=allow_code).scenario
    scenario = spec
    if seed is not None:
        scenario = dataclasses.replace(scenario, seed=seed)
    if duration is not None:
        scenario = dataclasses.replace(scenario, duration=whole(seconds(duration), scenario.step))
    _refuse_too_large(scenario, light_every)
    allow = "" if allow_code else ALLOW
    with told_failures(scenario, allow):
        made = run(
            scenario,
            allow_code=allow_code,
            beside=beside,
            light_every=light_every,
            observer=observer,
            seen=seen,
            progress=lambda done, of: tell("running", done, of),
        )
    tell("judging", 1, 1)
    return Simulation(made, required_of(made))


def required_of(made: Run) -> tuple[RequirementResult, ...]:
    """What the run says of each requirement of its scenario."""
    return results_on(made.scenario.requirements, made.signals, made.duration)


def whole(duration: float, step: float) -> float:
    """A duration as the nearest whole number of steps, and one at least."""
    return max(round(duration / step), 1) * step


def _refuse_too_large(scenario: Scenario, light_every: float | None) -> None:
    """Refuse a run that takes more memory than it may, before it begins (V383)."""
    takes = bytes_of(scenario, light_every)
    if takes <= MOST:
        return
    message = (
        f"a run of {scenario.duration:.12g} s takes about {gigabytes(takes)} of memory, "
        f"of which {gigabytes(MOST)} are allowed"
    )
    raise fault("V383", scenario.source.file, message, "take a shorter --duration")
