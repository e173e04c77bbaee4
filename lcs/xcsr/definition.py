"""One cycle of XCSR in plain Python: the definition that is read; kernels give the same bits.

Butz and Wilson 2001, whose procedures are named in capitals; `lcs.xcsr.conditions` has what is of
real-valued inputs. Slow on purpose. Chance is drawn in the order of the lines.

Three places are ours. A cycle is that of the other learners here: an input that had to be covered
is tried, a test teaches nothing, and time counts the tries. Both children are inserted before
somebody is deleted. A parent's fitness is shared out among its copies before a child inherits it.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import final

from lcs.xcsr import conditions
from lcs.xcsr.conditions import Chance, Condition, Space, pick
from lcs.xcsr.config import Selection

LEAST_ACCURACY = 1e-100
"""Accuracy stays above zero, however wrong."""


@final
@dataclass(eq=False, slots=True)
class Classifier:
    """A rule, and how many equal ones (`numerosity`) it stands for.

    set_size: of its action sets, on average. born: the time of the last birth in its action set.
    right, wrong: how often a reward came within epsilon_0 of what it expects, and did not.
    """

    condition: Condition
    action: int
    prediction: float
    error: float
    fitness: float
    born: int
    numerosity: int = 1
    experience: int = 0
    set_size: float = 1.0
    right: int = 0
    wrong: int = 0


@final
@dataclass(eq=False, slots=True)
class World:
    """The population [P], the time, and how many classifiers came and went."""

    space: Space
    actions: int
    population: list[Classifier] = field(default_factory=list)
    time: int = 0
    births: int = 0
    deaths: int = 0


@final
@dataclass(frozen=True, eq=False, slots=True)
class Choice:
    """The action of a cycle and its action set [A]; votes are of a test."""

    action: int
    action_set: list[Classifier]
    is_test: bool
    votes: tuple[float, ...]


def cycle(world: World, x: list[float], reward_of: Callable[[int], float], rng: Chance) -> Choice:
    """One operating cycle on the input `x` of a problem of one step."""
    choice = act(world, x, rng)
    if not choice.is_test:
        learn(world, choice.action_set, reward_of(choice.action), None, rng)
    return choice


def act(world: World, x: list[float], rng: Chance) -> Choice:
    """An action at random where one had to be covered, and with P(explore); else the best."""
    matched: list[Classifier] = []
    was_covered = match(world, x, matched, [], rng)
    present = sorted({each.action for each in matched})
    votes: list[float] = []
    is_test = not (was_covered or rng.random() < world.space.config.explore)
    if is_test:
        votes = prediction_array(world, matched)
        highest = max(votes[a] for a in present)
        present = [a for a in present if votes[a] == highest]
    action = present[0] if is_test and len(present) == 1 else present[pick(rng, len(present))]
    return Choice(action, [c for c in matched if c.action == action], is_test, tuple(votes))


def learn(
    world: World,
    action_set: list[Classifier],
    reward: float,
    following: list[float] | None,
    rng: Chance,
) -> None:
    """What came of [A]: the reward, and what is expected on the input `following`."""
    world.time += 1
    payoff = reward
    if following is not None:
        matched: list[Classifier] = []
        match(world, following, matched, action_set, rng)
        votes = prediction_array(world, matched)
        payoff += world.space.config.gamma * max(votes[c.action] for c in matched)
    update(world, action_set, payoff)
    if world.space.config.action_set_subsumption:
        subsume_within(world, action_set)
    breed(world, action_set, rng)


# GENERATE MATCH SET, GENERATE PREDICTION ARRAY


def match(
    world: World, x: list[float], matched: list[Classifier], kept: list[Classifier], rng: Chance
) -> bool:
    """Fill [M], covering while it has too few actions; whether it had. `kept` loses who dies."""
    matched += [c for c in world.population if conditions.holds(world.space, c.condition, x)]
    asked = world.space.config.theta_mna or world.actions
    was_covered = False
    while len(present := {c.action for c in matched}) < asked:
        unknown = [a for a in range(world.actions) if a not in present]
        matched.append(cover(world, x, unknown[pick(rng, len(unknown))], rng))
        world.population.append(matched[-1])
        world.births += 1
        delete(world, [matched, kept], rng)
        was_covered = True
    return was_covered


def cover(world: World, x: list[float], action: int, rng: Chance) -> Classifier:
    """GENERATE COVERING CLASSIFIER."""
    config, condition = world.space.config, conditions.covering(world.space, x, rng)
    return Classifier(condition, action, config.p_I, config.epsilon_I, config.F_I, world.time)


def prediction_array(world: World, matched: Sequence[Classifier]) -> list[float]:
    """For each action the mean prediction, weighed by fitness; NaN where nobody says."""
    weighed, total = [0.0] * world.actions, [0.0] * world.actions
    for c in matched:
        weighed[c.action] += c.prediction * c.fitness
        total[c.action] += c.fitness
    return [w / t if t > 0.0 else math.nan for w, t in zip(weighed, total, strict=True)]


# UPDATE SET, UPDATE FITNESS


def update(world: World, action_set: Sequence[Classifier], payoff: float) -> None:
    """Move all of [A] towards what came: as the mean of what came so far at first, then by beta."""
    config, size = world.space.config, sum(c.numerosity for c in action_set)
    for c in action_set:
        c.experience += 1
        rate = max(config.beta, 1.0 / c.experience)
        c.prediction += rate * (payoff - c.prediction)
        missed = abs(payoff - c.prediction)
        c.error += rate * (missed - c.error)
        c.set_size += rate * (size - c.set_size)
        c.right += missed < config.epsilon_0
        c.wrong += missed >= config.epsilon_0
    accuracies = [accuracy(world, c) * c.numerosity for c in action_set]
    total = summed(accuracies)
    for c, each in zip(action_set, accuracies, strict=True):
        c.fitness += config.beta * (each / total - c.fitness)


def accuracy(world: World, c: Classifier) -> float:
    """Accuracy: 1 below epsilon_0, and steeply down beyond."""
    config = world.space.config
    if c.error < config.epsilon_0:
        return 1.0
    return max(float(config.alpha * (c.error / config.epsilon_0) ** -config.nu), LEAST_ACCURACY)


def summed(values: Sequence[float]) -> float:
    """The sum from left to right, which Python's own `sum` is not."""
    total = 0.0
    for each in values:
        total += each
    return total


