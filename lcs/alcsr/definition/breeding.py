"""Creating more general rules (4.3.4): pools of neighbors, and what is born in them."""

from collections.abc import Sequence

from lcs.alcsr.definition.organisms import (
    Chance,
    Landscape,
    Organism,
    World,
    can_breed,
    center_of,
    is_mature,
    newborn,
    pick,
    squared_distance,
    volume_of,
)
from lcs.alcsr.readings import (
    Generalization,
    HalfOf,
    MutationIs,
    NeighborsAre,
    OffspringIn,
    SeedsAre,
)

BEYOND = 0.1
"""By how much of its width a hull may be moved out, where a reading has it so."""


def breed(world: World, land: Landscape, feeding: Sequence[Organism], rng: Chance) -> None:
    """Form a breeding pool around each organism that may start one."""
    just = world.config.readings.seeds_are is SeedsAre.JUST_ABLE
    for seed in feeding:
        if is_mature(world, seed) and can_breed(world, seed) and not (just and seed.was_able):
            breed_around(world, land, seed, rng)


def breed_around(world: World, land: Landscape, seed: Organism, rng: Chance) -> None:
    """Breed in the pool of `seed` and its nearest neighbors while enough of them are fit for it."""
    config = world.config
    pool = [seed, *neighbors(world, land, seed)]
    asked = 1 + config.breeding_neighbors
    if config.readings.half_of is HalfOf.THOSE_THERE_ARE:
        asked = len(pool)
    while True:
        able = [
            o
            for o in pool
            if o.prediction == seed.prediction and is_mature(world, o) and can_breed(world, o)
        ]
        if len(able) < max(2.0, config.breeding_share * asked):
            return
        first = pick(rng, len(able))
        second = pick(rng, len(able) - 1)
        second += second >= first
        child = born(world, land, able[first], able[second], rng)
        land.organisms.append(child)
        if config.readings.offspring_in is OffspringIn.POOL:
            pool.append(child)


def neighbors(world: World, land: Landscape, seed: Organism) -> list[Organism]:
    """The k_b nearest by their centres; of those as near, the ones that stand first."""
    own = world.config.readings.neighbors_are is NeighborsAre.SUB_SPECIES
    others = [
        o for o in land.organisms if o is not seed and not (own and o.prediction != seed.prediction)
    ]
    others.sort(key=lambda o: squared_distance(center_of(o), center_of(seed)))
    return others[: world.config.breeding_neighbors]


def born(world: World, land: Landscape, one: Organism, other: Organism, rng: Chance) -> Organism:
    """An offspring by crossover, mutation and transfer of strength."""
    child = crossed(world, one, other, rng)
    if world.config.readings.mutation_is is MutationIs.ALWAYS:
        mutate(world, child, rng)
    while any(is_duplicate(child, each) for each in land.organisms):
        mutate(world, child, rng)
    child.volume = volume_of(world, child)
    both = one.volume + other.volume
    for parent in (one, other):
        share = parent.volume / both if both > 0.0 else 0.5
        given = min(parent.volume, child.volume * share)
        given *= world.config.transfer * world.config.breed_level
        parent.strength -= given
        child.strength += given
    return child


def crossed(world: World, one: Organism, other: Organism, rng: Chance) -> Organism:
    """In each dimension the hull of both, or else a copy of one of them."""
    lower, upper = [], []
    for i in range(len(one.lower)):
        if rng.random() < world.config.generalize:
            low, up = min(one.lower[i], other.lower[i]), max(one.upper[i], other.upper[i])
            if world.config.readings.generalization is Generalization.HULL_AND_BEYOND:
                width = up - low
                low = max(world.low[i], low - rng.random() * BEYOND * width)
                up = min(world.high[i], up + rng.random() * BEYOND * width)
        else:
            parent = one if rng.random() < 0.5 else other
            low, up = parent.lower[i], parent.upper[i]
        lower.append(low)
        upper.append(up)
    return newborn(lower, upper, one.prediction)


def mutate(world: World, child: Organism, rng: Chance) -> None:
    """Move each bound, by chance, a little."""
    config = world.config
    for i, width in enumerate(world.width):
        for bounds in (child.lower, child.upper):
            if rng.random() < config.mutate:
                moved = bounds[i] + (2.0 * rng.random() - 1.0) * config.mutation * width
                bounds[i] = min(max(moved, world.low[i]), world.high[i])
        if child.lower[i] > child.upper[i]:
            child.lower[i], child.upper[i] = child.upper[i], child.lower[i]


def is_duplicate(one: Organism, other: Organism) -> bool:
    """Of one sub-species, with the same body."""
    return (
        one.prediction == other.prediction and one.lower == other.lower and one.upper == other.upper
    )
