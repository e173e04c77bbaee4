"""The spec's field, refitted to a trace by multiple shooting.

The rate of each axis i becomes f_i (1 + a_i) + g_i(x): a gain and a smooth correction (see
`basis`), fitted on windows of one horizon whose start states are free (Gauss-Newton).
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.study import Study
from verifier.robot_topology.corrected import Corrected
from verifier.robot_topology.equations import equations, job_of
from verifier.robot_topology.shrinkage import solved

MOST_WINDOWS: Final = 300
MOST_STEPS: Final = 12_000
"""Windows times steps: bounds time and memory."""
FEWEST_WINDOWS: Final = 8
ROUNDS: Final = 3


@final
@dataclass(frozen=True, eq=False, slots=True)
class Refit:
    """The refitted field. coefficients (P,); root (P, P): of their covariance.

    paths (W, S + 1, D): of the windows that it was fitted on.
    """

    field: Corrected
    coefficients: Array
    root: Array
    paths: Array

    def draws(self, count: int, rng: np.random.Generator) -> Array:
        """Coefficients (count + 1, P): the estimate first, then draws of what they may be."""
        noise = rng.standard_normal((count, len(self.coefficients)))
        return np.concatenate([self.coefficients[None], self.coefficients + noise @ self.root.T])


def refitted(study: Study, allowed: Array) -> Refit | None:
    """The refitted field; None for maps and modes, and where there are too few windows.

    allowed (D,): departures of the axes that would pass.
    """
    plan = study.plan
    if plan.model.flow.is_map or plan.model.flow.switches:
        return None
    chosen = _chosen(plan)
    if len(chosen) < FEWEST_WINDOWS:
        return None
    job = job_of(study, chosen)
    columns = job.field.columns
    start = np.array(study.shots.start[chosen])
    found, root = np.zeros(job.field.count), np.eye(job.field.count)
    for _ in range(ROUNDS):
        rows = equations(job, start, found)
        good = rows.is_finite
        if good.sum() < FEWEST_WINDOWS:
            return None
        job, rows, start = job.part(good), rows.part(good), start[good]
        value, root = solved(rows, found, allowed / plan.windows.horizon)
        start[:, columns] += rows.move - rows.response @ (value - found)
        found = value
    return Refit(job.field, found, root, rows.paths)


def _chosen(plan: Plan) -> Integers:
    """Windows that do not overlap, evenly thinned to a bounded number; all if there are few."""
    times, horizon = plan.windows.times, plan.windows.horizon
    kept: list[int] = []
    last = -np.inf
    for i, time in enumerate(times):
        if time >= last + horizon * (1.0 - 1e-6):
            kept.append(i)
            last = float(time)
    if len(kept) < FEWEST_WINDOWS:
        kept = list(range(len(times)))
    steps = int(np.max(plan.windows.last - plan.windows.first, initial=1))
    most = max(FEWEST_WINDOWS, min(MOST_WINDOWS, MOST_STEPS // steps))
    return np.array(kept[:: -(-len(kept) // most)], dtype=np.int64)
