"""Compile every kernel once, with progress: the list of what there is to compile stands here."""

from collections.abc import Callable

from runtime.kernels.cache import is_warm, mark_warm

__all__ = ["is_warm", "warm"]

KERNELS: tuple[tuple[str, Callable[[], object]], ...] = ()
"""Name and a small call that compiles it."""


def warm(progress: Callable[[str, int, int], None]) -> None:
    """Compile and keep every kernel; `progress(name, done, total)` is called before each."""
    for done, (name, call) in enumerate(KERNELS):
        progress(name, done, len(KERNELS))
        call()
    progress("", len(KERNELS), len(KERNELS))
    mark_warm()
