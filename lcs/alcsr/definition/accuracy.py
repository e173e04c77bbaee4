"""Accuracy pressure (4.3.3): who eats what it is not adapted to is poisoned."""

from collections.abc import Sequence

from lcs.alcsr.definition.organisms import Organism, World, can_breed
from lcs.alcsr.readings import DamagedBy, ErrorOf, PredictionIs


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
