"""Where a variable stands: what its errors at the horizon show.

EXCEEDED: a *systematic* error beyond the tolerance is shown, one that comes back wherever the
robot is in the same situation: as the mean of some part, or as what other windows foretell. The
unrest of a robot that follows its field is not systematic, and can't condemn it.

WITHIN: the mean of every part is shown to be within the tolerance, and so is what single windows
depart by (root mean square, noise of the sensors taken out), beside the scatter that the spec
allows. So an error that no part and no forecast sees does not pass for unrest.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.judging.conditional_mean import conditional_means
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.fidelity.judging.part_means import MOSTLY, PartMeans, blur_of, part_means
from verifier.fidelity.judging.parts import Condition
from verifier.fidelity.judging.structure import shown_structure
from verifier.fidelity.shooting.shooting import Errors
from verifier.report.report import Interval, Standing

ERROR: Final = (1.0 - CONFIDENCE) / 2.0
"""The chance of each wrong verdict. Two tests may condemn a robot: each has half of it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Judged:
    """The standing, and what it rests on; `systematic`: at least so much is shown."""

    standing: Standing
    systematic: float
    parts: PartMeans
    mean: float
    mean_interval: Interval


def judge_errors(
    errors: Errors,
    conditions: tuple[Condition, ...],
    departure: Interval,
    allowed: tuple[float, float],
    runs: Integers,
) -> Judged:
    """Judge the errors of W windows in order of time, none of them NaN.

    conditions: what each window ran under. departure: the interval of their root mean square.
    allowed: the tolerance, and the scatter beside it. runs: the recording (W,) of each window.
    """
    tolerance, scatter = allowed
    if len(errors.mean) == 0:
        nothing = PartMeans((), 0.0, 0.0, 0, np.zeros(0, np.int64))
        return Judged(Standing.UNDECIDED, 0.0, nothing, 0.0, Interval(-np.inf, np.inf))
    parts = part_means(errors, conditions, tolerance, ERROR / 2.0, runs)
    situation, blur = _situation(errors, conditions)
    foretold = shown_structure(errors.mean, situation, parts.clusters, ERROR / 2.0, runs)
    carried = float(np.sqrt(np.mean(errors.carried)))
    systematic = max(parts.shown - carried * blur, foretold - carried * blur, 0.0)
    ones = np.ones((len(errors.mean), 1))
    mean = conditional_means(errors.mean, ones, parts.clusters, np.ones((1, 1)))
    low, high = mean.bounds(ERROR)
    is_within = departure.high <= np.hypot(tolerance, scatter) and all(
        part.standing is Standing.WITHIN for part in parts.means
    )
    standing = Standing.WITHIN if is_within else Standing.UNDECIDED
    standing = Standing.EXCEEDED if systematic > tolerance else standing
    return Judged(
        standing, systematic, parts, float(mean.value[0]), Interval(float(low[0]), float(high[0]))
    )


def _situation(errors: Errors, conditions: tuple[Condition, ...]) -> tuple[Array, float]:
    """What an error may depend on (W, d), and how blurred by noise it is.

    Where the window ran, and how it was to move; what is mostly noise is left out. The noise of
    the start is in the situation and, carried to the horizon, in the error, so that one foretells
    a little of the other: by no more than the carried noise times the `blur` (Cauchy and Schwarz),
    the root of the sum of squares of each quantity's noise over its spread.
    """
    blur = blur_of(errors)
    quantities = [(errors.moved, blur), (errors.hurried, blur)]
    for each in conditions:
        if each.turn > 0.0:
            angle, noise = 2.0 * np.pi * each.values / each.turn, 2.0 * np.pi / each.turn
            quantities += [(f(angle), noise * each.noise) for f in (np.cos, np.sin)]
        else:
            quantities.append((each.values, each.noise))
    shares = [noise / max(float(np.std(values)), 1e-300) for values, noise in quantities]
    clear = [k for k, share in enumerate(shares) if share < MOSTLY]
    kept = [quantities[k][0] for k in clear]
    total = float(np.sqrt(sum(shares[k] ** 2 for k in clear)))
    return (np.stack(kept, axis=-1) if kept else np.zeros((len(errors.mean), 0))), total
