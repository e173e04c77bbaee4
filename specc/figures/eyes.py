"""What a robot's sensors say, as it is drawn: arcs of what is free, lines to what is seen.

A range says the least over its rays and no more: so it is an arc, and somewhere on it is something.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple, final

import numpy as np

from runtime.arrays import Array
from specc.figures.footprints import placed
from specc.figures.scene import Eye, EyeKind, Said

FINE: Final = 0.1
"""Radians between two corners of an arc."""


@final
class Glimpse(NamedTuple):
    """What an eye says now: whether something is seen, how far, and where."""

    seen: bool
    distance: float
    bearing: float


def glimpses(said: Sequence[Said], time: float) -> tuple[Glimpse | None, ...]:
    """What each eye of a robot says at a time."""
    found: list[Glimpse | None] = []
    for each in said:
        row = each.at(time)
        if row < 0:
            found.append(None)
            continue
        found.append(
            Glimpse(bool(each.seen[row]), float(each.distance[row]), float(each.bearing[row]))
        )
    return tuple(found)


def arcs(
    eyes: Sequence[Eye], seen: Sequence[Glimpse | None], pose: Array
) -> list[tuple[Array, bool]]:
    """Lines (k, 2) in the world of what eyes of a robot at `pose` say; whether they see anything.

    Of a range the edges of its fan and the arc, of a sight a line to what is seen.
    """
    found: list[tuple[Array, bool]] = []
    for eye, glimpse in zip(eyes, seen, strict=True):
        if glimpse is None or eye.kind is EyeKind.BUMP:
            continue
        if eye.kind is EyeKind.SIGHT:
            if glimpse.seen:
                found.append((_fan(eye, glimpse.distance, (glimpse.bearing,), pose), True))
            continue
        half = 0.5 * eye.width
        turns = np.linspace(-half, half, max(int(eye.width / FINE), 1) + 1)
        arc = _fan(eye, glimpse.distance, turns.tolist(), pose)
        origin = arc[:1]
        if glimpse.seen:
            found.append((arc[1:], True))
        found.append((np.vstack([origin, arc[1:], origin]), False))
    return found


def hits(
    eyes: Sequence[Eye], seen: Sequence[Glimpse | None], pose: Array, radius: float
) -> list[Array]:
    """Arcs around a robot where its bumpers are hit."""
    found = []
    for eye, glimpse in zip(eyes, seen, strict=True):
        if eye.kind is EyeKind.BUMP and glimpse is not None and glimpse.seen:
            half = 0.5 * eye.width
            turns = eye.heading + np.linspace(-half, half, max(int(eye.width / FINE), 2) + 1)
            around = 1.12 * radius * np.column_stack([np.cos(turns), np.sin(turns)])
            found.append(placed(around, pose))
    return found


def _fan(eye: Eye, distance: float, bearings: Sequence[float], pose: Array) -> Array:
    """The eye, and the points at a distance in these directions from it, in the world."""
    turns = np.array(bearings)
    ends = distance * np.column_stack([np.cos(turns), np.sin(turns)])
    own = placed(np.vstack([np.zeros((1, 2)), ends]), np.array([eye.x, eye.y, eye.heading]))
    return placed(own, pose)
