"""How the learners' kernels are compiled, and where their machine code is kept between runs.

numba notices when the file of a cached function was edited, but not when a function that it calls
was, in another file. So the cache lies in a folder named by a hash of all sources of the kernels.
"""

import hashlib
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final, ParamSpec, TypeVar

import numba
import numba.core.config

P = ParamSpec("P")
R = TypeVar("R")

ROOM: Final = Path(__file__).parent
CONFIG: Any = numba.core.config  # its settings are made at run time, unknown to types
COMPILER: Any = numba  # its types lack some of its options


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that Python calls; its machine code is cached on disk."""
    folder, before = cache_folder(), CONFIG.CACHE_DIR
    CONFIG.CACHE_DIR = str(folder or "")
    try:
        compiled: Callable[P, R] = COMPILER.njit(
            cache=folder is not None, nogil=True, error_model="numpy"
        )(function)
    finally:
        CONFIG.CACHE_DIR = before
    return compiled


def part(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that only kernels call."""
    compiled: Callable[P, R] = COMPILER.njit(
        error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True
    )(function)
    return compiled


@cache
def cache_folder() -> Path | None:
    """The folder of the machine code, made if need be; None where nothing can be kept."""
    base = Path(CONFIG.CACHE_DIR) if CONFIG.CACHE_DIR else Path.home() / ".cache"
    folder = base / "specc" / f"lcs-{source_hash()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        return None


@cache
def source_hash() -> str:
    """A hash of everything that the machine code depends on."""
    digest = hashlib.sha256(f"{sys.version_info[:2]} {numba.__version__}".encode())
    for path in sorted(ROOM.rglob("kernels/*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]
