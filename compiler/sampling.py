"""Random points over the states and controls of a program; discrete states only at their values."""

from collections.abc import Mapping

import numpy as np

from runtime.arrays import Array
from runtime.program import Kind, Program


def random_points(
    program: Program, within: Mapping[str, tuple[float, float]], count: int, seed: int
) -> tuple[Array, Array]:
    """States (count, n) and controls (count, p), in SI; `within` narrows the domains it names."""
    rng = np.random.default_rng(seed)
    domains = {state.name: (state.low, state.high) for state in program.states}
    domains.update({control.name: (control.low, control.high) for control in program.controls})
    low, high = zip(*(within.get(name, domain) for name, domain in domains.items()), strict=True)
    points = rng.uniform(low, high, (count, len(domains)))
    for i, state in enumerate(program.states):
        if state.kind is Kind.DISCRETE:
            points[:, i] = np.floor(rng.uniform(0.0, len(state.values), count))
    return points[:, : len(program.states)], points[:, len(program.states) :]
