"""Runs of flags that are true."""

import numpy as np

from runtime.arrays import Booleans


def runs_of(flags: Booleans) -> list[tuple[int, int]]:
    """The first place and one past the last of each run of true flags (N,).

    >>> runs_of(np.array([True, True, False, True]))
    [(0, 2), (3, 4)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return [(int(first), int(end)) for first, end in edges.reshape(-1, 2)]
