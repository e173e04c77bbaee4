"""Deaths of those that were fed: starved or poisoned (4.3.3), or eaten by larger ones (4.3.4)."""

from collections.abc import Sequence

from lcs.alcsr.definition.corpses import bury
from lcs.alcsr.definition.organisms import Landscape, Organism, World, is_mature
from lcs.alcsr.readings import FirstAggressor, StarvedAt


def die(world: World, land: Landscape, feeding: list[Organism]) -> None:
    """Remove the starved; the poisoned among them go into the mausoleum."""
    at_zero = world.config.readings.starved_at is StarvedAt.ZERO
    dead = [o for o in feeding if o.strength < 0.0 or (at_zero and o.strength == 0.0)]
    for organism in dead:
        if organism.damaged:
            bury(world, land, organism)
    _remove(land, feeding, dead)


def fight(world: World, land: Landscape, feeding: list[Organism]) -> None:
    """Mature organisms eat the weaker ones of their sub-species that they engulf."""
    order = list(feeding)
    if world.config.readings.first_aggressor is FirstAggressor.LARGEST:
        order.sort(key=lambda o: -o.volume)
    dead: list[Organism] = []
    for aggressor in order:
        if any(aggressor is o for o in dead) or not is_mature(world, aggressor):
            continue
        dead += [
            victim
            for victim in feeding
            if not any(victim is o for o in dead) and is_eaten(world, aggressor, victim)
        ]
    _remove(land, feeding, dead)


def is_eaten(world: World, aggressor: Organism, victim: Organism) -> bool:
    """Whether an attack succeeds."""
    return (
        victim is not aggressor
        and victim.prediction == aggressor.prediction
        and is_mature(world, victim)
        and aggressor.strength > victim.strength
        and all(a <= v for a, v in zip(aggressor.lower, victim.lower, strict=True))
        and all(a >= v for a, v in zip(aggressor.upper, victim.upper, strict=True))
    )


def _remove(land: Landscape, feeding: list[Organism], dead: Sequence[Organism]) -> None:
    """The last one takes the place of each that is removed."""
    places = [i for i, each in enumerate(land.organisms) if any(each is o for o in dead)]
    for place in reversed(places):
        land.organisms[place] = land.organisms[-1]
        land.organisms.pop()
    feeding[:] = [o for o in feeding if not any(o is each for each in dead)]
