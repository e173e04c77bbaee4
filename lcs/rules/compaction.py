"""A small set of rules that says what a large one said, on the examples given.

A rule set is a two-level cover with a don't-care set, so the steps are those of Espresso (Brayton
et al. 1984): each rule is widened against the examples of other levels, until no interval can take
in more; then the fewest boxes are chosen that hold what was held. A box that can't be widened in
any input has no hull with a neighbor that is free of wrong examples, so merging is part of it.
"""

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Booleans, Integers
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.rules.candidates import Candidates, Examples, counts, denoised, grown
from lcs.rules.choosing import chosen, settle
from lcs.rules.deciding import Decisions, boxes_hold, columns_of, decide
from lcs.rules.experience import Accuracy, Experience, accuracy, nearest_level
from lcs.rules.parts import in_range, joined, rules_of
from lcs.rules.table import RuleTable

PASSES: Final = 10
"""At most; each but the last makes the rules fewer or more right."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Compacted:
    """The small set, and what it cost.

    table: its counts of right and wrong are of the examples given, and weight is the odds of being
    right, (right + 1) / (wrong + 1); a table that can't be made better is left as it was. Its known
    range holds all examples. rules_before: how many there were; idle: how many of those
    held on no example. before, after: on the examples.
    """

    table: RuleTable
    rules_before: int
    idle: int
    before: Accuracy
    after: Accuracy

    def __str__(self) -> str:
        return (
            f"{self.rules_before} rules, of which {self.idle} held on no example, became "
            f"{len(self.table)}. "
            f"Right reward expected: {self.before.expected:.2%} before, {self.after.expected:.2%} "
            f"after; no rule for some action: {self.before.uncovered:.2%} before, "
            f"{self.after.uncovered:.2%} after."
        )


def compact(
    table: RuleTable, seen: Experience, *, noise: float = 0.0, few_digits: bool = True
) -> Compacted:
    """Few rules that hold wherever the table's held on the examples, and are as right there.

    Without noise no example that was rightly expected is wrong after it, and what was expected
    wrongly is put right. With it, levels are first made those of boxes that hold more of one level
    than noise can, so that what is wrong by chance is passed over.

    Args:
        table: the rules; predictions are read as the nearest reward level.
        seen: examples. An action's reward that is not known asks for cover only.
        noise: the share of wrong rewards, below 0.5.
        few_digits: bounds are the shortest numbers that keep each example on its side, else the
            middle between the examples.

    Raises:
        LearnerError: the rewards are no levels, noise is out of range, or inputs are of another
            size than the rules'.
    """
    if not 0.0 <= noise < 0.5:
        raise LearnerError(f"noise is a share of rewards, from 0 to below 0.5; got {noise}")
    if seen.rewards.shape[1] != table.actions:
        raise LearnerError(f"{table.actions} actions need as many columns of rewards")
    if len(table) == 0:
        return Compacted(table, 0, 0, accuracy(table, seen), accuracy(table, seen))
    first = _in_range_of(table, seen.inputs)
    before = now = accuracy(table, seen)
    kept = first
    for _ in range(PASSES):
        small = _passed(kept, seen, noise, few_digits=few_digits)
        after = accuracy(small, seen)
        is_fewer = len(small) < len(kept)
        if not is_fewer and (noise > 0.0 or after.expected <= now.expected):
            break
        kept, now = small, after
    idle = int((~boxes_hold(first.lower, first.upper, first.high, seen.inputs).any(axis=1)).sum())
    return Compacted(kept, len(table), idle, before, accuracy(kept, seen))


def _in_range_of(table: RuleTable, inputs: Array) -> RuleTable:
    """The rules with a known range that holds all inputs (T, n)."""
    ends = zip(inputs.min(axis=0).tolist(), inputs.max(axis=0).tolist(), strict=True)
    return in_range(table, [Input("", low=low, high=high) for low, high in ends])


def _passed(table: RuleTable, seen: Experience, noise: float, *, few_digits: bool) -> RuleTable:
    """One pass: grow from the rules, choose, snap."""
    levels, said = seen.levels, decide(table, seen.inputs)
    parts = []
    for action in range(table.actions):
        rules = rules_of(table, table.action == action)
        level = nearest_level(rules.prediction, levels)
        examples, to_cover = _examples(table, seen, said, levels, action)
        if noise > 0.0:
            examples = denoised(rules, level, examples, to_cover, noise)
        found = grown(rules, level, examples, to_cover)
        kept = chosen(found, examples, to_cover)
        settle(found, kept, examples, few_digits=few_digits)
        parts.append(_as_rules(found, kept, examples, table, action, levels))
    return joined(parts)


def _examples(
    table: RuleTable, seen: Experience, said: Decisions, levels: Array, action: int
) -> tuple[Examples, Booleans]:
    """The examples of an action, equal inputs as one, and which have to be covered."""
    told = nearest_level(seen.rewards[:, action], levels)
    believed = nearest_level(said.expected[:, action], levels)
    x, level, is_told, count = _equal_as_one(seen.inputs, told, believed, len(levels))
    covered = decide(table, x).voters[:, action] > 0
    inside = ((x >= table.low) & (x <= table.high)).all(axis=1) & (level >= 0)
    x, level, is_told, count = x[inside], level[inside], is_told[inside], count[inside]
    order = np.ascontiguousarray(np.argsort(x, axis=0, kind="stable").T)
    examples = Examples(x, columns_of(x), level, is_told, count, order, table.low, table.high)
    return examples, covered[inside]


def _equal_as_one(
    inputs: Array, told: Integers, believed: Integers, levels: int
) -> tuple[Array, Integers, Booleans, Integers]:
    """Different inputs, the level of most rewards of each, if any is known, and how many.

    Where two levels are as frequent, the one that is believed; where no reward is known, too.
    """
    x, place = np.unique(inputs, axis=0, return_inverse=True)
    place = place.reshape(-1)
    votes = np.zeros((len(x), levels))
    known = told >= 0
    np.add.at(votes, (place[known], told[known]), 1.0)
    count = np.maximum(votes.max(axis=1), 1.0).astype(np.int64)
    has_told = votes.any(axis=1)
    sure = believed >= 0
    votes[place[sure], believed[sure]] += 0.5
    level: Integers = np.where(votes.any(axis=1), votes.argmax(axis=1), -1)
    return np.ascontiguousarray(x), level, np.asarray(has_told, np.bool_), count


def _as_rules(
    found: Candidates,
    kept: Integers,
    seen: Examples,
    table: RuleTable,
    action: int,
    levels: Array,
) -> RuleTable:
    """The kept candidates as rules of an action."""
    lower, upper = found.boxes(kept, seen.x.shape[1])
    level = np.array(found.level, np.int64)[kept]
    right, wrong = counts(lower, upper, level, seen)
    return RuleTable(
        actions=table.actions,
        action=np.full(len(kept), action),
        lower=lower,
        upper=upper,
        prediction=levels[level],
        weight=(right + 1.0) / (wrong + 1.0),
        right=right,
        wrong=wrong,
        low=table.low,
        high=table.high,
    )
