"""What inputs are called, and what they may be."""

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True)
class Input:
    """An input: its name, its unit ("" for none), and its range or its values.

    low, high: the declared range; None where it is what comes. values: of a discrete input, which
    learners see as the index into them.
    """

    name: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    values: tuple[str, ...] = ()
