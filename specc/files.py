"""Files: which are specs, and how one is written whole or not at all."""

from collections.abc import Sequence
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


def spec_files(paths: Sequence[Path]) -> tuple[Path, ...]:
    """The specs among files and folders; a folder stands for all its .yaml files, recursively."""
    found: list[Path] = []
    for path in paths:
        if path.is_dir():
            inside = (*path.rglob("*.yaml"), *path.rglob("*.yml"))
            found.extend(p for p in sorted(inside) if ".venv" not in p.parts)
        else:
            found.append(path)
    return tuple(dict.fromkeys(found))
