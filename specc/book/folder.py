"""A book as a folder: written whole or not at all, read back, and checked."""

import hashlib
import secrets
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final

from runtime.container import ArtifactError
from specc.book import manifest
from specc.book.manifest import Book
from specc.faults import fault

MANIFEST: Final = manifest.DOCUMENT.name


def is_book(path: Path) -> bool:
    """Whether a folder says that it is a book."""
    return (path / MANIFEST).is_file()


def read_book(path: Path) -> Book:
    """The manifest of a book, all of whose files are as they were written.

    Raises:
        SpecError: it is no book (V432), or not as it was written (V433).
    """
    book = read_manifest(path)
    problems = [f"{file.path} {what}" for file in book.files if (what := _wrong(path, file))]
    if problems:
        listed = "; ".join(problems[:5])
        more = f"; and {len(problems) - 5} more" if len(problems) > 5 else ""
        message = f"this book is not as it was written: {listed}{more}"
        raise fault("V433", path, message, "export it again, or copy it again as a whole")
    return book


def read_manifest(path: Path) -> Book:
    """The manifest alone; nothing else of the book is looked at.

    Raises:
        SpecError: it is no book (V432).
    """
    file = path / MANIFEST
    remedy = "make one: specc export ARCHITECTURE.yaml -o book/"
    try:
        return manifest.from_bytes(file.read_bytes())
    except OSError as error:
        why = str(error.strerror or error).lower()
        raise fault("V432", file, f"this is no book: {why}", remedy) from error
    except ArtifactError as error:
        raise fault("V432", file, f"this is no book of this version: {error}", remedy) from error


def _wrong(path: Path, file: manifest.File) -> str:
    """What is wrong with a file; empty where it is as it was written."""
    inside = path / file.path
    if not inside.is_file():
        return "is missing"
    if hashlib.sha256(inside.read_bytes()).hexdigest() != file.sha256:
        return "was changed"
    return ""


def refuse_early(path: Path) -> None:
    """Stops before the work begins where the book could not be put in the end.

    Raises:
        SpecError: something stands there that is no book (V434), or is not of the book (V435).
    """
    if path.is_symlink() or (path.exists() and not path.is_dir()):
        raise fault("V434", path, "this is no folder", "name a new folder: -o book/")
    if not path.exists() or not any(path.iterdir()):
        return
    if not is_book(path):
        message = "this folder holds something else than a book, and nothing is written into it"
        raise fault("V434", path, message, "name a new folder: -o book/")
    book = read_manifest(path)
    known = {file.path for file in book.files} | {MANIFEST}
    others = sorted(p for p in _files(path) if p not in known)
    changed = [f.path for f in book.files if _wrong(path, f) == "was changed"]
    if others or changed:
        what = f"{others[0]} is not of it" if others else f"{changed[0]} was changed"
        message = f"a new book would take the place of this one, and {what}"
        raise fault("V435", path, message, "move your own files out of it, or name a new folder")


def _files(path: Path) -> list[str]:
    """All files but what Python leaves behind when the reader of tables is used."""
    found = (p.relative_to(path) for p in path.rglob("*") if not p.is_dir())
    return [name.as_posix() for name in found if "__pycache__" not in name.parts]


def write_folder(path: Path, files: Mapping[str, bytes]) -> None:
    """All files in a folder that is there as a whole or not at all.

    Raises:
        SpecError: as `refuse_early`, or it can't be written (V347).
    """
    refuse_early(path)
    target = path.resolve()
    beside = target.with_name(f".{target.name}.{secrets.token_hex(4)}.part")
    try:
        beside.mkdir(parents=True)
        for name, data in files.items():
            file = beside / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(data)
        _put(beside, target)
    except OSError as error:
        why = str(error.strerror or error).lower()
        raise fault("V347", path, f"the book can't be written: {why}") from error
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def _put(made: Path, target: Path) -> None:
    """The new book in the place of the old one, which is moved aside, and back if that fails."""
    if not target.exists():
        made.rename(target)
        return
    old = target.with_name(f".{target.name}.{secrets.token_hex(4)}.old")
    target.rename(old)
    try:
        made.rename(target)
    except BaseException:
        with suppress(OSError):
            old.rename(target)
        raise
    shutil.rmtree(old, ignore_errors=True)
