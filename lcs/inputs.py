"""What inputs are called, and what they may be."""

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True)
class Input:
    """An input: its name, its unit ("" for none), and its range or its values.

    low, high: the declared range; None where it is what comes. values: of a discrete input, which
    learners see as the index into them. is_ordered: whether the order of the values means
    something; if not, `lcs.encoding` makes an input of 0 and 1 of each value.
    """

    name: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    values: tuple[str, ...] = ()
    is_ordered: bool = False
