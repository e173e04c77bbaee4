"""Readings at which single rules of an arbiter matter: without one it would choose something else.

Changes of choice that are looked for along lines miss a rule that holds in a narrow strip, or with
several readings at certain values only. Here readings are drawn inside the boxes of each rule,
between the thresholds of all of them.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from runtime.arbiter import Arbiter, Read
from runtime.arrays import Array, Booleans, Integers
from verifier.deciding.boxes import HIGHEST, LOWEST, Box, boxes_of
from verifier.deciding.conditions import condition_of
from verifier.deciding.reading import values_of
from verifier.deciding.rulings import register_at, rulings_at
from verifier.procedure.candidates import three_digits

DRAWN: Final = 4096
"""Readings that are drawn for each rule."""
MOST: Final = 12
"""So many of them are kept of each rule, at most."""
INSIDE: Final = (0.5, 0.25, 0.75)
"""Where between two thresholds a reading is drawn, the first as often as the others together."""
OFTEN: Final = (0.5, 0.25, 0.25)
EVEN: Final = 0.5
"""As many are drawn so; the others anywhere, for rules over expressions of several readings."""
SEED: Final = 37


def single_rules(arbiter: Arbiter) -> tuple[int, ...]:
    """The places of the rules that it may lack: not its only one, nor a last that always holds."""
    last = len(arbiter.rules) - 1
    if not last:
        return ()
    return tuple(k for k, rule in enumerate(arbiter.rules) if k < last or rule.when is not None)


def without_rule(arbiter: Arbiter, place: int) -> Arbiter:
    """The arbiter that lacks one of its rules."""
    rules = (*arbiter.rules[:place], *arbiter.rules[place + 1 :])
    return replace(arbiter, rules=rules)


def mattering_rules(arbiter: Arbiter, rows: Array) -> Booleans:
    """At which readings (N, m) each of its single rules matters: (N, R)."""
    chosen = _chosen(arbiter, rows)
    lacking = (without_rule(arbiter, place) for place in single_rules(arbiter))
    columns = [chosen != _chosen(each, rows) for each in lacking]
    return np.stack(columns, axis=1) if columns else np.zeros((len(rows), 0), np.bool_)


def own_readings(arbiter: Arbiter) -> tuple[Array, ...]:
    """For each of its single rules readings (K, m) at which it matters, the widest gaps first."""
    values = values_of(arbiter)
    known = [boxes_of(condition_of(rule.when), values) for rule in arbiter.rules]
    every = [box for boxes in known for box in boxes or ()]
    cuts = [_cuts(read, every) for read in arbiter.reads]
    chance = np.random.Generator(np.random.Philox(SEED))
    found = []
    for place in single_rules(arbiter):
        rows, gaps = _drawn(arbiter.reads, cuts, known[place] or ({},), chance)
        good = _chosen(arbiter, rows) != _chosen(without_rule(arbiter, place), rows)
        order = np.argsort(-gaps[good], kind="stable")
        kept = list(dict.fromkeys(map(tuple, rows[good][order].tolist())))[:MOST]
        found.append(np.array(kept).reshape(-1, len(arbiter.reads)))
    return tuple(found)


def _chosen(arbiter: Arbiter, rows: Array) -> Integers:
    """What is chosen (N,) at readings (N, m) where no rule has held before."""
    register = np.tile(register_at(arbiter, {}), (len(rows), 1))
    for column, read in enumerate(arbiter.reads):
        register[:, arbiter.register.index(read.name)] = rows[:, column]
    return np.array([each.choices[-1] for each in rulings_at(arbiter, register)])


def _cuts(read: Read, boxes: Sequence[Box]) -> Array:
    """The ends of its domain, and all thresholds between them."""
    ends = [number for box in boxes for number, _ in box.get(read.name, ())]
    inside = [each for each in ends if read.low < each < read.high]
    return np.unique([read.low, read.high, *inside])


def _drawn(
    reads: Sequence[Read],
    cuts: Sequence[Array],
    boxes: Sequence[Box],
    chance: np.random.Generator,
) -> tuple[Array, Array]:
    """Readings (N, m) in the boxes, and the narrowest gap (N,) that one stands in, as a share."""
    each = -(-DRAWN // len(boxes))
    rows, gaps = [], []
    for box in boxes:
        pairs = zip(reads, cuts, strict=True)
        columns = [_of_read(read, own, box, each, chance) for read, own in pairs]
        rows.append(np.stack([values for values, _ in columns], axis=1))
        gaps.append(np.min([widths for _, widths in columns], axis=0))
    return np.concatenate(rows), np.concatenate(gaps)


def _of_read(
    read: Read, cuts: Array, box: Box, count: int, chance: np.random.Generator
) -> tuple[Array, Array]:
    """Values (N,) of one reading that lie in the box, and how wide the gaps are: shares."""
    if read.values:
        return chance.integers(0, len(read.values), count).astype(np.float64), np.ones(count)
    low, high = box.get(read.name, (LOWEST, HIGHEST))
    within = (cuts[:-1] >= low[0]) & (cuts[1:] <= high[0])
    below, above = cuts[:-1][within], cuts[1:][within]
    if not len(below):
        return np.full(count, np.clip(low[0], read.low, read.high)), np.zeros(count)
    gap = chance.integers(0, len(below), count)
    is_even = chance.random(count) < EVEN
    share = np.where(is_even, chance.choice(INSIDE, count, p=OFTEN), chance.random(count))
    exact = below[gap] + share * (above[gap] - below[gap])
    short = np.array([three_digits(value, read.unit.scale) for value in exact.tolist()])
    is_inside = (below[gap] < short) & (short < above[gap])
    widths = (above[gap] - below[gap]) / (read.high - read.low)
    return np.where(is_inside, short, exact), widths
