"""How much of the errors is no chance: what other windows foretell of them.

An error that comes back wherever the robot is in the same situation belongs to the spec or to the
robot; unrest does not come back. So the error of each cluster of windows is foretold from all
*other* clusters (but not from the two beside it, whose windows overlap its own) by a smooth
function of the situation (kernel ridge regression, cross-fitted), and compared with what it was.
For a forecast f of errors e with mean m(situation):

    E[e f] / rms(f) = E[m f] / rms(f) <= rms(m)          (Cauchy and Schwarz)

whatever f is: a poor forecast shows too little, never too much. The left side is a mean, and gets
Student's t over clusters, from what the forecast missed: the situations are given, only the errors
in them are chance. Two forecasts are made, which share the chance of error: by a constant and
slopes alone, which little data suffice for, and with bumps beside them.

Letters: W windows, d quantities that make up the situation.
"""

from typing import Final

import numpy as np
from scipy import special

from runtime.arrays import Array, Integers
from verifier.fidelity.judging.neighbours import one_run

MOST: Final = 600
"""So many windows are enough; of more, every second, third ... one is taken."""
REACHES: Final = (2.0, 0.7)
"""How far wide and narrow bumps reach, in standard deviations of the situation times the root of
its dimension."""
RIDGE: Final = 1.0
"""The variance of the noise, as a share of what a constant, a slope or a bump has. Fixed, as the
reaches are: what is chosen to foretell best foretells chance, too."""
FEWEST: Final = 4
"""With fewer clusters nothing is foretold."""


def shown_structure(
    errors: Array,
    situation: Array,
    clusters: Integers,
    chance: float,
    runs: Integers | None = None,
) -> float:
    """The root mean square of the errors (W,) that is shown to be no chance, 0 if none.

    situation: (W, d). clusters: (W,) which windows depend on one another. `chance`: of the figure
    being above the truth. runs: the recording (W,) of each window, where they are of several.
    """
    runs = one_run(len(errors)) if runs is None else runs
    taken = _thinned(runs)
    errors, situation = errors[taken], situation[taken]
    clusters, runs = clusters[taken], runs[taken]
    _, first, place = np.unique(clusters, return_index=True, return_inverse=True)
    count = int(place.max(initial=-1)) + 1
    if count < FEWEST or not np.any(errors):
        return 0.0
    scaled = _scaled(situation)
    plain = 1.0 + scaled @ scaled.T
    kernels = (plain, plain + _bumps(scaled))
    groups = (place, runs[first])
    return max(_shown(errors, kernel, groups, chance / len(kernels)) for kernel in kernels)


def _thinned(runs: Integers) -> Integers:
    """Which windows are taken: every one, or every second ... of each recording."""
    stride = -(-len(runs) // MOST)
    starts = np.searchsorted(runs, runs)
    return np.flatnonzero((np.arange(len(runs)) - starts) % max(stride, 1) == 0)


def _shown(errors: Array, kernel: Array, groups: tuple[Integers, Integers], chance: float) -> float:
    """What the forecast by one kernel (W, W) shows; `groups`: see `_foretold`."""
    place, _ = groups
    forecast = _foretold(errors, kernel, groups)
    size = float(np.sqrt(np.mean(forecast**2)))
    if size == 0.0:
        return 0.0
    count = int(place.max()) + 1
    mean = float(np.mean(errors * forecast)) / size
    sums = np.bincount(place, weights=(errors - forecast) * forecast / size)
    error = float(np.sqrt(np.sum(sums**2) * count / (count - 1.0)) / len(errors))
    return max(0.0, mean - float(special.stdtrit(count - 1, 1.0 - chance)) * error)


def _bumps(situation: Array) -> Array:
    """How alike situations are (W, W): one for each reach where they are the same."""
    distance = np.sum((situation[:, None, :] - situation[None, :, :]) ** 2, axis=-1)
    widths = [reach**2 * max(situation.shape[1], 1) for reach in REACHES]
    return np.asarray(sum(np.exp(-0.5 * distance / width) for width in widths))


def _scaled(situation: Array) -> Array:
    """Quantities (W, d) of variance 1; those that never change are left out."""
    spread = np.std(situation, axis=0)
    moving = spread > 1e-9 * np.max(np.abs(situation), axis=0, initial=1e-300)
    return np.asarray((situation - np.mean(situation, axis=0))[:, moving] / spread[moving])


def _foretold(errors: Array, kernel: Array, groups: tuple[Integers, Integers]) -> Array:
    """The forecast (W,) of each cluster from the others; its neighbours in time are left out, too.

    groups: the cluster (W,) of each window, and the recording (G,) of each cluster.
    A Gaussian's mean given all but A is e_A - P_AA^-1 (P e)_A, P the inverse of the covariance
    (Rasmussen and Williams 2006, section 5.4.2).
    """
    place, runs = groups
    precision = np.linalg.inv(kernel + RIDGE * np.eye(len(errors)))
    pulled = precision @ errors
    forecast = np.empty(len(errors))
    for cluster in range(int(place.max()) + 1):
        beside = (np.abs(place - cluster) <= 1) & (runs[place] == runs[cluster])
        near = np.flatnonzero(beside)
        own = place[near] == cluster
        step = np.linalg.solve(precision[np.ix_(near, near)], pulled[near])
        forecast[near[own]] = (errors[near] - step)[own]
    return forecast
