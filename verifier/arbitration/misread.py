"""What an arbiter reads, logged in another unit than it is read in."""

from typing import Final

import numpy as np

from runtime.arbiter import Arbiter
from runtime.program import Kind
from verifier.arbitration.reader import CHOICE, reader_of
from verifier.fidelity.judging.misread import leaps
from verifier.fidelity.judging.outside import Outside, told_outside
from verifier.traces.trace import Trace

MOSTLY: Final = 0.9
"""This share of a reading lies outside its domain, of one in another unit."""


def misread_in(arbiter: Arbiter, trace: Trace) -> Outside | None:
    """The first reading that lies far outside its domain, and would lie inside in another unit."""
    reader = reader_of(arbiter)
    bindings = {binding.name: binding for binding in reader.bindings}
    for part in reader.states:
        series = trace.series.get(part.name)
        if series is None or part.name == CHOICE or part.kind is Kind.DISCRETE:
            continue
        values = series.values if series.logged is None else series.logged
        share = float(np.mean((values < part.low) | (values > part.high)))
        is_strange = share >= MOSTLY
        if part.kind is Kind.PERIODIC:
            is_strange = leaps(series, part.high - part.low)
        if is_strange:
            told = told_outside(part, series, values, share, bindings.get(part.name))
            if told.is_slip and told.is_far:
                return told
    return None
