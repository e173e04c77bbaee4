"""How far the judge has come, for those who wait."""

from collections.abc import Callable
from typing import TypeAlias

Watch: TypeAlias = Callable[[float], None]
"""Told which share of one claim's work is done."""


def unwatched(_share: float) -> None:
    """Nobody waits for the claim."""


def part(watch: Watch, first: float, last: float) -> Watch:
    """A watch over the part of the work between two shares of it."""

    def told(share: float) -> None:
        watch(first + (last - first) * min(max(share, 0.0), 1.0))

    return told
