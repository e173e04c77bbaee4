"""What the kernels work on: arrays of all classifiers, and the constants.

A: actions; n: inputs; C: room for classifiers, which is N and what a cycle adds before it deletes.
Classifiers stand in [:counts[LINES]]; where one is removed the last takes its place. Of each input
all classifiers lie side by side, so that matching goes through memory in one line.
"""

from typing import Final, NamedTuple

from lcs.arrays import Array, Integers

ROOM_BESIDES: Final = 2
"""Two children, or one that covers, are there before somebody is deleted."""

LINES, COPIES, TIME, BIRTHS, DEATHS = range(5)
MATCHED, ACTING = range(2)


class Classifiers(NamedTuple):
    """All classifiers. (n, C): genes `first` and `second`, and where they hold: lower, upper.

    counts: `LINES`, `COPIES` (by numerosity), `TIME`, and `BIRTHS` and `DEATHS` so far. Else (C,).
    """

    counts: Integers
    first: Array
    second: Array
    lower: Array
    upper: Array
    action: Integers
    prediction: Array
    error: Array
    fitness: Array
    numerosity: Integers
    experience: Integers
    set_size: Array
    born: Integers
    right: Integers
    wrong: Integers


class Space(NamedTuple):
    """The range of the inputs, (n,)."""

    low: Array
    high: Array


class Numbers(NamedTuple):
    """`Config` for kernels; capitals and indices of the papers are written small."""

    most: int
    beta: float
    alpha: float
    epsilon_0: float
    nu: float
    gamma: float
    theta_ga: float
    chi: float
    mu: float
    theta_del: int
    delta: float
    theta_sub: int
    theta_mna: int
    s_0: float
    m_0: float
    p_hash: float
    prediction: float
    error: float
    fitness: float
    ga_subsumption: bool
    action_set_subsumption: bool
    selection: int
    tau: float
    bounds: int
    explore: float


class Scratch(NamedTuple):
    """Room to work in.

    sets (2, C), sizes (2,): the `MATCHED` and the `ACTING`. holds (C,): 1 where a condition holds.
    shares (C,): of a wheel, accuracies. votes, totals (A,): the prediction array, and whether
    somebody says. actions (A,): those to choose from. first, second (2, n): the genes of children.
    """

    sets: Integers
    sizes: Integers
    holds: Integers
    shares: Array
    votes: Array
    totals: Array
    actions: Integers
    first: Array
    second: Array
