"""The times of switches as the states tell them, for windows that go on through switches."""

from dataclasses import replace

import numpy as np

from runtime.arrays import Array, Booleans
from runtime.program import Program
from verifier.fidelity.stretches.changes import told
from verifier.fidelity.stretches.needs import Input, Needs
from verifier.fidelity.switching.jumps import Jumps
from verifier.fidelity.switching.setting import Setting

CLEAR = 0.5
"""The doubt about a switch carries no state further than this share of its tolerance."""


def needs_told(program: Program, needs: Needs, setting: Setting, jumps: Jumps) -> Needs:
    """The needs, with switches when the states tell that they were.

    Where the doubt about the time is too small to matter, none is left.
    """
    changes = setting.changes
    times = changes.times + jumps.shift
    carried = np.abs(jumps.slope) * np.sqrt(jumps.shift_variance)[:, None]
    is_sure = jumps.is_good & np.all(carried <= CLEAR * setting.tolerance, axis=1)
    own = changes.left == changes.entered
    inputs = tuple(
        _told(each, program.field.mode, times[~own], is_sure[~own]) for each in needs.inputs
    )
    doubt = np.where(is_sure[own], 0.0, needs.leaps.doubt)
    leaps = replace(needs.leaps, times=times[own], doubt=doubt)
    return replace(needs, inputs=inputs, leaps=leaps)


def _told(given: Input, mode: str, times: Array, is_sure: Booleans) -> Input:
    if given.name != mode or given.series is None or len(times) == 0:
        return given
    return replace(given, series=told(given.series, times, is_sure))
