"""Compile every kernel once, with progress: the list of what there is to compile stands here."""

from collections.abc import Callable

import numpy as np

from runtime.interpolation import lookup, lookup_jacobian, tabulate
from runtime.kernels.cache import is_warm, mark_warm
from runtime.kernels.interpolate import block_address
from runtime.program import Axis, Method

__all__ = ["is_warm", "warm"]

TABLE = tabulate(np.zeros((2, 1)), (Axis("x", 0.0, 1.0, 2, periodic=False),), Method.LINEAR)

KERNELS: tuple[tuple[str, Callable[[], object]], ...] = (
    ("interpolation", block_address),
    ("table lookup", lambda: lookup(TABLE, [0.5])),
    ("table derivatives", lambda: lookup_jacobian(TABLE, [0.5])),
)
"""Names, and small calls that compile; each kernel is compiled for one kind of arguments only."""


def warm(progress: Callable[[str, int, int], None]) -> None:
    """Compile and keep every kernel; `progress(name, done, total)` is called before each."""
    for done, (name, call) in enumerate(KERNELS):
        progress(name, done, len(KERNELS))
        call()
    progress("", len(KERNELS), len(KERNELS))
    mark_warm()
