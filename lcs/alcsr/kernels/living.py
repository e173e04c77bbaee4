"""Who is born in a land that remembers, and who grows again."""

import numpy as np

from lcs.alcsr.kernels.covering import clear
from lcs.alcsr.kernels.growing import grow_on, sprout
from lcs.alcsr.kernels.hunger import due_to_grow
from lcs.alcsr.kernels.layout import BRED, Land, Numbers, Rules, Scratch
from lcs.alcsr.kernels.matching import volume_of
from lcs.alcsr.kernels.reaching import reach
from lcs.alcsr.kernels.remembering import least_evidence
from lcs.arrays import Array
from lcs.compiled import part

DOUBLE, FEW = 2, 8
"""A body grows again when it holds so many times the food, and some more."""


@part
def settle(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    x: Array,
    reward: float,
    rng: np.random.Generator,
) -> bool:
    """Food at x (n,) that nobody eats: somebody reaches for it, or grows there before it is born.

    False where it is to be covered as in the thesis.
    """
    if numbers.grows == 1:
        k = reach(rules, land, a, x, reward)
        if k >= 0:
            rules.right[a, k] += 1
            return True
    if numbers.sprouts == 0:
        return False
    bear_sprout(rules, land, numbers, scratch, a, x, reward, rng)
    return True


@part
def bear_sprout(
    rules: Rules,
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    x: Array,
    reward: float,
    rng: np.random.Generator,
) -> None:
    """A rule grown around x (n,), if there is room and it is no noise that it lives on."""
    k = rules.living[a]
    if k == rules.prediction.shape[1]:
        return
    right, wrong, evidence = sprout(land, numbers, scratch, a, x, reward, rng)
    if evidence < least_evidence(land, a, land.noise[a]):
        return
    clear(rules, a, k, reward)
    take_body(rules, land, scratch, a, k, right, wrong)
    rules.fed_at[a, k] = land.met[a]
    rules.living[a] = k + 1
    scratch.tally[BRED] += 1


@part
def take_body(
    rules: Rules, land: Land, scratch: Scratch, a: int, k: int, right: int, wrong: int
) -> None:
    """Give rule k the body that grew in `scratch.body`, and what it holds."""
    rules.lower[a, k] = scratch.body[0]
    rules.upper[a, k] = scratch.body[1]
    rules.volume[a, k] = volume_of(rules.lower[a, k], rules.upper[a, k], land)
    rules.right[a, k] = right
    rules.wrong[a, k] = wrong
    rules.grows_at[a, k] = DOUBLE * (right + wrong) + FEW
    rules.meals[a, k] = 0
    rules.poisoned[a, k] = 0


@part
def grow_again(
    rules: Rules, land: Land, scratch: Scratch, a: int, x: Array, rng: np.random.Generator
) -> None:
    """One of those fed at x (n,), if it has eaten enough since it grew."""
    due = due_to_grow(rules, scratch, a)
    if due < 0:
        return
    scratch.body[0] = rules.lower[a, due]
    scratch.body[1] = rules.upper[a, due]
    right, wrong = rules.right[a, due], rules.wrong[a, due]
    right, wrong = grow_on(land, scratch, a, x, rules.prediction[a, due], right, wrong, rng)
    take_body(rules, land, scratch, a, due, right, wrong)
    rules.core_meals[a, due] //= 2
    rules.core_wrong[a, due] //= 2
