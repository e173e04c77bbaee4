"""The places where the robot rests, each with the attractor of the spec that it stands for."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from runtime.arrays import Array
from verifier.report.features import Estimate
from verifier.robot_topology.rests import (
    Rest,
    allowance,
    resting_place,
    rests_of,
    settling_time,
)
from verifier.robot_topology.scene import Scene, shortest
from verifier.topology.claims.members import STABLE_POINTS

APART: Final = 0.03
"""Of the domain: rests further apart are at different places."""
TOLERANCES: Final = 4.0
"""And further apart than so many tolerances."""
FAR: Final = 0.15
"""Of the domain: a rest further from an attractor does not stand for it."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class RestingPlace:
    """at: an estimate an axis. attractor: an index of the portrait's fixed points, -1 for none.

    is_long: the error of `at` is known well.
    """

    at: tuple[Estimate, ...]
    visits: int
    attractor: int
    is_long: bool

    @property
    def place(self) -> Array:
        """The coordinates, (m,)."""
        return np.array([each.value for each in self.at])


def resting_places(scene: Scene, confidence: float) -> tuple[RestingPlace, ...]:
    """Every place where the robot comes to rest; each attractor has at most one of them."""
    attractors = {
        i: point
        for i, point in enumerate(scene.portrait.fixed_points)
        if point.kind in STABLE_POINTS and not point.drifts
    }
    settling = settling_time(scene, tuple(attractors.values()))
    groups = _grouped(scene, list(rests_of(scene, settling)))
    step = max((stretch.step for stretch in scene.stretches), default=1.0)
    taken: set[int] = set()
    found = []
    centres = [np.mean([rest.place for rest in group], axis=0) for group in groups]
    pairs = sorted(
        (_distance(scene, centre, point.at), k, i)
        for k, centre in enumerate(centres)
        for i, point in attractors.items()
    )
    stands_for: dict[int, int] = {}
    for distance, k, i in pairs:
        if distance <= FAR and k not in stands_for and i not in taken:
            stands_for[k] = i
            taken.add(i)
    for k, group in enumerate(groups):
        at, is_long = resting_place(scene, tuple(group), settling, step, confidence)
        found.append(RestingPlace(at, len(group), stands_for.get(k, -1), is_long))
    return tuple(found)


def _grouped(scene: Scene, rests: list[Rest]) -> list[list[Rest]]:
    """Rests at the same place together: each joins the first group that is near."""
    room = np.maximum(APART * scene.width, TOLERANCES * allowance(scene))
    groups: list[list[Rest]] = []
    for rest in rests:
        for group in groups:
            if np.all(np.abs(shortest(rest.place - group[0].place, scene.turns)) <= room):
                group.append(rest)
                break
        else:
            groups.append([rest])
    return groups


def _distance(scene: Scene, place: Array, other: Array) -> float:
    """The largest share of a domain between two places."""
    return float(np.max(np.abs(shortest(place - other, scene.turns)) / scene.width))
