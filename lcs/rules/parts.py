"""Some rules of a table, several tables as one, and the range that rules are known in."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from lcs.arrays import Booleans, Integers
from lcs.inputs import Input
from lcs.rules.table import RuleTable


def rules_of(table: RuleTable, those: Booleans | Integers) -> RuleTable:
    """Some rules of a table."""
    return RuleTable(
        actions=table.actions,
        action=table.action[those],
        lower=table.lower[those],
        upper=table.upper[those],
        prediction=table.prediction[those],
        weight=table.weight[those],
        right=table.right[those],
        wrong=table.wrong[those],
        low=table.low,
        high=table.high,
    )


def joined(tables: list[RuleTable]) -> RuleTable:
    """The rules of several tables over the same inputs."""
    columns = ("action", "lower", "upper", "prediction", "weight", "right", "wrong")
    first = tables[0]
    return RuleTable(
        actions=first.actions,
        low=first.low,
        high=first.high,
        **{name: np.concatenate([getattr(each, name) for each in tables]) for name in columns},
    )


def in_range(table: RuleTable, inputs: Sequence[Input]) -> RuleTable:
    """The rules with the range that inputs are declared to have, where it is the wider one.

    Bounds at the end of the old range, which were no condition, are none in the new one.
    """
    old_low, old_high = table.low, table.high
    declared_low = [np.inf if each.low is None else each.low for each in inputs]
    declared_high = [-np.inf if each.high is None else each.high for each in inputs]
    low, high = np.minimum(old_low, declared_low), np.maximum(old_high, declared_high)
    return dataclasses.replace(
        table,
        lower=np.where(table.lower <= old_low, low, table.lower),
        upper=np.where(table.upper >= old_high, high, table.upper),
        low=low,
        high=high,
    )
