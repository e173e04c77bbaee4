"""Whether the runs excite each control and each sensed quantity so that its effect can be told."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.program import Fidelity, Kind, Program
from verifier.fidelity.stretches.needs import names_read
from verifier.procedure.driving import Plans, driven_paths
from verifier.report.wording import number

PLACES: Final = 3
"""Ends and middle: of what acts alike at both ends, the middle shows it."""
SEED: Final = 11
"""Of the program's own noise, which is the same at both ends."""


def effects_of(
    program: Program,
    fidelity: Fidelity,
    plans: Plans,
    every: float,
    held: Collection[str] = (),
) -> dict[str, Array]:
    """By input that the field reads, (C,) by how many tolerances it moves what is judged.

    held: controls that are not to be varied.

    From each start the behavior is predicted over one horizon with the input at one end of what
    the plans hold it at, and at the other, all else as planned.
    """
    read = names_read(program)
    names = program.register
    places = [int(i) for i in np.flatnonzero(plans.inputs) if names[i] in read - set(held)]
    return {names[place]: _effect(program, fidelity, plans, every, place) for place in places}


def _effect(program: Program, fidelity: Fidelity, plans: Plans, every: float, place: int) -> Array:
    values = plans.held[:, :, place]
    samples = max(round(fidelity.horizon / every), 1)
    ends = []
    for end in _places(program, place, values):
        held = plans.held[:, :1].copy()
        held[:, :, place] = end
        start = plans.start.copy()
        if place < start.shape[1]:
            start[:, place] = end
        short = replace(plans, start=start, held=held, seconds=samples * every)
        ends.append(driven_paths(program, short, every, SEED).register[:, -1])
    apart = np.nan_to_num(np.max(ends, axis=0) - np.min(ends, axis=0), nan=0.0)
    found = [apart[:, program.register.index(n)] / t for n, t in fidelity.tolerance.items()]
    return np.asarray(np.max(found, axis=0))


def _places(program: Program, place: int, values: Array) -> Array:
    """The values that an input is held at for its effect; of a discrete one those it can have."""
    state = program.states[place] if place < len(program.states) else None
    if state is not None and state.kind is Kind.DISCRETE:
        return np.unique(values)
    return np.linspace(values.min(), values.max(), PLACES)


def untold(effects: Mapping[str, Array]) -> tuple[str, ...]:
    """The inputs that no recording within the tolerance tells."""
    return tuple(
        f"no recording tells whether {name} does as the spec says: over its whole range it moves"
        f" what is judged by {number(float(effect.max(initial=0.0)))} tolerances at most"
        for name, effect in effects.items()
        if effect.max(initial=0.0) < 1.0
    )
