"""Which way of reading the trace fits the spec best."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from runtime.flow import flow_of
from runtime.program import Fidelity, Program
from verifier.diagnosis.candidates.readings import Reading, readings_of
from verifier.diagnosis.fitting import Fit, correlation_time, plain_fit
from verifier.diagnosis.scene import Scene, scene_of
from verifier.fidelity.shooting.study import Study, study_of
from verifier.fidelity.stretches.needs import Needs, needs_of
from verifier.fidelity.stretches.segments import segments_of
from verifier.traces.trace import Trace

SEED: Final = 7


@final
@dataclass(frozen=True, eq=False, slots=True)
class Reread:
    """A reading with its scene. gain: of log-likelihood over the trace as it was read.

    share: of the squared error beyond noise that is gone; 1 where nothing could be judged before.
    """

    reading: Reading
    needs: Needs
    study: Study
    scene: Scene
    gain: float
    share: float


def reread(
    program: Program, fidelity: Fidelity, trace: Trace, scene: Scene | None, plain: Fit | None
) -> tuple[Reread, ...]:
    """The readings that fit better than the trace as it was read, best first."""
    found = []
    for reading in readings_of(program, needs_of(program, trace), trace):
        needs = needs_of(program, reading.trace)
        study = _study(program, fidelity, needs)
        if study is None:
            continue
        other = scene_of(program, study)
        if other.windows:
            gain, share = _gain(reading, other, fidelity, scene, plain)
            found.append(Reread(reading, needs, study, other, gain, share))
    return tuple(sorted(found, key=lambda each: -each.gain))


def _study(program: Program, fidelity: Fidelity, needs: Needs) -> Study | None:
    segments = segments_of(program, needs, fidelity.horizon)
    if len(segments.spans) == 0:
        return None
    study = study_of(flow_of(program), fidelity, needs, segments, np.random.default_rng(SEED))
    return None if isinstance(study, str) else study


def _gain(
    reading: Reading, other: Scene, fidelity: Fidelity, scene: Scene | None, plain: Fit | None
) -> tuple[float, float]:
    """Per sample, as if both had as many; likelihoods in the units of the log."""
    fitted = plain_fit(other)
    counts = np.array([int(np.sum(each.used)) for each in other.observed])
    thinning = correlation_time(other, fitted.left.residual)
    factors = np.array([abs(reading.factors.get(each.name, 1.0)) for each in other.observed])
    after = fitted.sigma / factors
    before = _width(other, fidelity) / factors if plain is None else plain.sigma
    if scene is not None and not reading.factors:
        before = before[[_place(scene, each.name) for each in other.observed]]
    gain = float(np.sum(counts / thinning * np.log(before / after)))
    floor = np.array([each.floor for each in other.observed]) / factors
    beyond = np.maximum((before**2 - floor**2) / after**2, 1e-300)
    share = float(np.sum((before**2 - after**2) / after**2) / np.sum(beyond))
    return gain, min(share, 1.0)


def _width(scene: Scene, fidelity: Fidelity) -> Array:
    """What a fit must beat where nothing could be judged: the tolerances."""
    return np.array(
        [fidelity.tolerance.get(each.name, 0.1 * each.width) for each in scene.observed]
    )


def _place(scene: Scene, name: str) -> int:
    return [each.name for each in scene.observed].index(name)
