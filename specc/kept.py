"""Folders in which a command keeps what it goes on from: whether they can be begun in, and read."""

import json
import zipfile
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path
from tokenize import TokenError
from typing import Any, Final, TypeVar

from lcs.faults import LearnerError
from specc.faults import fault

Record = TypeVar("Record")

UNREADABLE: Final = (
    *(LearnerError, KeyError, ValueError, EOFError),
    *(zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError),
    *(TokenError, SyntaxError),  # of a header, which numpy reads before its checksum
)
"""What a file of arrays that is damaged anywhere raises while it is unpacked."""


def refuse_file(folder: Path, code: str) -> None:
    """Stop where a file has the name of the folder.

    Raises:
        SpecError: it is one.
    """
    if folder.exists() and not folder.is_dir():
        raise fault(code, folder, "this is a file, no folder", "name a folder, or a new one")


def refuse_taken(paths: Iterable[Path], code: str, kept: str) -> None:
    """Stop where something else would be written over; kept: an experiment, a training.

    Raises:
        SpecError: one of the paths is there.
    """
    for path in paths:
        if path.exists() or path.is_symlink():
            message = f"this is of no {kept} that is kept here, and would be written over"
            raise fault(code, path, message, "name another folder; or move this away")


def record_in(path: Path, code: str, kept: str, made: Callable[[Any], Record]) -> Record:
    """What a file of JSON says is kept: `made` makes it of that, or raises as bad values do.

    Raises:
        SpecError: it can't be made.
        OSError: the file can't be read.
    """
    try:
        return made(json.loads(path.read_text(encoding="utf-8")))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        why = f"it lacks {error}" if isinstance(error, KeyError) else str(error)
        remedy = "begin again in another folder"
        raise fault(code, path, f"this is no {kept} of this specc: {why}", remedy) from error
