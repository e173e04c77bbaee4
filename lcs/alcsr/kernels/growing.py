"""Bodies that grow in a land that remembers, before they live and again when they have eaten.

Dimension by dimension a body takes the interval around its seed that holds most food of its own
type, less a penalty for each other one. The penalty rises from about what chance would give, so
that a body finds its shape before it shuns the last wrong food. With n dimensions and N foods one
pass costs n N steps: foods are kept in order by each input.
"""

import numpy as np

from lcs.alcsr.kernels.layout import Land, Numbers, Scratch
from lcs.alcsr.kernels.remembering import (
    count_outside,
    known,
    meals_in,
    penalty_of,
    share_of,
    top_of,
)
from lcs.arrays import Array, Counts, Integers
from lcs.compiled import part

SHAPING = np.array([0.9, 1.0, 1.2, 1.5, 2.0, 3.0, 5.0])
"""The penalties by which a sprout takes shape, where half of all food is of its type."""

RESHAPING = np.array([1.5, 2.0, 4.0])
SMOOTHING = np.array([3.0])
"""The same for a body that was pulled out of shape, and for one that only grows on."""

LEAST, MOST = 0.1, 10.0
"""By how much penalties are scaled for rare and for common food."""


@part
def sprout(
    land: Land,
    numbers: Numbers,
    scratch: Scratch,
    a: int,
    x: Array,
    reward: float,
    rng: np.random.Generator,
) -> tuple[int, int, float]:
    """The best of `sprouts` bodies grown around x, in `scratch.body`.

    Returns its right and its wrong foods, and the evidence for it, in right foods.
    """
    body = scratch.body
    share = share_of(land, a, reward)
    final = penalty_of(share, land.noise[a])
    best = -np.inf
    best_right, best_wrong = 0, 0
    for _ in range(numbers.sprouts):
        for i in range(x.size):
            reach = numbers.seeding * (land.high[i] - land.low[i])
            body[0, i] = max(land.low[i], x[i] - rng.random() * reach)
            body[1, i] = min(land.high[i], x[i] + rng.random() * reach)
        right, wrong = shape(land, scratch, a, x, reward, SHAPING, 2, scale(share), final, rng)
        if right - final * wrong > best:
            best, best_right, best_wrong = right - final * wrong, right, wrong
            body[2] = body[0]
            body[3] = body[1]
    body[0] = body[2]
    body[1] = body[3]
    return best_right, best_wrong, best


@part
def grow_on(
    land: Land,
    scratch: Scratch,
    a: int,
    x: Array,
    reward: float,
    right: int,
    wrong: int,
    rng: np.random.Generator,
) -> tuple[int, int]:
    """Grow `scratch.body`, which had so many foods, around x; kept is what has no less evidence.

    Once it grows from where it is, and once with one or two conditions dropped.
    """
    body = scratch.body
    share = share_of(land, a, reward)
    final = penalty_of(share, land.noise[a])
    body[2] = body[0]
    body[3] = body[1]
    more, worse = shape(land, scratch, a, x, reward, SMOOTHING, 1, scale(share), final, rng)
    if more - final * worse >= right - final * wrong:
        right, wrong = more, worse
        body[2] = body[0]
        body[3] = body[1]
    body[0] = body[2]
    body[1] = body[3]
    for _ in range(1 + int(rng.random() * 2)):
        i = int(rng.random() * x.size)
        body[0, i] = land.low[i]
        body[1, i] = land.high[i]
    more, worse = shape(land, scratch, a, x, reward, RESHAPING, 2, scale(share), final, rng)
    if more - final * worse > right - final * wrong:
        return more, worse
    body[0] = body[2]
    body[1] = body[3]
    return right, wrong


@part
def scale(share: float) -> float:
    """Where food of its type is rare, most of what is around is wrong by chance."""
    return float(min(MOST, max(LEAST, share / max(1.0 - share, 1e-9))))


@part
def shape(
    land: Land,
    scratch: Scratch,
    a: int,
    x: Array,
    reward: float,
    penalties: Array,
    passes: int,
    scaled: float,
    final: float,
    rng: np.random.Generator,
) -> tuple[int, int]:
    """Grow `scratch.body` by rising penalties below the final one, then by that in some passes.

    Returns how many right and wrong foods it holds.
    """
    total = known(land, a)
    few = land.sample[a, :, :total]
    lower, upper = scratch.body[0], scratch.body[1]
    count_outside(land, a, few.shape[1], lower, upper, scratch.outside)
    for penalty in penalties:
        if penalty * scaled < final:
            grow(land, scratch, a, few, x, reward, penalty * scaled, rng)
    count_outside(land, a, total, lower, upper, scratch.outside)
    for _ in range(passes):
        grow(land, scratch, a, land.order[a, :, :total], x, reward, final, rng)
    return meals_in(land, a, reward, scratch.outside)


