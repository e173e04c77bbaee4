"""How kernels are compiled, and where their machine code is kept between runs.

numba knows when the file of a cached function was edited, but not when a function in another file
that it calls was. So the cache lies in a folder whose name is a hash of all kernel sources, of the
versions that compile them and of the processor they are compiled for. Folder: `NUMBA_CACHE_DIR`
where the user has set it, else `$XDG_CACHE_HOME/specc`, else `~/.cache/specc`. Where none can be
written, kernels are compiled anew in each process.
"""

import hashlib
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import llvmlite.binding  # type: ignore[import-untyped]  # no stubs
import numba
import numba.core.config

P = ParamSpec("P")
R = TypeVar("R")

CONFIG: Any = numba.core.config  # its settings are made at run time, unknown to types
COMPILER: Any = numba  # its types lack some of its options
SOURCES = Path(__file__).parent
_KEPT: list[Any] = []
"""Machine code that is called by address must outlive its callers."""
UNUSED_AFTER = 30 * 24 * 3600.0
"""Seconds after which the cache of other sources is removed."""


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that Python calls; its machine code is cached on disk."""
    with _cache_in(cache_folder()) as possible:
        compiled: Callable[P, R] = COMPILER.njit(cache=possible, nogil=True, error_model="numpy")(
            function
        )
    return compiled


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function into each kernel that calls it; it has no cache of its own."""
    compiled: Callable[P, R] = COMPILER.njit(
        forceinline=True, error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True
    )(function)
    return compiled


def part(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function that only kernels call: it lacks what a call from Python would need."""
    compiled: Callable[P, R] = COMPILER.njit(
        error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True
    )(function)
    return compiled


def compiled_for_c(function: Callable[..., None], signature: Any) -> int:
    """Compile a function that kernels call by its address; its machine code is cached on disk."""
    with _cache_in(cache_folder()) as possible:
        compiled = COMPILER.cfunc(signature, cache=possible, error_model="numpy")(function)
    _KEPT.append(compiled)
    address: int = compiled.address
    return address


@cache
def cache_folder() -> Path | None:
    """The folder of the kernels' machine code, made if need be; None where nothing can be kept."""
    for base in _bases():
        folder = base / source_hash()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except OSError:
            continue
    return None


@cache
def source_hash() -> str:
    """A hash of everything that the machine code depends on."""
    digest = hashlib.sha256()
    for path in sorted(SOURCES.glob("*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    processor = f"{llvmlite.binding.get_host_cpu_name()} {CONFIG.CPU_NAME} {CONFIG.CPU_FEATURES}"
    versions = f"{sys.version_info[:2]} {numba.__version__} {llvmlite.__version__}"
    digest.update(f"{processor} {versions}".encode())
    return digest.hexdigest()[:16]


def is_warm() -> bool:
    """Whether every kernel was compiled and kept before; costs no compilation."""
    folder = cache_folder()
    return folder is not None and (folder / "warm").exists()


def mark_warm() -> None:
    """Note that every kernel is compiled, and remove caches of other sources not used for long."""
    folder = cache_folder()
    if folder is None:
        return
    (folder / "warm").touch()
    for stamp in folder.parent.glob("[0-9a-f]" * 16 + "/warm"):
        if stamp.stat().st_mtime < time.time() - UNUSED_AFTER:
            shutil.rmtree(stamp.parent, ignore_errors=True)


def _bases() -> Iterator[Path]:
    if CONFIG.CACHE_DIR:
        yield Path(CONFIG.CACHE_DIR) / "specc"
        return
    if home := os.environ.get("XDG_CACHE_HOME"):
        yield Path(home) / "specc"
    try:
        yield Path.home() / ".cache" / "specc"
    except RuntimeError:  # no home folder can be found
        return


@contextmanager
def _cache_in(folder: Path | None) -> Iterator[bool]:
    """Let numba choose `folder` for what is decorated inside; other code's choice is untouched."""
    before = CONFIG.CACHE_DIR
    CONFIG.CACHE_DIR = str(folder or "")
    try:
        yield folder is not None
    finally:
        CONFIG.CACHE_DIR = before
