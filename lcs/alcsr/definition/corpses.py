"""The mausoleum (4.3.5): what those leave that died of the wrong food."""

import math
from collections.abc import Sequence

from lcs.alcsr.config import Config
from lcs.alcsr.definition.organisms import (
    Corpse,
    Landscape,
    Organism,
    World,
    center_of,
    squared_distance,
)
from lcs.alcsr.readings import CorpseRate, CorpsesLearn, CorpseSpans, SeedingBy


def bury(world: World, land: Landscape, organism: Organism) -> None:
    """A corpse, one of whose fractions is halved towards where it fed well; neighbors learn."""
    lower, upper = _spans(world, organism)
    halved = _halve(organism, lower, upper)
    corpse = Corpse(center_of(organism), organism.prediction, lower, upper)
    near = nearest_corpses(world, land, corpse.center, corpse.prediction)
    for distance, other in near:
        rate = _rate(world.config, distance, near[0][0])
        for i in range(len(lower)):
            if world.config.readings.corpses_learn is CorpsesLearn.ALL or i == halved:
                other.lower_fraction[i] += rate * (lower[i] - other.lower_fraction[i])
                other.upper_fraction[i] += rate * (upper[i] - other.upper_fraction[i])
    land.mausoleum.append(corpse)


def _spans(world: World, organism: Organism) -> tuple[list[float], list[float]]:
    spans, sprout = world.config.readings.corpse_spans, world.config.sprout_width
    lower, upper = [], []
    for i, width in enumerate(world.width):
        low, up = organism.lower[i], organism.upper[i]
        if width <= 0.0:
            below = above = 0.0
        elif spans is CorpseSpans.FROM_CENTER and organism.right > 0:
            below = (organism.strength_center[i] - low) / width
            above = (up - organism.strength_center[i]) / width
        else:
            below = above = (up - low) / width
            if spans is CorpseSpans.HALF_EACH:
                below = above = 0.5 * below
        lower.append(sprout * below)
        upper.append(sprout * above)
    return lower, upper


def _halve(organism: Organism, lower: list[float], upper: list[float]) -> int:
    """Halve the fraction that probably reached over a decision surface; its dimension, or -1."""
    if organism.right == 0 or organism.wrong == 0:
        return -1
    well, ill = organism.strength_center, organism.weakness_center
    apart = [abs(a - b) for a, b in zip(well, ill, strict=True)]
    widest = apart.index(max(apart))
    fractions = upper if well[widest] < ill[widest] else lower
    fractions[widest] *= 0.5
    return widest


def nearest_corpses(
    world: World, land: Landscape, x: Sequence[float], prediction: float
) -> list[tuple[float, Corpse]]:
    """The k_c nearest with their distances, the nearest first."""
    own = world.config.readings.seeding_by is SeedingBy.SUB_SPECIES
    corpses = [c for c in land.mausoleum if not (own and c.prediction != prediction)]
    corpses.sort(key=lambda c: squared_distance(c.center, x))
    near = corpses[: world.config.corpse_neighbors]
    return [(math.sqrt(squared_distance(c.center, x)), c) for c in near]


def _rate(config: Config, distance: float, least: float) -> float:
    match config.readings.corpse_rate:
        case CorpseRate.SHRUNK:
            return 1.0 / (1.0 + distance)
        case CorpseRate.RELATIVE:
            return least / distance if distance > 0.0 else 1.0
        case CorpseRate.CAPPED:
            return min(1.0, config.corpse_rate / distance) if distance > 0.0 else 1.0
