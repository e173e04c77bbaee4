"""When a behavior has its way: it acts, and nobody else moves what it moves.

Else what the robot does is not its doing: it is inhibited, suppressed by one that stands above it
on a channel, or blended with others (thesis, section 3.2.2).
"""

from typing import Final

import numpy as np

from runtime.architecture import Architecture, Channel, Way
from runtime.arrays import Array, Booleans

NEARLY_ALL: Final = 0.99
"""Who has so much of the weight in a blend has its way: the others move next to nothing."""


def has_its_way(architecture: Architecture, acts: Booleans, weights: Array) -> Booleans:
    """Of who acts (..., nodes) those that have their way, on every channel that they reach.

    weights: (..., nodes) how strongly choices in effect name each; they count in a blend. A node
    that reaches no channel has its way where it acts.
    """
    free = acts.copy()
    for channel in architecture.channels:
        for place, node in enumerate(channel.resolution.nodes):
            free[..., node] &= _is_alone(channel, place, acts, weights)
    return free


def _is_alone(channel: Channel, place: int, acts: Booleans, weights: Array) -> Booleans:
    """Where the node at `place` has the channel for itself, if it acts."""
    nodes = channel.resolution.nodes
    rivals = [other for i, other in enumerate(nodes) if i != place]
    match channel.resolution.way:
        case Way.PRIORITY | Way.EXCLUSIVE:
            rivals = list(nodes[:place])
        case Way.BLEND if channel.resolution.arbiter >= 0:
            counted = np.where(acts, weights, 0.0)
            own, others = counted[..., nodes[place]], counted[..., rivals].sum(axis=-1)
            # Where nobody has a weight, all that act count alike.
            told: Booleans = np.where(
                own + others > 0.0,
                own >= NEARLY_ALL * (own + others),
                ~np.any(acts[..., rivals], axis=-1),
            )
            return told
        case _:
            pass
    alone: Booleans = ~np.any(acts[..., rivals], axis=-1)
    return alone
