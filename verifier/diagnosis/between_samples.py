"""Inputs that are logged at even intervals and jump between two samples.

When such an input jumped is known up to one interval too late: half of one, on average. A late log
of that size says how it was recorded, and nothing of the robot. What is left of it differs from
jump to jump, and so does what explains one window only.
"""

from typing import Final

import numpy as np

from verifier.diagnosis.altered import Effect
from verifier.diagnosis.courses import Course
from verifier.diagnosis.scene import Scene
from verifier.report.diagnosis import CandidateKind
from verifier.report.wording import number

RARE: Final = 0.25
"""An input that changes at no more than this share of its samples is held, and jumps."""


def recorded_between(scene: Scene, effect: Effect, kind: CandidateKind, delay: float) -> str:
    """What is to be said of a late log of one input; empty where it is no matter of recording."""
    if kind is not CandidateKind.LATE_LOG or len(effect.applies_to) != 1:
        return ""
    (name,) = effect.applies_to
    course = scene.plain.courses.get(name)
    if course is None or not _jumps(course):
        return ""
    interval = float(np.median(np.diff(course.times)))
    if not 0.0 < -delay <= interval:
        return ""
    every = f"{number(interval)} s"
    return (
        f"; {name} is logged every {every} and may jump in between, so its jumps are told up to"
        f" {every} late: that is how it was recorded, and no fault of the robot"
    )


def jumps_between_samples(scene: Scene) -> bool:
    """Whether some input does: then a window may be off for no reason but this."""
    return any(_jumps(course) for course in scene.plain.courses.values())


def _jumps(course: Course) -> bool:
    changes = int(np.sum(np.diff(course.values) != 0.0))
    return 0 < changes <= RARE * len(course.values)
