"""One cycle of ALCSR in plain Python: the definition that is read; kernels give the same bits.

Thesis, sections 4.3.1 to 4.3.5, in the order of the text. It is slow on purpose: lists of
organisms, one idea to a function. Chance is drawn in the order in which the lines stand, so that
the compiled core gives the same bits.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol, final

from lcs.alcsr.config import Config
from lcs.alcsr.readings import (
    CorpseRate,
    CorpsesLearn,
    CorpseSpans,
    CoveredIs,
    DamagedBy,
    ErrorOf,
    FirstAggressor,
    Generalization,
    HalfOf,
    MutationIs,
    NeighborsAre,
    OffspringIn,
    Order,
    PredictionIs,
    RangeIs,
    SeedingBy,
    SeedsAre,
    StarvedAt,
    VoteOfNone,
)

BEYOND = 0.1
"""By how much of its width a hull may be moved out, where a reading has it so."""


class Chance(Protocol):
    """Where random numbers come from."""

    def random(self) -> float:
        """The next one, uniform in [0, 1)."""
        ...


@final
@dataclass(eq=False, slots=True)
class Organism:
    """A rule: its body is [lower, upper) in each dimension; what it predicts is its food-type.

    right, wrong: how often it was. strength_center, weakness_center: where on average.
    was_able: whether it could breed before it was fed last.
    """

    lower: list[float]
    upper: list[float]
    prediction: float
    strength: float = 0.0
    experience: int = 0
    volume: float = 0.0
    right: int = 0
    wrong: int = 0
    strength_center: list[float] = field(default_factory=list)
    weakness_center: list[float] = field(default_factory=list)
    damaged: bool = False
    was_able: bool = False


@final
@dataclass(eq=False, slots=True)
class Corpse:
    """Of a rule that died of a wrong prediction: its centre, and its cover fractions."""

    center: list[float]
    prediction: float
    lower_fraction: list[float]
    upper_fraction: list[float]


@final
@dataclass(eq=False, slots=True)
class Landscape:
    """Of one action: who lives there, and who died there of the wrong food."""

    organisms: list[Organism] = field(default_factory=list)
    mausoleum: list[Corpse] = field(default_factory=list)


@final
@dataclass(eq=False, slots=True)
class World:
    """All landscapes, and the range of inputs: experienced so far, or declared."""

    config: Config
    landscapes: list[Landscape]
    low: list[float]
    high: list[float]
    reward_range: float

    @property
    def width(self) -> list[float]:
        """The range of each input."""
        return [high - low for low, high in zip(self.low, self.high, strict=True)]


@final
@dataclass(frozen=True, slots=True)
class Choice:
    """The action of a cycle; is_test where it is the best, and ends there."""

    action: int
    is_test: bool
    votes: tuple[float, ...]


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


def experience(world: World, x: list[float]) -> None:
    """Widen the known range by `x`; volumes are fractions of it (4.3.1)."""
    if world.config.readings.range_is is RangeIs.DECLARED:
        return
    grown = False
    for i, value in enumerate(x):
        if value < world.low[i]:
            world.low[i], grown = value, True
        if value > world.high[i]:
            world.high[i], grown = value, True
    if grown:
        for land in world.landscapes:
            for organism in land.organisms:
                organism.volume = volume_of(world, organism)


def covers(world: World, organism: Organism, x: list[float]) -> bool:
    """Whether `x` lies in its body: half open, but closed where the known range ends."""
    bounds = zip(organism.lower, x, organism.upper, world.high, strict=True)
    return all(low <= at and (at < up or at == up == end) for low, at, up, end in bounds)


def volume_of(world: World, organism: Organism) -> float:
    """Its volume, of the known range's (4.3.1)."""
    volume = 1.0
    for low, up, width in zip(organism.lower, organism.upper, world.width, strict=True):
        if width > 0.0:
            volume *= (up - low) / width
    return volume


# 4.3.2 The performance system


def choose(world: World, sets: Sequence[Sequence[Organism]], rng: Chance) -> Choice:
    """An action at random where one is unknown, and with P(explore); else the best."""
    empty = [action for action, each in enumerate(sets) if not _votes(world, each)]
    if empty:
        return Choice(empty[_pick(rng, len(empty))], is_test=False, votes=())
    if rng.random() < world.config.explore:
        return Choice(_pick(rng, len(sets)), is_test=False, votes=())
    votes = tuple(vote(world, each) for each in sets)
    best = [action for action, each in enumerate(votes) if each == max(votes)]
    action = best[0] if len(best) == 1 else best[_pick(rng, len(best))]
    return Choice(action, is_test=True, votes=votes)


