"""One operating cycle, in the order of the thesis's sections 4.3.2 to 4.3.5."""

from collections.abc import Callable

from lcs.alcsr.definition.accuracy import feed
from lcs.alcsr.definition.breeding import breed
from lcs.alcsr.definition.covering import cover
from lcs.alcsr.definition.deaths import die, fight
from lcs.alcsr.definition.organisms import Chance, Landscape, Organism, World, covers, experience
from lcs.alcsr.definition.performance import Choice, choose
from lcs.alcsr.readings import Order


def cycle(world: World, x: list[float], reward_of: Callable[[int], float], rng: Chance) -> Choice:
    """One operating cycle on the input `x`."""
    experience(world, x)
    sets = [[o for o in land.organisms if covers(world, o, x)] for land in world.landscapes]
    choice = choose(world, sets, rng)
    if choice.is_test:
        return choice
    reward = reward_of(choice.action)
    land, feeding = world.landscapes[choice.action], sets[choice.action]
    if feeding:
        feed(world, feeding, x, reward)
        live_on(world, land, feeding, rng)
    else:
        cover(world, land, x, reward, rng)
    return choice


def live_on(world: World, land: Landscape, feeding: list[Organism], rng: Chance) -> None:
    """Deaths, fights and births among those that were fed, in the order of the reading."""
    match world.config.readings.order:
        case Order.DIE_FIGHT_BREED:
            die(world, land, feeding)
            fight(world, land, feeding)
            breed(world, land, feeding, rng)
        case Order.FIGHT_DIE_BREED:
            fight(world, land, feeding)
            die(world, land, feeding)
            breed(world, land, feeding, rng)
        case Order.DIE_BREED_FIGHT:
            die(world, land, feeding)
            breed(world, land, feeding, rng)
            fight(world, land, feeding)
