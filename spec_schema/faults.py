"""What is wrong with a small text inside a spec (an expression, a unit), before it has a place."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True, order=True)
class Fault:
    """One mistake in the characters `start` up to but not including `end` of a text."""

    start: int
    end: int
    code: str
    message: str
    help: str = ""


@final
class ExpressionError(Exception):
    """An expression that can't be used, with all its faults in the order of the text."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(sorted(set(faults)))
        super().__init__("; ".join(fault.message for fault in self.faults))


@final
class UnitFault(Exception):  # noqa: N818  # what it carries is a fault
    """A unit or a quantity that can't be used, and why."""

    def __init__(self, fault: Fault) -> None:
        self.fault = fault
        super().__init__(fault.message)
