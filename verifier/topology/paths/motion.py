"""Many points of a slice, moved along its flow: the means of everything that follows paths.

m: number of axes; L: lanes; T: times.
"""

from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.integrators import adaptive
from verifier.topology.paths.seeds import spread
from verifier.topology.slices import Slice, rates_at, shortest, states_at

MOST_STEPS: Final = 10_000
"""A path that needs more steps chatters along a jump of the field."""

LASTING: Final = tuple(2.0**k for k in range(22))
"""Durations, in paces, for which paths are followed on and on until they show what they do.

Polynomials of high order are a million times faster at the domain's corners than amid it.
"""

STUCK: Final = 1e-7
"""A path that moved less than this share of the widths in such a duration has come to rest;"""

PATIENT: Final = 1024.0
"""if it is shorter than so many paces, less by that share: it may be slow where it begins."""

PROBES: Final = 256
"""Places at which the speed of a field is looked at."""


def moved(view: Slice, starts: Array, times: Array, tolerance: float) -> Array:
    """Points (L, T, m) from `starts` (L, m) at `times` (T,), NaN after they left the domain.

    tolerance: the local error of each step, as a share of the widths. Times begin at 0 and may
    run backwards. Paths are continuous on periodic axes: values may leave the domain there by
    whole periods.
    """
    x = states_at(view, starts)
    if not len(x):
        return np.empty((0, times.size, len(view.axes)))
    widths = np.ones(x.shape[-1])
    widths[list(view.columns)] = view.width
    found = adaptive(view.flow, x, view.u, times, tolerance, tolerance * widths, MOST_STEPS)
    points = found.states[..., view.columns]
    gone = np.cumsum(shortest(view, np.diff(points, axis=1)), axis=1)
    return np.asarray(np.concatenate([starts[:, None], starts[:, None] + gone], axis=1))


def travelled(view: Slice, paths: Array, lasted: float) -> Array:
    """The lengths (L,) of paths (L, T, m), in widths; 0 at rest, infinite if the domain is left.

    lasted: their duration, in paces.
    """
    steps = np.linalg.norm(np.diff(paths, axis=1) / view.width, axis=-1)
    length = steps.sum(axis=1)
    far = np.abs(paths - paths[:, :1]) / view.width
    rests = np.max(far, axis=(1, 2), initial=0.0) < STUCK * min(1.0, lasted / PATIENT)
    return np.asarray(np.where(np.isfinite(length), np.where(rests, 0.0, length), np.inf))


def pace(view: Slice) -> float:
    """The time in which a typical point of the slice crosses it, s; infinite if nothing moves."""
    with np.errstate(over="ignore"):
        speed = np.linalg.norm(rates_at(view, spread(view, PROBES)) / view.width, axis=-1)
    moving = speed[np.isfinite(speed) & (speed > 0.0)]
    return float(1.0 / np.median(moving)) if moving.size else np.inf
