"""How finely to integrate: so that the error of Runge-Kutta is negligible beside the tolerance."""

import numpy as np

from runtime.arrays import Array
from runtime.program import Fidelity
from verifier.fidelity.shooting.grid import Grid, flow_grid
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.prediction import Model, predict
from verifier.fidelity.shooting.samples import Samples, measured_states, nearest

STEPS = 20
"""At least so many integration steps to the horizon."""
HALVINGS = 8
ACCURACY = 0.01
"""The integration error at the horizon is at most this share of the tolerance."""
PROBES = 16


def accurate_grid(plan: Plan, fidelity: Fidelity) -> tuple[Grid, float]:
    """A grid whose halved steps move no prediction by more than a share of the tolerance.

    Returns that grid and the share, larger than `ACCURACY` where even the finest grid moves them.
    """
    grid, step = plan.model.grid, plan.windows.horizon / STEPS
    ends, share = _ends(plan, grid), np.inf
    for _ in range(HALVINGS):
        finer = flow_grid(plan.needs, step / 2.0)
        following = _ends(plan, finer)
        share = _share(following - ends, plan.samples, fidelity)
        if share <= ACCURACY:
            break
        grid, ends, step = finer, following, step / 2.0
    return grid, share


def _ends(plan: Plan, grid: Grid) -> Array:
    """The states at the ends of a few windows, predicted from raw starts."""
    windows = plan.windows
    few = np.unique(np.linspace(0, len(windows.times) - 1, PROBES).astype(np.int64))
    base = plan.samples[plan.needs.base].times
    until = base[nearest(base, windows.times[few] + windows.horizon)]
    model = Model(plan.model.flow, grid)
    first = np.searchsorted(grid.times, windows.times[few])
    last = np.searchsorted(grid.times, until)
    paths = predict(model, measured_states(model, plan.samples, first), first, last)
    return np.asarray(paths[np.arange(len(few)), last - first])


def _share(difference: Array, samples: tuple[Samples, ...], fidelity: Fidelity) -> float:
    shares = [
        np.nanmax(np.abs(difference[:, each.column]), initial=0.0)
        / fidelity.tolerance[each.state.name]
        for each in samples
        if each.state.name in fidelity.tolerance
    ]
    return float(max(shares, default=0.0))
