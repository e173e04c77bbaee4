"""Rules as sentences: when this and that, then so, and how often that was right."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.inputs import Input
from lcs.rules.deciding import decide, matches
from lcs.rules.digits import just_below
from lcs.rules.names import Names
from lcs.rules.readable import readable
from lcs.rules.table import RuleTable

YES_OR_NO: Final = ("no", "yes")
"""The values of an input whose name says all, as "color is red"."""


@final
@dataclass(frozen=True, slots=True)
class Sentence:
    """A rule in words. rule: its index in the table."""

    rule: int
    when: str
    then: str
    evidence: str

    def __str__(self) -> str:
        return f"{self.when}: {self.then} ({self.evidence})"


def in_words(table: RuleTable, names: Names, inputs: Array | None = None) -> list[Sentence]:
    """The rules as sentences, by action, and within each by how much they decide.

    inputs (T, n): examples. What a rule decides is counted on them, and bounds have as few digits
    as leave each of them on its side. Without them, what counts are a rule's own cases.
    """
    short = readable(table, inputs)
    share = shares(table, inputs)
    order = np.lexsort((np.arange(len(table)), -share, -table.prediction, table.action))
    levels = np.unique(table.prediction)
    return [sentence(short, int(r), names, levels) for r in order]


def sentence(table: RuleTable, rule: int, names: Names, levels: Array) -> Sentence:
    """One rule in words, its bounds as they are; `readable` makes them short.

    levels: all predictions of the table that the rule is from, ascending.
    """
    return Sentence(
        rule,
        _when(conditions(table, rule, names)),
        outcome(table, rule, names, levels),
        evidence(table, rule, names.case, names.right),
    )


def _when(stated: Sequence[str]) -> str:
    return f"when {' and '.join(stated)}" if stated else "always"


def conditions(table: RuleTable, rule: int, names: Names) -> list[str]:
    """What a rule asks for, input by input; inputs that it asks nothing of are left out."""
    found = []
    for i, each in enumerate(names.inputs):
        lower, upper = float(table.lower[rule, i]), float(table.upper[rule, i])
        low, high = float(table.low[i]), float(table.high[i])
        if lower > low or upper < high:
            found.append(_condition(each, lower, upper, low, high))
    return [each for each in found if each]


def _condition(each: Input, lower: float, upper: float, low: float, high: float) -> str:
    if each.values:
        return values_text(each, lower, upper, high)
    unit = f" {each.unit}" if each.unit else ""
    least, is_open = bound_text(lower)
    most, is_closed = bound_text(upper)
    below = f"{'<=' if is_closed else '<'} {most}{unit}"
    if lower <= low:
        return f"{each.name} {below}"
    if upper >= high:
        return f"{each.name} {'>' if is_open else '>='} {least}{unit}"
    return f"{least}{unit} {'<' if is_open else '<='} {each.name} {below}"


def bound_text(value: float) -> tuple[str, bool]:
    """A bound as text, and whether it stands right above the number that the text says."""
    below = just_below(value)
    return (number(value), False) if below is None else (number(below), True)


def number(value: float) -> str:
    """A number as short as it can be read back."""
    return repr(float(value)).removesuffix(".0")


def reward_text(value: float) -> str:
    """A reward to four significant digits."""
    return number(float(f"{value:.4g}"))


def allowed_values(each: Input, lower: float, upper: float, high: float) -> list[str]:
    """Which values of a discrete input a condition on their indices allows."""
    return [
        value
        for k, value in enumerate(each.values)
        if lower <= k and (k < upper or k == upper == high)
    ]


def values_text(each: Input, lower: float, upper: float, high: float) -> str:
    """What a condition on a discrete input says; "" where it allows all."""
    allowed = allowed_values(each, lower, upper, high)
    if each.values == YES_OR_NO and len(allowed) == 1:
        return each.name if allowed == ["yes"] else _negated(each.name)
    barred = [value for value in each.values if value not in allowed]
    if not barred:
        return ""
    if not allowed:
        return f"{each.name} is none of its values"
    if len(barred) == 1 and len(allowed) > 2:
        return f"{each.name} is not {barred[0]}"
    *most, last = allowed
    return f"{each.name} is {', '.join(most)} or {last}" if most else f"{each.name} is {last}"


def _negated(name: str) -> str:
    return name.replace(" is ", " is not ", 1) if " is " in name else f"not {name}"


def outcome(table: RuleTable, rule: int, names: Names, levels: Array) -> str:
    """What a rule says: an action, "not" an action, or what the action earns.

    Where there are two rewards, the higher one means that the action is right.
    """
    action = names.actions[int(table.action[rule])]
    if len(levels) > 2:
        return f"{action} earns {reward_text(float(table.prediction[rule]))}"
    return action if table.prediction[rule] == levels[-1] else f"not {action}"


def evidence(table: RuleTable, rule: int, case: str = "case", word: str = "right") -> str:
    """How often a rule was right; `word` says that it was."""
    right, cases = int(table.right[rule]), int(table.right[rule] + table.wrong[rule])
    if cases == 0:
        return "never tried"
    if cases == 1:
        return f"{word if right else 'wrong'} in its only {case}"
    if right == cases:
        return f"{word} in all {cases:,} {case}s"
    return f"{word} in {right:,} of {cases:,} {case}s"


def shares(table: RuleTable, inputs: Array | None = None) -> Array:
    """By how much each rule decides (R,): the sum of its shares of the vote for its action.

    inputs (T, n): on which, where its action is the best. Without them, its cases.
    """
    if inputs is None:
        cases: Array = (table.right + table.wrong).astype(np.float64)
        return cases
    held = matches(table, inputs)
    best = decide(table, inputs).best
    found = np.zeros(len(table))
    for action in range(table.actions):
        those: Integers = np.flatnonzero(table.action == action)
        votes = table.weight[those, None] * held[those][:, best == action]
        total = votes.sum(axis=0)
        found[those] = (votes / np.where(total > 0.0, total, 1.0)).sum(axis=1)
    return found
