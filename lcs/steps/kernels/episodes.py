"""Whole episodes in the square, compiled."""

import numpy as np

from lcs.arrays import Array
from lcs.compiled import kernel
from lcs.problems.kernels.plane import Square, start, step
from lcs.steps.kernels.layout import Bodies, Land, Numbers
from lcs.steps.kernels.voting import chosen, remember, tried


@kernel
def learn(
    square: Square,
    land: Land,
    bodies: Bodies,
    numbers: Numbers,
    due: int,
    done: int,
    told: Array,
    chance: np.random.Generator,
    outside: np.random.Generator,
) -> int:
    """Go through episodes from `done` on, until so many steps were tried as are `due`; how many.

    told (E, 3): of each its steps, the sum of its rewards, and whether it reached the goal.
    chance: the learner's. outside: the world's.
    """
    x, after, worth = np.empty(2), np.empty(2), np.empty(len(square.moves))
    while done < len(told) and land.seen[0] < due:
        start(square, outside, x)
        told[done] = 0.0
        for _ in range(numbers.longest):
            said = tried(bodies, x, numbers.explore, chance, worth)
            action = said if said >= 0 else -1 - said
            reward, ends = step(square, x, action, outside, after)
            if said >= 0:
                remember(land, x, action, reward, after, ends, chance)
            told[done, 0] += 1.0
            told[done, 1] += reward
            x[:] = after
            if ends:
                told[done, 2] = 1.0
                break
        done += 1
    return done


@kernel
def follow(
    square: Square,
    bodies: Bodies,
    starts: Array,
    longest: int,
    told: Array,
    chance: np.random.Generator,
    outside: np.random.Generator,
) -> None:
    """The best actions from each start (E, 2), nothing learnt; told (E, 3) as in `learn`."""
    x, after, worth = np.empty(2), np.empty(2), np.empty(len(square.moves))
    for e in range(len(starts)):
        x[:] = starts[e]
        for _ in range(longest):
            reward, ends = step(square, x, chosen(bodies, x, chance, worth), outside, after)
            told[e, 0] += 1.0
            told[e, 1] += reward
            x[:] = after
            if ends:
                told[e, 2] = 1.0
                break