# RUN GA


def breed(world: World, action_set: Sequence[Classifier], rng: Chance) -> None:
    """Two children, if the last birth among them is long ago on average."""
    config = world.space.config
    size = sum(c.numerosity for c in action_set)
    born = sum(c.born * c.numerosity for c in action_set)
    if size == 0 or world.time - born / size <= config.theta_GA:
        return
    for c in action_set:
        c.born = world.time
    parents = [select(world, action_set, rng), select(world, action_set, rng)]
    one, other = (child_of(parent) for parent in parents)
    if rng.random() < config.chi:
        conditions.cross(one.condition, other.condition, rng)
        one.prediction = other.prediction = (one.prediction + other.prediction) / 2.0
        one.error = other.error = (one.error + other.error) / 2.0
        one.fitness = other.fitness = (one.fitness + other.fitness) / 2.0
    for child in (one, other):
        mutate(world, child, rng)
        child.error *= 0.25
        child.fitness *= 0.1
        insert(world, child, parents)
    delete(world, [], rng)


def select(world: World, action_set: Sequence[Classifier], rng: Chance) -> Classifier:
    """SELECT OFFSPRING: by fitness on a wheel, or the fittest copy of a random sample."""
    if world.space.config.selection is Selection.ROULETTE:
        return on_wheel([c.fitness for c in action_set], action_set, rng)
    best, fittest = action_set[pick(rng, len(action_set))], 0.0
    for c in action_set:
        enters = 1.0 - (1.0 - world.space.config.tau) ** c.numerosity
        if rng.random() < enters and c.fitness / c.numerosity > fittest:
            best, fittest = c, c.fitness / c.numerosity
    return best


