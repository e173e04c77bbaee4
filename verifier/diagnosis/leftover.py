"""What an explanation leaves: the departure at the horizon, worked out under it alone."""

from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.program import Fidelity, State
from verifier.diagnosis.aftermath import altered_study
from verifier.diagnosis.fitting import Fit
from verifier.diagnosis.profiled import setting_of
from verifier.diagnosis.scene import Scene
from verifier.fidelity.shooting.study import Study
from verifier.report.wording import number, quantity


@final
@dataclass(frozen=True, eq=False, slots=True)
class Bench:
    """Where explanations are judged: the windows that they were fitted to, and the verdict's."""

    scene: Scene
    study: Study
    fidelity: Fidelity


def leaves(bench: Bench, fitted: Fit) -> str:
    """By how much the variable that fares worst exceeds its tolerance; empty where none does.

    As `0.5 rad of heading, 25 times what is allowed`. The noise of the sensors is taken out.
    """
    setting = setting_of(bench.scene, fitted.effects, fitted.values)
    study = altered_study(bench.scene, bench.study, setting)
    found: list[tuple[float, float, State]] = []
    for samples, errors in zip(study.plan.samples, study.shots.errors[-1], strict=True):
        state = samples.state
        known = np.isfinite(errors.mean)
        if state.name in bench.fidelity.tolerance and np.any(known):
            square = float(np.mean(errors.mean[known] ** 2 - errors.variance[known]))
            beside = bench.fidelity.scatter.get(state.name, 0.0)
            allowed = float(np.hypot(bench.fidelity.tolerance[state.name], beside))
            found.append((max(square, 0.0) ** 0.5, allowed, state))
    beyond = [each for each in found if each[0] > each[1]]
    if not beyond:
        return ""
    left, allowed, state = max(beyond, key=lambda each: each[0] / each[1])
    times = number(left / allowed)
    return f"{quantity(left, state.unit)} of {state.name}, {times} times what is allowed"
