"""Files are written whole or not at all."""

from pathlib import Path


def write_atomically(path: Path, data: bytes) -> None:
    """`path` holds all of `data` or what it held before; never a half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.name}.part")
    try:
        beside.write_bytes(data)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)
