"""Covering pressure for specificity (4.3.5): a new rule where none covers an input."""

from lcs.alcsr.definition.accuracy import feed
from lcs.alcsr.definition.corpses import nearest_corpses
from lcs.alcsr.definition.organisms import Chance, Landscape, World, newborn, volume_of
from lcs.alcsr.readings import CoveredIs, SeedingBy


def cover(world: World, land: Landscape, x: list[float], reward: float, rng: Chance) -> None:
    """A new rule around an input that none covers."""
    below, above = fractions_at(world, land, x, reward)
    lower, upper = [], []
    for i, width in enumerate(world.width):
        low = x[i] - rng.random() * below[i] * width
        up = x[i] + rng.random() * above[i] * width
        lower.append(max(low, world.low[i]))
        upper.append(min(up, world.high[i]))
    organism = newborn(lower, upper, reward)
    organism.volume = volume_of(world, organism)
    land.organisms.append(organism)
    if world.config.readings.covered_is is CoveredIs.FED:
        feed(world, [organism], x, reward)


def fractions_at(
    world: World, land: Landscape, x: list[float], reward: float
) -> tuple[list[float], list[float]]:
    """The cover fractions: a half while seeding, later by vote of the nearest corpses."""
    config = world.config
    own = config.readings.seeding_by is SeedingBy.SUB_SPECIES
    count = sum(not (own and c.prediction != reward) for c in land.mausoleum)
    if count < config.corpses:
        return [config.seeding] * len(x), [config.seeding] * len(x)
    near = nearest_corpses(world, land, x, reward)
    if near[0][0] == 0.0:
        return list(near[0][1].lower_fraction), list(near[0][1].upper_fraction)
    lower, upper, total = [0.0] * len(x), [0.0] * len(x), 0.0
    for distance, corpse in near:
        weight = 1.0 / distance
        total += weight
        for i in range(len(x)):
            lower[i] += weight * corpse.lower_fraction[i]
            upper[i] += weight * corpse.upper_fraction[i]
    return [each / total for each in lower], [each / total for each in upper]