@part
def grow(
    land: Land,
    scratch: Scratch,
    a: int,
    orders: Integers,
    x: Array,
    reward: float,
    penalty: float,
    rng: np.random.Generator,
) -> None:
    """One pass over all dimensions, in random order, among foods in their orders (n, N)."""
    axes = scratch.axes
    for i in range(axes.size - 1, 0, -1):
        j = int(rng.random() * (i + 1))
        axes[i], axes[j] = axes[j], axes[i]
    for i in axes:
        grow_along(land, scratch, a, i, orders[i], x[i], reward, penalty)


@part
def grow_along(
    land: Land,
    scratch: Scratch,
    a: int,
    i: int,
    order: Integers,
    seed: float,
    reward: float,
    penalty: float,
) -> None:
    """The best interval around the seed in dimension i, among the first foods in their order by it.

    Bounds stand midway to what is left out.
    """
    values, signs = scratch.values, scratch.signs
    lower, upper, high = scratch.body[0], scratch.body[1], land.high[i]
    foods, rewards, outside = land.foods[a, i], land.rewards[a], scratch.outside
    low, top = lower[i], top_of(upper[i], high)
    start, stop = places_below(foods, order, low), places_below(foods, order, top)
    picked = scratch.picked
    count = pick(order[:start], outside, 1, picked, 0)
    count = pick(order[start:stop], outside, 0, picked, count)
    count = pick(order[stop:], outside, 1, picked, count)
    middle = 0
    for j in range(count):
        k = picked[j]
        values[j] = foods[k]
        signs[j] = 1.0 if rewards[k] == reward else -penalty
        middle += foods[k] < seed
    lower[i] = end_below(values, signs, middle, seed, land.low[i])
    upper[i] = end_above(values, signs, middle, count, seed, high)
    new_start = places_below(foods, order, lower[i])
    new_stop = places_below(foods, order, top_of(upper[i], high))
    shift(order[start:new_start], outside, 1)
    shift(order[new_start:start], outside, -1)
    shift(order[new_stop:stop], outside, 1)
    shift(order[stop:new_stop], outside, -1)


@part
def pick(order: Integers, outside: Counts, asked: int, picked: Integers, count: int) -> int:
    """Add those of the foods that lie outside in so many dimensions; how many there are now.

    Each is written and only counted if it is one of them: no branch to guess, a third of the time.
    """
    for k in order:
        picked[count] = k
        count += outside[k] == asked
    return count


@part
def shift(order: Integers, outside: Counts, more: int) -> None:
    """Foods that came to lie outside in one dimension more, or in one less."""
    for k in order:
        outside[k] += more


@part
def places_below(foods: Array, order: Integers, bound: float) -> int:
    """How many foods, in their order, are below a bound."""
    first, last = 0, order.size
    while first < last:
        middle = (first + last) // 2
        if foods[order[middle]] < bound:
            first = middle + 1
        else:
            last = middle
    return first


@part
def end_above(
    values: Array, signs: Array, middle: int, count: int, seed: float, high: float
) -> float:
    """The upper bound with the highest sum of signs from the seed on; of equal ones the furthest.

    values, signs: so many, in order; those from `middle` on are not below the seed. A bound parts
    no foods of the same value.
    """
    total, best, after, any_right = 0.0, 0.0, middle, False
    for j in range(middle, count):
        total += signs[j]
        any_right = any_right or signs[j] > 0.0
        if j + 1 == count or values[j + 1] > values[j]:
            if (any_right and total >= best) or values[j] == seed:
                best, after = total, j + 1
            any_right = False
    if after == count:
        return high
    last = values[after - 1] if after > middle else seed
    return float(max(0.5 * (last + values[after]), np.nextafter(last, np.inf)))


@part
def end_below(values: Array, signs: Array, middle: int, seed: float, low: float) -> float:
    """The lower bound with the highest sum of signs below the seed, as `end_above`."""
    total, best, first, any_right = 0.0, 0.0, middle, False
    for j in range(middle - 1, -1, -1):
        total += signs[j]
        any_right = any_right or signs[j] > 0.0
        if j == 0 or values[j - 1] < values[j]:
            if any_right and total >= best:
                best, first = total, j
            any_right = False
    if first == 0:
        return low
    inner = values[first] if first < middle else seed
    beyond = values[first - 1]
    return float(max(0.5 * (inner + beyond), min(inner, np.nextafter(beyond, np.inf))))
