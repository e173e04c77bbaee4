"""A step in a square, compiled."""

from typing import NamedTuple

import numpy as np

from lcs.arrays import Array
from lcs.compiled import kernel, part


class Square(NamedTuple):
    """The unit square: how far each action moves (A, 2), and what that costs.

    noise: the standard deviation added to both coordinates. goal: an episode ends where x + y is
    above it. each, at_goal: the reward of a step that doesn't reach the goal, and of one that does.
    puddles (P, 2, 2): the ends of each puddle's middle line; radius: of all of them.
    depth_cost: the reward lost for each unit of depth.
    """

    moves: Array
    noise: float
    goal: float
    each: float
    at_goal: float
    puddles: Array
    radius: float
    depth_cost: float


@part
def start(square: Square, chance: np.random.Generator, x: Array) -> None:
    """Draw a place (2,) that is no goal."""
    while True:
        x[0], x[1] = chance.random(), chance.random()
        if x[0] + x[1] <= square.goal:
            return


@part
def depth(square: Square, x: float, y: float) -> float:
    """How far a place lies from the nearest edge of the puddle it is deepest in; 0 if dry."""
    deepest = 0.0
    for k in range(len(square.puddles)):
        (ax, ay), (bx, by) = square.puddles[k]
        along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
        along = min(max(along, 0.0), 1.0)
        apart = np.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay))
        deepest = max(deepest, square.radius - apart)
    return deepest


@part
def moved(
    square: Square, x: Array, action: int, noise_x: float, noise_y: float, after: Array
) -> tuple[float, bool]:
    """Where an action leads with this noise, in `after` (2,): its reward, and whether it ends."""
    after[0] = min(max(x[0] + square.moves[action, 0] + noise_x, 0.0), 1.0)
    after[1] = min(max(x[1] + square.moves[action, 1] + noise_y, 0.0), 1.0)
    if after[0] + after[1] > square.goal:
        return square.at_goal, True
    return square.each - square.depth_cost * depth(square, after[0], after[1]), False


@part
def step(
    square: Square, x: Array, action: int, chance: np.random.Generator, after: Array
) -> tuple[float, bool]:
    """Where an action leads by chance, in `after` (2,): its reward, and whether it ends."""
    if square.noise == 0.0:
        return moved(square, x, action, 0.0, 0.0, after)
    noise_x = square.noise * chance.standard_normal()
    noise_y = square.noise * chance.standard_normal()
    return moved(square, x, action, noise_x, noise_y, after)


@kernel
def start_once(square: Square, chance: np.random.Generator, x: Array) -> None:
    """`start`, for Python."""
    start(square, chance, x)


@kernel
def step_once(
    square: Square, x: Array, action: int, chance: np.random.Generator, after: Array
) -> tuple[float, bool]:
    """`step`, for Python."""
    return step(square, x, action, chance, after)
