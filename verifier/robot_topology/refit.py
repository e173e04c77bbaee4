"""The spec's field, refitted to a trace by multiple shooting.

The rate of each axis i becomes f_i (1 + a_i) + g_i(x): a gain and a smooth correction (see
`basis`), fitted on windows of one horizon whose start states are free (Gauss-Newton). How smooth
the correction is, the length of its kernel, is told by the marginal likelihood as well.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from verifier.fidelity.shooting.plan import Plan
from verifier.fidelity.shooting.study import Study
from verifier.robot_topology.corrected import Corrected
from verifier.robot_topology.equations import Job, equations, job_of
from verifier.robot_topology.shrinkage import effect_of, evidence_of, solved

MOST_WINDOWS: Final = 160
MOST_STEPS: Final = 12_000
"""Windows times steps: bounds time and memory."""
FEWEST_WINDOWS: Final = 8
ROUNDS: Final = 3
LENGTHS: Final = (0.9, 0.45, 0.25)
"""Of the kernel, as shares of what was visited."""


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
    start = np.array(study.shots.start[chosen])
    least = allowed / plan.windows.horizon
    job = _likeliest(study, chosen, start, least)
    if job is None:
        return None
    columns = job.field.columns
    found, root = np.zeros(job.field.count), np.eye(job.field.count)
    for _ in range(ROUNDS):
        rows = equations(job, start, found)
        good = rows.is_finite
        if good.sum() < FEWEST_WINDOWS:
            return None
        job, rows, start = job.part(good), rows.part(good), start[good]
        value, root = solved(rows, found, least)
        start[:, columns] += rows.move - rows.response @ (value - found)
        found = value
    return Refit(job.field, found, root, rows.paths)


def _likeliest(study: Study, chosen: Integers, start: Array, least: Array) -> Job | None:
    """The job with the length of the kernel that explains the trace best."""
    tried = []
    for length in LENGTHS:
        job = job_of(study, chosen, length)
        if job is None:
            continue
        rows = equations(job, start, np.zeros(job.field.count))
        rows = rows.part(rows.is_finite)
        if len(rows.paths) < FEWEST_WINDOWS:
            return None
        tried.append((job, rows))
    if not tried:
        return None
    effect = min(effect_of(rows, np.zeros(job.field.count), least) for job, rows in tried)
    return max(
        tried, key=lambda each: evidence_of(each[1], np.zeros(each[0].field.count), least, effect)
    )[0]


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
