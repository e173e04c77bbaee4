"""A behavior run alone, from what a user gives: numbers in the variables' own units."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from runtime.program import Control, Program, State
from runtime.rollout import Rollout
from runtime.simulate import simulate as run
from specc.faults import fault
from specc.given import Value, seconds, settings_for
from specc.loading import as_program


def simulate(
    spec: Program | Path | str,
    start: Mapping[str, Value] | None = None,
    duration: Value = "20 s",
    controls: Mapping[str, Value] | None = None,
    every: Value | None = None,
    *,
    seed: int = 0,
) -> Rollout:
    """Run a behavior alone; sensed-only variables follow their closure or are held.

    Values are numbers in the variable's own unit, or quantities (`"40 cm/s"`). seed: of all chance,
    where the behavior has `noise`.

    Raises:
        SpecError: a name that it does not have, or a value outside its domain.
    """
    program = as_program(spec)
    begin = settings_for(
        program.states, start or {}, "state", _belongs(program.controls, "control", "--set")
    )
    held = settings_for(
        program.controls, controls or {}, "control", _belongs(program.states, "state", "--start")
    )
    step = None if every is None else seconds(every, "every")
    try:
        return run(program, begin, seconds(duration), held, step, seed=seed)
    except ValueError as error:
        see = "see `specc simulate --help`"
        raise fault("V342", program.source.file, str(error), see) from error


def _belongs(parts: Sequence[State | Control], what: str, option: str) -> dict[str, str]:
    """What to write for names that belong to another option."""
    return {part.name: f"it is a {what}: write {option} {part.name}=..." for part in parts}