def on_wheel(shares: Sequence[float], ones: Sequence[Classifier], rng: Chance) -> Classifier:
    """One of them, each with a chance in proportion to its share."""
    point = rng.random() * summed(shares)
    passed = 0.0
    for one, share in zip(ones, shares, strict=True):
        passed += share
        if passed > point:
            return one
    return ones[-1]


def child_of(parent: Classifier) -> Classifier:
    """A single copy that has no experience."""
    condition = Condition([*parent.condition.first], [*parent.condition.second])
    share = parent.fitness / parent.numerosity
    return replace(
        parent, condition=condition, fitness=share, numerosity=1, experience=0, right=0, wrong=0
    )


def mutate(world: World, child: Classifier, rng: Chance) -> None:
    """APPLY MUTATION: of the condition, and another action with the chance mu."""
    conditions.mutate(world.space, child.condition, rng)
    if world.actions > 1 and rng.random() < world.space.config.mu:
        other = pick(rng, world.actions - 1)
        child.action = other + (other >= child.action)


# DOES SUBSUME, INSERT IN POPULATION, DELETE FROM POPULATION


def could_subsume(world: World, c: Classifier) -> bool:
    """COULD SUBSUME: experienced and accurate."""
    config = world.space.config
    return c.experience > config.theta_sub and c.error < config.epsilon_0


def is_more_general(world: World, one: Classifier, other: Classifier) -> bool:
    """IS MORE GENERAL."""
    return conditions.is_more_general(world.space, one.condition, other.condition)


def subsume_within(world: World, action_set: list[Classifier]) -> None:
    """DO ACTION SET SUBSUMPTION: the widest that could takes in all within it."""
    able = [c for c in action_set if could_subsume(world, c)]
    if not able:
        return
    widest = max(able, key=lambda c: conditions.width(world.space, c.condition))
    for c in reversed(action_set.copy()):
        if is_more_general(world, widest, c):
            widest.numerosity += c.numerosity
            remove(world, c, [action_set])


def insert(world: World, child: Classifier, parents: Sequence[Classifier]) -> None:
    """One more of a parent that subsumes it or of an equal one, or a new classifier."""
    if world.space.config.ga_subsumption:
        for parent in parents:
            is_able = parent.action == child.action and could_subsume(world, parent)
            if is_able and is_more_general(world, parent, child):
                parent.numerosity += 1
                return
    for c in world.population:
        if c.action == child.action and c.condition == child.condition:
            c.numerosity += 1
            return
    world.population.append(child)
    world.births += 1


def delete(world: World, sets: Sequence[list[Classifier]], rng: Chance) -> None:
    """Delete copies until N are left, those of large action sets and of low fitness sooner."""
    while (size := sum(c.numerosity for c in world.population)) > world.space.config.N:
        mean = summed([c.fitness for c in world.population]) / size
        votes = [deletion_vote(world, c, mean) for c in world.population]
        chosen = on_wheel(votes, world.population, rng)
        chosen.numerosity -= 1
        if chosen.numerosity == 0:
            remove(world, chosen, sets)


def deletion_vote(world: World, c: Classifier, mean: float) -> float:
    """DELETION VOTE; `mean` is the mean fitness of a copy."""
    config = world.space.config
    vote, fitness = c.set_size * c.numerosity, c.fitness / c.numerosity
    if c.experience > config.theta_del and fitness < config.delta * mean:
        vote *= mean / fitness
    return vote


def remove(world: World, dead: Classifier, sets: Sequence[list[Classifier]]) -> None:
    """Take it out of [P], where the last one takes its place, and out of `sets`."""
    place = next(i for i, c in enumerate(world.population) if c is dead)
    world.population[place] = world.population[-1]
    world.population.pop()
    world.deaths += 1
    for each in sets:
        each[:] = [c for c in each if c is not dead]
