"""Spans of time: (k, 2) arrays of closed intervals [start, end], ascending and disjoint."""

import numpy as np

from runtime.arrays import Array, Booleans


def spans_of(pairs: list[tuple[float, float]]) -> Array:
    """The pairs as spans; the empty list gives none."""
    return np.array(pairs, dtype=float).reshape(-1, 2)


def length(spans: Array) -> float:
    """Seconds in all spans."""
    return float(np.sum(spans[:, 1] - spans[:, 0]))


def contains(spans: Array, times: Array) -> Booleans:
    """Whether each time (...) lies in a span."""
    if len(spans) == 0:
        return np.zeros(times.shape, dtype=bool)
    at = np.clip(np.searchsorted(spans[:, 0], times, side="right") - 1, 0, None)
    return np.asarray((times >= spans[at, 0]) & (times <= spans[at, 1]))


def intersect(first: Array, second: Array) -> Array:
    """What lies in both."""
    found: list[tuple[float, float]] = []
    for start, end in first:
        reach = second[(second[:, 1] >= start) & (second[:, 0] <= end)]
        found.extend((max(start, a), min(end, b)) for a, b in reach)
    return spans_of([(a, b) for a, b in found if b > a])


def without(spans: Array, holes: Array) -> Array:
    """What is left of `spans` when the open intervals `holes` (k, 2) are taken out.

    Holes may overlap and come in any order.
    """
    if len(spans) == 0 or len(holes) == 0:
        return spans
    merged = merge(holes)
    edges = np.concatenate([[-np.inf], merged.ravel(), [np.inf]]).reshape(-1, 2)
    return intersect(spans, edges)


def merge(spans: Array) -> Array:
    """Overlapping or touching spans made one, ascending."""
    if len(spans) == 0:
        return spans
    ordered = spans[np.argsort(spans[:, 0], kind="stable")]
    reach = np.maximum.accumulate(ordered[:, 1])
    new = np.concatenate([[True], ordered[1:, 0] > reach[:-1]])
    starts = ordered[new, 0]
    ends = reach[np.concatenate([np.flatnonzero(new)[1:] - 1, [len(reach) - 1]])]
    return np.column_stack([starts, ends])
