"""What a trace leaves open: all of it, the most telling first."""

from runtime.program import Program
from verifier.diagnosis.parameters import parameters_of
from verifier.diagnosis.scene import scene_of
from verifier.diagnosis.sensitivities import Sensitivities, sensitivities
from verifier.fidelity.shooting.study import Study
from verifier.limits.commands import untold_of_inputs
from verifier.limits.directions import untold_of_numbers
from verifier.limits.visited import untold_of_features, untold_of_modes, untold_of_states
from verifier.report.limits import NotTold


def what_is_not_told(
    program: Program, study: Study, found: Sensitivities | None = None
) -> tuple[NotTold, ...]:
    """Numbers of the spec, inputs, modes, places and features of which this trace tells nothing.

    found: how much it tells of each number, where that is known already.
    """
    assert program.fidelity is not None, "a study needs a fidelity"
    inputs = untold_of_inputs(program, study)
    known = frozenset(name for each in inputs for name in each.names)
    if found is None:
        found = told_of_numbers(program, study)
    numbers = [] if found is None else untold_of_numbers(program, found, known)
    return (
        *numbers,
        *inputs,
        *untold_of_modes(program, study),
        *untold_of_features(program, study),
        *untold_of_states(program, program.fidelity, study, known),
    )


def told_of_numbers(program: Program, study: Study) -> Sensitivities | None:
    """The sensitivities of a study; None where no window is long enough for a refit."""
    scene = scene_of(program, study)
    parameters = parameters_of(program, study.plan.needs)
    return sensitivities(scene, parameters) if scene.windows and parameters else None