def vote(world: World, voters: Sequence[Organism]) -> float:
    """The reward that they expect, each weighed by its strength per volume."""
    total = weighed = plain = 0.0
    for voter in voters:
        weight = voter.strength / voter.volume
        if not is_mature(world, voter):
            weight *= world.config.immature_vote
        total += weight
        weighed += weight * voter.prediction
        plain += voter.prediction
    return weighed / total if total > 0.0 else plain / len(voters)


def _votes(world: World, voters: Sequence[Organism]) -> bool:
    if world.config.readings.vote_of_none is VoteOfNone.EQUAL:
        return bool(voters)
    return any(voter.strength > 0.0 for voter in voters)


def _pick(rng: Chance, count: int) -> int:
    return int(rng.random() * count)


# 4.3.3 Accuracy pressure


def feed(world: World, feeding: Sequence[Organism], x: list[float], reward: float) -> None:
    """Share a unit of food: the wrong type poisons."""
    config, share = world.config, float(len(feeding))
    for organism in feeding:
        organism.was_able = can_breed(world, organism)
        error = error_of(world, organism.prediction, reward)
        organism.strength += (1.0 - error * config.error_cost) / share - config.metabolism_cost
        organism.experience += 1
        is_wrong = error > config.damaged_error
        sticks = config.readings.damaged_by is DamagedBy.ANY and organism.damaged
        organism.damaged = is_wrong or sticks
        if is_wrong:
            organism.wrong += 1
            _move(organism.weakness_center, x, organism.wrong)
        else:
            organism.right += 1
            _move(organism.strength_center, x, organism.right)
        if config.readings.prediction_is is PredictionIs.AVERAGED:
            organism.prediction += config.learning_rate * (reward - organism.prediction)


def error_of(world: World, prediction: float, reward: float) -> float:
    """The prediction error, as a fraction of what was returned."""
    if world.config.readings.error_of is ErrorOf.RANGE or reward == 0.0:
        return abs(prediction - reward) / world.reward_range
    return abs(prediction - reward) / abs(reward)


def _move(center: list[float], x: list[float], count: int) -> None:
    for i, value in enumerate(x):
        center[i] += (value - center[i]) / count


def is_mature(world: World, organism: Organism) -> bool:
    """Table 4.3."""
    return organism.experience > world.config.mature_level * organism.volume


def can_breed(world: World, organism: Organism) -> bool:
    """Table 4.3."""
    return organism.strength >= world.config.breed_level * organism.volume


# What follows the food


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


def die(world: World, land: Landscape, feeding: list[Organism]) -> None:
    """Remove the starved; the poisoned among them go into the mausoleum."""
    at_zero = world.config.readings.starved_at is StarvedAt.ZERO
    dead = [o for o in feeding if o.strength < 0.0 or (at_zero and o.strength == 0.0)]
    for organism in dead:
        if organism.damaged:
            bury(world, land, organism)
    _remove(land, feeding, dead)


def _remove(land: Landscape, feeding: list[Organism], dead: Sequence[Organism]) -> None:
    """The last one takes the place of each that is removed."""
    places = [i for i, each in enumerate(land.organisms) if any(each is o for o in dead)]
    for place in reversed(places):
        land.organisms[place] = land.organisms[-1]
        land.organisms.pop()
    feeding[:] = [o for o in feeding if not any(o is each for each in dead)]


# 4.3.4 Genetic generalization pressure


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
        first = _pick(rng, len(able))
        second = _pick(rng, len(able) - 1)
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


def center_of(organism: Organism) -> list[float]:
    """The middle of its body."""
    return [0.5 * (low + up) for low, up in zip(organism.lower, organism.upper, strict=True)]


def squared_distance(one: Sequence[float], other: Sequence[float]) -> float:
    """Of two points."""
    total = 0.0
    for a, b in zip(one, other, strict=True):
        total += (a - b) * (a - b)
    return total


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
    return _newborn(lower, upper, one.prediction)


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


# 4.3.5 Covering pressure for specificity


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


def cover(world: World, land: Landscape, x: list[float], reward: float, rng: Chance) -> None:
    """A new rule around an input that none covers."""
    below, above = fractions_at(world, land, x, reward)
    lower, upper = [], []
    for i, width in enumerate(world.width):
        low = x[i] - rng.random() * below[i] * width
        up = x[i] + rng.random() * above[i] * width
        lower.append(max(low, world.low[i]))
        upper.append(min(up, world.high[i]))
    organism = _newborn(lower, upper, reward)
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


def _newborn(lower: list[float], upper: list[float], prediction: float) -> Organism:
    zeros = [0.0] * len(lower)
    return Organism(
        lower, upper, prediction, strength_center=list(zeros), weakness_center=list(zeros)
    )
