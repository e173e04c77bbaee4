"""What the kernels work on: what the land remembers, and the bodies that live on it.

M: room for memories; B: bodies; A: actions; n: inputs.
"""

from typing import NamedTuple

from lcs.arrays import Array, Booleans, Integers


class Land(NamedTuple):
    """Steps tried by chance, a fair sample of them: from x (M, n) by an action to `after` (M, n).

    action, reward, ends: (M,). seen (1,): how many steps there were ever.
    """

    x: Array
    action: Integers
    reward: Array
    after: Array
    ends: Booleans
    seen: Integers


class Bodies(NamedTuple):
    """Boxes with what each action is worth there.

    lower, upper (B, n): lower <= x < upper. meals, expected (B, A): how many memories of an action
    it holds, and the mean of what they led to, discounted. first (F + 1,): where each family
    begins; the bodies of a family cover everything and share no place.
    """

    lower: Array
    upper: Array
    meals: Integers
    expected: Array
    first: Integers


class Numbers(NamedTuple):
    """`Config`, for kernels."""

    explore: float
    discount: float
    fed: int
    families: int
    generations: int
    longest: int
