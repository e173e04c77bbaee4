"""The best that can be reached in the square: found without any learner, to measure them by."""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array
from lcs.problems.kernels import iterating
from lcs.problems.steps import GOAL, STEP, Plane

CELLS: Final = 200
"""Of the grid, along each side; a step is then ten cells."""
NEAR: Final = 1e-7
NODES: Final = 5
"""Noises that stand for all of them, in each coordinate."""
LONGEST: Final = 2_000


@final
@dataclass(frozen=True, eq=False, slots=True)
class Optimum:
    """The value of the places of a grid (G, G) in x and y: the best expected return, undiscounted.

    noises, shares (K,): what stands for the noise in one coordinate.
    """

    plane: Plane
    value: Array
    noises: Array
    shares: Array

    def follow(self, starts: Array, outside: np.random.Generator) -> tuple[Array, Array]:
        """Steps and returns (E,) from each start (E, 2), by the actions that lead to most."""
        told = np.zeros((len(starts), 2))
        iterating.follow(
            self.plane.square,
            self.value,
            self.noises,
            self.shares,
            np.ascontiguousarray(starts),
            LONGEST,
            told,
            outside,
        )
        return told[:, 0], told[:, 1]


def optimum(plane: Plane, cells: int = CELLS) -> Optimum:
    """Value iteration, linear between the points of the grid (Munos and Moore 2002).

    Normal noise is replaced by the five nodes of the Gauss-Hermite rule, which has the same
    moments up to the ninth.
    """
    if plane.square.noise > 0.0:
        nodes, weights = np.polynomial.hermite_e.hermegauss(NODES)
    else:
        nodes, weights = np.zeros(1), np.ones(1)
    noises, shares = plane.square.noise * nodes, weights / weights.sum()
    value = np.zeros((cells + 1, cells + 1))
    iterating.iterate(plane.square, value, noises, shares, NEAR)
    return Optimum(plane, value, noises, shares)


def fewest_steps(places: Array) -> Array:
    """The steps (E,) from places (E, 2) to the goal of a world without noise, in closed form.

    A step adds 0.05 to x + y at most, and always can: where both coordinates are so near their
    border that it would stop them, the goal is reached.
    """
    left = np.maximum(GOAL - places.sum(axis=1), 0.0)
    return np.asarray(np.floor(left / STEP) + 1.0)
