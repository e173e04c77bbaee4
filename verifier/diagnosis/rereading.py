"""Which way of reading the trace fits the spec best.

Readings differ in the size of what is measured, so residuals alone do not compare: a heading that
is read in degrees for radians hardly moves, and what is left of it is small whatever is true. So
each variable counts by what is left of it *beside what a variable that is read so and stands still
would leave*; on a circle that is never more than chance would.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.flow import flow_of
from runtime.program import Fidelity, Program
from verifier.diagnosis.candidates.readings import Reading, readings_of
from verifier.diagnosis.fitting import Fit, correlation_time, plain_fit
from verifier.diagnosis.scene import Observed, Scene, scene_of
from verifier.diagnosis.selection import Selection
from verifier.fidelity.shooting.samples import turned
from verifier.fidelity.shooting.study import Study, study_of
from verifier.fidelity.stretches.needs import Needs, needs_of
from verifier.fidelity.stretches.segments import segments_of
from verifier.traces.trace import Trace

SEED: Final = 7


@final
@dataclass(frozen=True, eq=False, slots=True)
class Reread:
    """A reading with its scene. gain: of log-likelihood over the trace as it was read.

    lead: the same over the trace as it was read with all that explains it. share: of the squared
    error beyond noise that is gone. Where nothing could be judged before, all three are against
    variables that stand still.
    """

    reading: Reading
    needs: Needs
    study: Study
    scene: Scene
    gain: float
    lead: float
    share: float


def reread(
    program: Program,
    fidelity: Fidelity,
    trace: Trace,
    scene: Scene | None,
    selection: Selection | None,
) -> tuple[Reread, ...]:
    """The readings that could be judged, the one that leads most first.

    scene, selection: of the trace as it was read.
    """
    found = []
    for reading in readings_of(program, needs_of(program, trace), trace):
        needs = needs_of(program, reading.trace)
        study = _study(program, fidelity, needs)
        if study is None:
            continue
        other = scene_of(program, study)
        if other.windows:
            plain, final = (None, None) if selection is None else (selection.plain, selection.final)
            fitted = plain_fit(other)
            gain, share = _gain(other, fitted, scene, plain)
            lead = _gain(other, fitted, scene, final)[0]
            found.append(Reread(reading, needs, study, other, gain, lead, share))
    return tuple(sorted(found, key=lambda each: -each.lead))


def _study(program: Program, fidelity: Fidelity, needs: Needs) -> Study | None:
    segments = segments_of(program, needs, fidelity.horizon)
    if len(segments.spans) == 0:
        return None
    study = study_of(flow_of(program), fidelity, needs, segments, np.random.default_rng(SEED))
    return None if isinstance(study, str) else study


def _gain(
    other: Scene, fitted: Fit, scene: Scene | None, before: Fit | None
) -> tuple[float, float]:
    """Log-likelihood gained, and the share explained, by `fitted` over `before`.

    Per sample, as if both had as many, and as independent ones as the better of the two leaves:
    the residuals of a wrong one hang together, which would make light of how wrong it is.
    """
    counts = np.array([int(np.sum(each.used)) for each in other.observed])
    left = fitted.sigma / _still(other)
    was, thinning = np.ones_like(left), correlation_time(other, fitted.left.residual)
    if scene is not None and before is not None:
        order = [[each.name for each in scene.observed].index(o.name) for o in other.observed]
        was = (before.sigma / _still(scene))[order]
        if np.sum(counts * np.log(was / left)) < 0.0:
            thinning = correlation_time(scene, before.left.residual)[order]
    gain = float(np.sum(counts / thinning * np.log(was / left)))
    floor = np.array([each.floor for each in other.observed]) / _still(other)
    beyond = float(np.sum(np.maximum(was**2 - floor**2, 0.0) / left**2))
    share = float(np.sum((was**2 - left**2) / left**2)) / max(beyond, 1e-300)
    return gain, min(share, 1.0)


def _still(scene: Scene) -> Array:
    """What (D,) would be left if each variable stood still in every window."""
    return np.array([max(_spread(each), each.floor, 1e-12) for each in scene.observed])


def _spread(each: Observed) -> float:
    """The deviation from the mean of each window; of an angle, at most that of pure chance."""
    first = each.values[:, :1]
    moved = np.where(each.used, turned(each.values - first, each.turn), 0.0)
    count = np.maximum(np.sum(each.used, axis=1, keepdims=True), 1)
    mean = np.sum(moved, axis=1, keepdims=True) / count
    apart = np.where(each.used, turned(moved - mean, each.turn), 0.0)
    return float(np.sqrt(np.sum(apart**2) / max(int(np.sum(each.used)), 1)))
