"""Pass 7: table errors, carried to the fidelity horizon, must not decide a verdict.

The same starts run through the tables and through the field's own formula; where they end must
differ by less than a tenth of the fidelity tolerance (design, section 4, item 4).
"""

from dataclasses import replace
from typing import Final

import numpy as np

from compiler.sampling import random_points
from runtime.arrays import Array, frozen
from runtime.flow import Source, flow_of
from runtime.integrators import adaptive, fixed_steps
from runtime.program import Program

STARTS: Final = 128
SEED: Final = 7
SHARE: Final = 0.1
ACCURACY: Final = 1e-8  # of the integration, relative; far below any tenth of a tolerance


def excess(program: Program) -> dict[str, float]:
    """How many times each judged state departs from a tenth of its tolerance at the horizon.

    Empty where there is nothing to compare: no fidelity, no formula, or no tables. A mode stays
    what it was at the start, as it is measured where a verdict is made.
    """
    field, fidelity = program.field, program.fidelity
    if fidelity is None or field.formula is None or not field.terms:
        return {}
    program = replace(program, field=replace(field, guards=()))
    x, u = random_points(program, fidelity.region, STARTS, SEED)
    ends = [_ends(program, source, x, u, fidelity.horizon) for source in Source]
    apart = np.abs(ends[0] - ends[1])
    found = {}
    for i, state in enumerate(program.states):
        if state.name in fidelity.tolerance:
            largest = np.nanmax(apart[:, i], initial=0.0)
            found[state.name] = float(largest / (SHARE * fidelity.tolerance[state.name]))
    return found


def _ends(program: Program, source: Source, x: Array, u: Array, horizon: float) -> Array:
    """Where the starts come on the way to the horizon: (k * STARTS, n), NaN once outside."""
    flow, n = flow_of(program, source), len(program.states)
    if program.field.is_map:
        steps = max(1, round(horizon / program.field.every))
        times = frozen(program.field.every * np.arange(steps + 1))
        columns = np.arange(n, n + u.shape[1])
        return fixed_steps(flow, x, times, u[:, None, :], columns).states[:, 1:].reshape(-1, n)
    times = frozen([0.0, horizon / 2, horizon])
    return adaptive(flow, x, u, times, ACCURACY, ACCURACY).states[:, 1:].reshape(-1, n)
