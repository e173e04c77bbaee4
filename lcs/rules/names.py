"""What the inputs and the actions of rules are called."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.rules.table import RuleTable


@final
@dataclass(frozen=True, slots=True)
class Names:
    """The inputs, and the actions' names, in the order of a table's columns and indices.

    case: what a rule was right or wrong in, one of them: "showing" where a row is shown again.
    right: the word for a rule that was right: "true" where nothing was earned.
    """

    inputs: tuple[Input, ...]
    actions: tuple[str, ...]
    case: str = "case"
    right: str = "right"


def plain_names(table: RuleTable) -> Names:
    """x1, x2, ... and action 0, action 1, ...: for rules of which nobody said more."""
    inputs = tuple(Input(f"x{i + 1}") for i in range(table.lower.shape[1]))
    return Names(inputs, tuple(f"action {a}" for a in range(table.actions)))


def names_for(table: RuleTable, inputs: Sequence[Input], actions: Sequence[str]) -> Names:
    """Names that fit a table.

    Raises:
        LearnerError: there are more or fewer than the table has.
    """
    for what, given, needed in (
        ("inputs", len(inputs), table.lower.shape[1]),
        ("actions", len(actions), table.actions),
    ):
        if given != needed:
            raise LearnerError(f"these rules have {needed} {what}, and {given} names were given")
    return Names(tuple(inputs), tuple(actions))
