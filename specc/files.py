"""Files: which are specs, and how one is written whole or not at all."""

import json
import secrets
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

from spec_schema.diagnostics import SpecError
from specc.faults import fault

BOM: Final = b"\xef\xbb\xbf"
"""A mark of byte order, which some editors write."""


def write_atomically(path: Path, data: bytes) -> None:
    """`path` holds all of `data` or what it held before; never a half of it.

    A link is followed: what it points to is replaced.

    Raises:
        SpecError: the path is a folder or a device, or can't be written.
    """
    target = Path(path).resolve()
    if target.exists() and not target.is_file():
        raise fault("V347", path, "this is no ordinary file, so nothing is written to it")
    # A name of its own: two processes that write one file do not write into one another's.
    beside = target.with_name(f".{target.name}.{secrets.token_hex(4)}.part")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with beside.open("xb") as file:
            file.write(data)
        beside.replace(target)
    except OSError as error:
        why = str(error.strerror).lower()
        raise fault("V347", path, f"the file can't be written: {why}") from error
    finally:
        _remove(beside)


def write_over(path: Path, text: str, new: str, meanwhile: str) -> None:
    """Replace a text by another, whole or not at all; a mark of byte order stays.

    meanwhile: what happened since it was read, as `the spec was changed while ...`.

    Raises:
        SpecError: it is not that text any more (V374), or can't be written (V347).
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        why = str(error.strerror).lower()
        raise fault("V374", path, f"the spec can't be read any more: {why}") from error
    if data.removeprefix(BOM) != text.encode():
        message = f"the spec was changed while {meanwhile}, so nothing is written"
        raise fault("V374", path, message, "run the command again")
    write_atomically(path, BOM * data.startswith(BOM) + new.encode())


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink(missing_ok=True)


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


def json_bytes(record: object) -> bytes:
    """A record as indented JSON; never NaN, which isn't JSON."""
    return (json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()


def require_suffix(path: Path | None, *suffixes: str) -> None:
    """Refuse a file that could not be written in the end, before the work begins.

    Raises:
        SpecError: none of `suffixes` fits.
    """
    if path is not None and path.suffix.lower() not in suffixes:
        raise unknown_suffix(path, ", ".join(suffixes))


def unknown_suffix(path: Path, known: str) -> SpecError:
    """The error about a file whose kind can't be written."""
    message = f"no output of kind '{path.suffix or path.name}' can be written"
    return fault("V345", path, message, f"known are {known}")
