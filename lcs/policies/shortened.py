"""Lists whose bounds have few digits, and that decide as before wherever anything was lived."""

import dataclasses

import numpy as np

from lcs.arrays import Array
from lcs.policies.decision_list import DecisionList, holds
from lcs.rules.digits import snapped


def shortened(rules: DecisionList, x: Array) -> DecisionList:
    """The list with bounds of as few digits as leave each decision at places x (T, n) as it is.

    One bound after the other is moved between the places on its two sides that no earlier rule
    holds and that the rule's other bounds let in. Without such a place beyond it, it is dropped.
    """
    made = dataclasses.replace(rules, lower=rules.lower.copy(), upper=rules.upper.copy())
    left = x
    for r in range(len(made)):
        own = slice(r, r + 1)
        for i in range(x.shape[1]):
            others = np.arange(x.shape[1]) != i
            within = holds(made.lower[own, others], made.upper[own, others], left[:, others])[0]
            values = left[within, i]
            made.lower[r, i] = _lower(made.lower[r, i], values[values < made.upper[r, i]])
            made.upper[r, i] = _upper(made.upper[r, i], values[values >= made.lower[r, i]])
        left = left[~holds(made.lower[own], made.upper[own], left)[0]]
    return made


def _lower(bound: float, values: Array) -> float:
    """A bound that lets in the same of the values, each x with bound <= x."""
    out, let_in = values[values < bound], values[values >= bound]
    if not len(out):
        return -np.inf
    return snapped(float(out.max()), float(let_in.min(initial=bound)), bound)


def _upper(bound: float, values: Array) -> float:
    """A bound that lets in the same of the values, each x with x < bound."""
    let_in, out = values[values < bound], values[values >= bound]
    if not len(out):
        return np.inf
    if not len(let_in):
        return bound
    return snapped(float(let_in.max()), float(out.min()), bound)
