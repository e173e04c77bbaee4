"""What the kernels work on: arrays of all landscapes, and the constants.

A: actions, one landscape each; C: room for rules; M: room for corpses; n: inputs.
Rules of landscape a stand in [a, :living[a]]; where one is removed the last takes its place.
"""

from typing import NamedTuple

from lcs.arrays import Array, Booleans, Counts, Integers


class Rules(NamedTuple):
    """All rules. (A, C, n): lower, upper and centers; living (A,): how many; else (A, C).

    Of those who live beyond the thesis: fed_at, how much food their land had when they were fed
    last; grows_at, after how much food they grow again; meals and poisoned, what they were offered
    since they grew, and how often it was wrong; core_meals and core_wrong, the same in their core.
    """

    living: Integers
    lower: Array
    upper: Array
    prediction: Array
    strength: Array
    experience: Integers
    volume: Array
    right: Integers
    wrong: Integers
    right_center: Array
    wrong_center: Array
    damaged: Booleans
    was_able: Booleans
    fed_at: Integers
    grows_at: Integers
    meals: Integers
    poisoned: Integers
    core_meals: Integers
    core_wrong: Integers


class Corpses(NamedTuple):
    """The mausoleums. (A, M, n): center and fractions; buried (A,): how many; else (A, M)."""

    buried: Integers
    center: Array
    prediction: Array
    lower: Array
    upper: Array


class Land(NamedTuple):
    """What is known of the land: the range of inputs, low and high (n,), and what grew there.

    foods (A, n, N), rewards (A, N): the last N, met (A,) of all there were. noise (A,): the share
    of wrong rewards. season (A,): after how much food the season ends.
    order (A, n, N): the places of these foods, by each input, when there had been `ordered` (A,);
    sample (A, n, S): those of the first S places.
    """

    low: Array
    high: Array
    foods: Array
    rewards: Array
    met: Integers
    noise: Array
    season: Integers
    order: Integers
    sample: Integers
    ordered: Integers


class Numbers(NamedTuple):
    """`Config`, `Readings` and `Beyond`, and the range of rewards, for kernels."""

    explore: float
    immature_vote: float
    error_cost: float
    metabolism_cost: float
    damaged_error: float
    mature_level: float
    breed_level: float
    breeding_neighbors: int
    breeding_share: float
    generalize: float
    mutate: float
    mutation: float
    transfer: float
    seeding: float
    corpses: int
    corpse_neighbors: int
    corpse_rate: float
    sprout_width: float
    learning_rate: float
    reward_range: float
    error_of: int
    prediction_is: int
    damaged_by: int
    starved_at: int
    order: int
    covered_is: int
    vote_of_none: int
    seeds_are: int
    neighbors_are: int
    half_of: int
    offspring_in: int
    generalization: int
    mutation_is: int
    first_aggressor: int
    range_is: int
    corpse_spans: int
    corpses_learn: int
    corpse_rate_is: int
    seeding_by: int
    remembers: int
    sprouts: int
    grows: int
    withdraws: int
    famine: int
    season: int
    doubts: int
    hunger: int
    breeds: int
    weighs_evidence: int


class Scratch(NamedTuple):
    """Room to work in, and where a cycle stands that had to stop for more room.

    fed (A, C), fed_count (A,): the potential action sets. order (C,), dead (C,): in fights and
    deaths. pool (C,): of breeding; able (C,): those fit for it. near, distance (K,): neighbors.
    votes (A,). fractions (2, n): of covering.
    Of growth: body (4, n), lower and upper, now and at best; axes (n,), place (n,), losses (2 n,);
    values, signs, outside and eaters (N,), of each food that is remembered; picked (N + 1,).
    progress: `STAGE`, `SEED`, `POOL`, `ACTION`.
    tally: how many were `COVERED` and `BRED`, and died `POISONED`, `STARVED` and `EATEN`.
    """

    fed: Integers
    fed_count: Integers
    order: Integers
    dead: Booleans
    pool: Integers
    able: Integers
    near: Integers
    distance: Array
    votes: Array
    fractions: Array
    body: Array
    axes: Integers
    place: Array
    losses: Array
    values: Array
    signs: Array
    outside: Counts
    picked: Integers
    eaters: Integers
    progress: Integers
    tally: Integers


STAGE, SEED, POOL, ACTION = range(4)
BEGINNING, LIVED, UNEATEN, UNTENDED, UNCOVERED, DONE = -1, 3, 4, 5, 6, 7
"""Stages before and after those of `Order`; in `UNEATEN` and `UNTENDED` kernels stop for `tend`."""

COVERED, BRED, POISONED, STARVED, EATEN = range(5)
