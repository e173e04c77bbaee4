"""Where the machine code of the senses' kernels is kept: in a folder of its own.

Its name is a hash of the sources here, inside the folder of the other kernels, whose tools these
use: so an edit here leaves the other kernels compiled.
"""

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from runtime.kernels.cache import COMPILER, CONFIG, cache_folder

P = ParamSpec("P")
R = TypeVar("R")

SOURCES = Path(__file__).parent
_CALLED_BY_C: list[Any] = []
"""Machine code that is called by address must outlive its callers."""


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that Python calls; its machine code is cached on disk.

    No fast mathematics and no threads: the same arguments give the same bits.
    """
    with _kept() as possible:
        compiled: Callable[P, R] = COMPILER.njit(cache=possible, nogil=True, error_model="numpy")(
            function
        )
    return compiled


def address_for_c(function: Callable[..., None], signature: str) -> int:
    """Compile a function that C calls by its address; its machine code is cached on disk."""
    with _kept() as possible:
        compiled = COMPILER.cfunc(signature, cache=possible, error_model="numpy")(function)
    _CALLED_BY_C.append(compiled)
    address: int = compiled.address
    return address


@contextmanager
def _kept() -> Iterator[bool]:
    """Let numba cache in the folder of these kernels; whether it can."""
    before = CONFIG.CACHE_DIR
    folder = senses_folder()
    CONFIG.CACHE_DIR = str(folder or "")
    try:
        yield folder is not None
    finally:
        CONFIG.CACHE_DIR = before


@cache
def senses_folder() -> Path | None:
    """The folder of this machine code; None where nothing can be kept."""
    above = cache_folder()
    if above is None:
        return None
    digest = hashlib.sha256()
    for path in sorted(SOURCES.glob("*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return above / f"senses-{digest.hexdigest()[:16]}"
