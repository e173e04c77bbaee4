"""Where the machine code of the senses' kernels is kept: in a folder of its own.

Its name is a hash of the sources here, inside the folder of the other kernels, whose tools these
use: so an edit here leaves the other kernels compiled.
"""

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import ParamSpec, TypeVar

from runtime.kernels.cache import COMPILER, CONFIG, cache_folder

P = ParamSpec("P")
R = TypeVar("R")

SOURCES = Path(__file__).parent


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that Python calls; its machine code is cached on disk.

    No fast mathematics and no threads: the same arguments give the same bits.
    """
    before = CONFIG.CACHE_DIR
    folder = senses_folder()
    CONFIG.CACHE_DIR = str(folder or "")
    try:
        compiled: Callable[P, R] = COMPILER.njit(
            cache=folder is not None, nogil=True, error_model="numpy"
        )(function)
    finally:
        CONFIG.CACHE_DIR = before
    return compiled


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
