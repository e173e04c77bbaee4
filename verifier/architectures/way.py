"""When a behavior has its way: it acts, and nobody else moves what it moves.

Else what the robot does is not its doing: it is inhibited, suppressed by one that stands above it
on a channel, or blended with others (thesis, section 3.2.2).
"""

import numpy as np

from runtime.architecture import Architecture, Channel, Way
from runtime.arrays import Booleans

ALONE_ABOVE = frozenset({Way.PRIORITY, Way.EXCLUSIVE})
"""The first of those that act has the channel for itself."""


def has_its_way(architecture: Architecture, acts: Booleans) -> Booleans:
    """Of who acts (..., nodes) those that have their way, on every channel that they reach.

    A node that reaches no channel has its way where it acts.
    """
    free = acts.copy()
    for channel in architecture.channels:
        for place, node in enumerate(channel.resolution.nodes):
            rivals = _rivals(channel, place)
            if rivals:
                free[..., node] &= ~np.any(acts[..., rivals], axis=-1)
    return free


def _rivals(channel: Channel, place: int) -> list[int]:
    """Who must not act on the channel, for the node at `place` to have it for itself."""
    nodes = channel.resolution.nodes
    if channel.resolution.way in ALONE_ABOVE:
        return list(nodes[:place])
    return [other for i, other in enumerate(nodes) if i != place]
