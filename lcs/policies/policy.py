"""What a policy is: it says what to do at places."""

from typing import Protocol

from lcs.arrays import Array, Integers


class Policy(Protocol):
    """Says which action to take."""

    def decide(self, inputs: Array) -> Integers:
        """The actions (T,) at inputs (T, n)."""
        ...
