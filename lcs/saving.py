"""Learners as files: a zip archive with a header in JSON and arrays of numpy, and no pickle.

numpy's `load` reads the arrays too. The same state gives the same bytes.
"""

import io
import json
import os
import zipfile
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from lcs.alcsr.learner import ALCSR
from lcs.faults import LearnerError
from lcs.state import Saved, State
from lcs.steps.learner import StepsLearner
from lcs.xcsr.learner import XCSR

FORMAT: Final = "specc learner"
VERSION: Final = 1
HEADER: Final = "header.json"

KINDS: Final[Mapping[str, Callable[[State], Any]]] = {
    "ALCSR": ALCSR.from_state,
    "XCSR": XCSR.from_state,
    "StepsLearner": StepsLearner.from_state,
}
"""How a learner of each kind is made."""


def save(learner: Saved, path: str | Path) -> None:
    """Write all that a learner is; the file is whole, or as it was before.

    Raises:
        LearnerError: its source of chance is of a kind that is not kept, or the path is a folder
            or in none.
        OSError: the file can't be written.
    """
    target = Path(path)
    _refuse_folder(target)
    if not target.parent.is_dir():
        raise LearnerError(f"{target.parent} is no folder: make it first, or name another file")
    content = as_bytes(learner.state())
    beside = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        with beside.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(target)
    finally:
        beside.unlink(missing_ok=True)


def load(path: str | Path) -> Any:
    """The learner that was saved there; it goes on bit for bit as that one would.

    Raises:
        LearnerError: the file is damaged, no learner, or of another version.
        OSError: there is no such file, or it can't be read.
    """
    return load_one_of(KINDS, path)


def load_one_of(kinds: Mapping[str, Callable[[State], Any]], path: str | Path) -> Any:
    """What was saved there, made as is said for its kind.

    Raises:
        LearnerError: the file is damaged, of none of these kinds, or of another version, or it is
            a folder.
        OSError: there is no such file, or it can't be read.
    """
    _refuse_folder(Path(path))
    try:
        return _made(kinds, from_bytes(Path(path).read_bytes()))
    except LearnerError as error:
        raise LearnerError(f"{path} holds no learner that can be used: {error}") from error


def _refuse_folder(path: Path) -> None:
    if path.is_dir():
        raise LearnerError(f"{path} is a folder: name a file in it, such as {path / 'learner.npz'}")


def _made(kinds: Mapping[str, Callable[[State], Any]], state: State) -> Any:
    if state.kind not in kinds:
        raise LearnerError(f"its kind is '{state.kind}': known are {', '.join(kinds)}")
    return kinds[state.kind](state)


def as_bytes(state: State) -> bytes:
    """The file of a state."""
    header = {
        "format": FORMAT,
        "version": VERSION,
        "kind": state.kind,
        "values": state.plain,
        "arrays": list(state.arrays),
    }
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        _put(archive, HEADER, json.dumps(header, indent=1).encode())
        for name, values in state.arrays.items():
            written = io.BytesIO()
            np.lib.format.write_array(written, values, allow_pickle=False)
            _put(archive, f"{name}.npy", written.getvalue())
    return content.getvalue()


def from_bytes(content: bytes) -> State:
    """The state that a file holds.

    Raises:
        LearnerError: it is damaged, no learner, or of another version.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            header = _header(archive)
            arrays = {name: _array(archive, name) for name in header["arrays"]}
            return State(str(header["kind"]), header["values"], arrays)
    except zipfile.BadZipFile as error:
        raise LearnerError(f"it is cut off, damaged or another kind of file ({error})") from error
    except (zlib.error, EOFError, NotImplementedError, RuntimeError) as error:
        raise LearnerError(f"it is damaged ({error})") from error


def _header(archive: zipfile.ZipFile) -> dict[str, Any]:
    if HEADER not in archive.namelist():
        raise LearnerError(f"it has no {HEADER}")
    try:
        header = json.loads(archive.read(HEADER))
    except ValueError as error:
        raise LearnerError(f"its {HEADER} is no JSON") from error
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        raise LearnerError(f"its {HEADER} does not say '{FORMAT}'")
    if header.get("version") != VERSION:
        raise LearnerError(f"its version is {header.get('version')}, and {VERSION} can be read")
    missing = sorted({"kind", "values", "arrays"} - {*header})
    if missing or not isinstance(header["arrays"], list):
        raise LearnerError(f"its {HEADER} does not name {', '.join(missing) or 'arrays'}")
    return header


def _array(archive: zipfile.ZipFile, name: str) -> npt.NDArray[Any]:
    if f"{name}.npy" not in archive.namelist():
        raise LearnerError(f"'{name}' is missing")
    try:
        content = io.BytesIO(archive.read(f"{name}.npy"))
        values: npt.NDArray[Any] = np.lib.format.read_array(content, allow_pickle=False)
    except ValueError as error:
        raise LearnerError(f"'{name}' is no array of numbers ({error})") from error
    return values


def _put(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    entry = zipfile.ZipInfo(name)  # of 1980: the time is no part of a learner
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, content)
