"""How far work has come that takes long, for those who wait."""

from collections.abc import Callable
from typing import TypeAlias

Progress: TypeAlias = Callable[[str, int, int], None]
"""Is told what is done, how much of it, and of how much."""


def in_silence(_what: str, _done: int, _of: int) -> None:
    """Nobody waits."""
