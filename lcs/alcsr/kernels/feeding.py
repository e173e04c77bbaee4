"""Accuracy pressure (4.3.3), deaths and fights among those that were fed (4.3.4)."""

from lcs.alcsr.kernels.burying import bury
from lcs.alcsr.kernels.layout import (
    EATEN,
    POISONED,
    STARVED,
    Corpses,
    Land,
    Numbers,
    Rules,
    Scratch,
)
from lcs.alcsr.kernels.matching import can_breed, is_mature
from lcs.arrays import Array
from lcs.compiled import part


@part
def error_of(numbers: Numbers, prediction: float, reward: float) -> float:
    """The prediction error, as a fraction of what was returned."""
    if numbers.error_of == 1 or reward == 0.0:
        return abs(prediction - reward) / numbers.reward_range
    return abs(prediction - reward) / abs(reward)


@part
def feed(
    rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, a: int, x: Array, reward: float
) -> None:
    """Share a unit of food among the action set of landscape a: the wrong type poisons."""
    share = float(scratch.fed_count[a])
    for j in range(scratch.fed_count[a]):
        rules.fed_at[a, scratch.fed[a, j]] = land.met[a]
        eat(rules, numbers, a, scratch.fed[a, j], x, reward, share)


@part
def eat(
    rules: Rules, numbers: Numbers, a: int, k: int, x: Array, reward: float, share: float
) -> None:
    """Rule k eats its part of the food."""
    rules.was_able[a, k] = can_breed(rules, numbers, a, k)
    error = error_of(numbers, rules.prediction[a, k], reward)
    gain = (1.0 - error * numbers.error_cost) / share - numbers.metabolism_cost
    rules.strength[a, k] += gain
    rules.experience[a, k] += 1
    is_wrong = error > numbers.damaged_error
    sticks = numbers.damaged_by == 1 and rules.damaged[a, k]
    rules.damaged[a, k] = is_wrong or sticks
    if is_wrong:
        rules.wrong[a, k] += 1
        move(rules.wrong_center[a, k], x, rules.wrong[a, k])
    else:
        rules.right[a, k] += 1
        move(rules.right_center[a, k], x, rules.right[a, k])
    if numbers.prediction_is == 1:
        rules.prediction[a, k] += numbers.learning_rate * (reward - rules.prediction[a, k])


@part
def move(center: Array, x: Array, count: int) -> None:
    """The mean of `count` points, the last of which is x."""
    for i in range(x.size):
        center[i] += (x[i] - center[i]) / count


@part
def die(
    rules: Rules, corpses: Corpses, land: Land, numbers: Numbers, scratch: Scratch, a: int
) -> None:
    """Remove the starved among those fed; the poisoned of them go into the mausoleum."""
    for j in range(scratch.fed_count[a]):
        k = scratch.fed[a, j]
        strength = rules.strength[a, k]
        if strength < 0.0 or (numbers.starved_at == 0 and strength == 0.0):
            scratch.dead[k] = True
            if rules.damaged[a, k]:
                bury(rules, corpses, land, numbers, scratch, a, k)
                scratch.tally[POISONED] += 1
            else:
                scratch.tally[STARVED] += 1
    remove(rules, scratch, a)


@part
def remove(rules: Rules, scratch: Scratch, a: int) -> None:
    """Take the dead, all of them fed, out of the rules and of the action set."""
    fed = scratch.fed[a]
    kept = 0
    for j in range(scratch.fed_count[a]):
        if not scratch.dead[fed[j]]:
            fed[kept] = fed[j]
            kept += 1
    scratch.fed_count[a] = kept
    for k in range(rules.living[a] - 1, -1, -1):
        if scratch.dead[k]:
            scratch.dead[k] = False
            last = rules.living[a] - 1
            rules.living[a] = last
            if k != last:
                place(rules, a, last, k)
                for j in range(kept):
                    if fed[j] == last:
                        fed[j] = k


@part
def place(rules: Rules, a: int, source: int, target: int) -> None:
    """Copy a rule."""
    rules.lower[a, target] = rules.lower[a, source]
    rules.upper[a, target] = rules.upper[a, source]
    rules.prediction[a, target] = rules.prediction[a, source]
    rules.strength[a, target] = rules.strength[a, source]
    rules.experience[a, target] = rules.experience[a, source]
    rules.volume[a, target] = rules.volume[a, source]
    rules.right[a, target] = rules.right[a, source]
    rules.wrong[a, target] = rules.wrong[a, source]
    rules.right_center[a, target] = rules.right_center[a, source]
    rules.wrong_center[a, target] = rules.wrong_center[a, source]
    rules.damaged[a, target] = rules.damaged[a, source]
    rules.was_able[a, target] = rules.was_able[a, source]
    rules.fed_at[a, target] = rules.fed_at[a, source]
    rules.grows_at[a, target] = rules.grows_at[a, source]
    rules.meals[a, target] = rules.meals[a, source]
    rules.poisoned[a, target] = rules.poisoned[a, source]
    rules.core_meals[a, target] = rules.core_meals[a, source]
    rules.core_wrong[a, target] = rules.core_wrong[a, source]


@part
def fight(rules: Rules, numbers: Numbers, scratch: Scratch, a: int) -> None:
    """Mature rules eat the weaker ones of their sub-species that they engulf."""
    fed, order, count = scratch.fed[a], scratch.order, scratch.fed_count[a]
    for j in range(count):
        at = j
        if numbers.first_aggressor == 0:
            while at > 0 and rules.volume[a, order[at - 1]] < rules.volume[a, fed[j]]:
                order[at] = order[at - 1]
                at -= 1
        order[at] = fed[j]
    any_dead = False
    for j in range(count):
        aggressor = order[j]
        if scratch.dead[aggressor] or not is_mature(rules, numbers, a, aggressor):
            continue
        for victim in fed[:count]:
            if not scratch.dead[victim] and is_eaten(rules, numbers, a, aggressor, victim):
                scratch.dead[victim] = True
                scratch.tally[EATEN] += 1
                any_dead = True
    if any_dead:
        remove(rules, scratch, a)


@part
def is_eaten(rules: Rules, numbers: Numbers, a: int, aggressor: int, victim: int) -> bool:
    """Whether an attack succeeds."""
    if victim == aggressor or rules.prediction[a, victim] != rules.prediction[a, aggressor]:
        return False
    if not rules.strength[a, aggressor] > rules.strength[a, victim]:
        return False
    if not is_mature(rules, numbers, a, victim):
        return False
    for i in range(rules.lower.shape[2]):
        if rules.lower[a, aggressor, i] > rules.lower[a, victim, i]:
            return False
        if rules.upper[a, aggressor, i] < rules.upper[a, victim, i]:
            return False
    return True
