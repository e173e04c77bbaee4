"""A log of any kind, told by its first bytes and not by its name."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from spec_schema.diagnostics import SpecError
from spec_schema.source import Source
from verifier.traces.faults import file_fault
from verifier.traces.files.bag1_file import is_bag1, read_bag1
from verifier.traces.files.bag2_file import is_sqlite, read_bag2
from verifier.traces.files.csv_file import read_csv
from verifier.traces.files.csv_layout import is_csv
from verifier.traces.files.log import LogFile, MessageLog, Messages, Progress, Wanted
from verifier.traces.files.mcap_file import (
    find_attachments,
    find_damaged_attachments,
    is_mcap,
    read_mcap,
)
from verifier.traces.files.packed_file import ELSEWHERE, is_packed, reason, unpack_file
from verifier.traces.files.ulog_file import is_ulog, read_ulog
from verifier.traces.trace import Loss

HEAD_BYTES = 1 << 16

_KINDS = "MCAP, ROS 1 bag, ROS 2 bag (folder or .db3), ULog, CSV with a header line"

_READERS: tuple[tuple[Callable[[bytes], bool], Callable[[Path, Wanted, Progress], LogFile]], ...]
_READERS = (
    (is_mcap, read_mcap),
    (is_bag1, read_bag1),
    (is_sqlite, read_bag2),
    (is_ulog, read_ulog),
    (is_csv, read_csv),
)


def open_log(path: Path, wanted: Wanted, progress: Progress | None = None) -> LogFile:
    """The log's messages or columns; raises SpecError V301, V302 or V309."""
    tell = progress or (lambda _done, _whole: None)
    try:
        return _read_folder(path, wanted, tell) if path.is_dir() else _read_file(path, wanted, tell)
    except OSError as error:
        raise _unreadable(path, error) from error


def attached_program(path: Path) -> tuple[str, bytes] | None:
    """Name and bytes of the compiled spec that an MCAP file carries, if it carries one.

    Reads no message. Raises SpecError V301.
    """
    found = attached_programs(path)
    return found[-1] if found else None


def attached_programs(path: Path) -> list[tuple[str, bytes]]:
    """Names and bytes of all compiled specs that an MCAP file carries.

    Reads no message. Raises SpecError V301.
    """
    return attachments(path, ".specc")


def attachments(path: Path, suffix: str) -> list[tuple[str, bytes]]:
    """Names and bytes of what an MCAP file carries under names that end in `suffix`.

    Reads no message. Raises SpecError V301.
    """
    try:
        if path.is_dir() or not is_mcap(_head(path)):
            return []
        return find_attachments(path, suffix)
    except OSError as error:
        raise _unreadable(path, error) from error


def damaged_attachments(path: Path) -> list[str]:
    """Names of what an MCAP file carries and that was cut or altered.

    Raises SpecError V301.
    """
    try:
        return find_damaged_attachments(path) if is_mcap(_head(path)) else []
    except OSError as error:
        raise _unreadable(path, error) from error


def _unreadable(path: Path, error: OSError) -> SpecError:
    if isinstance(error, FileNotFoundError):
        return file_fault(path, "V301", "there is no such file")
    return file_fault(path, "V301", f"the log can't be read: {reason(error)}")


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(HEAD_BYTES)


def _read_file(path: Path, wanted: Wanted, tell: Progress) -> LogFile:
    head = _head(path)
    if not head:
        raise file_fault(path, "V302", "the file is empty")
    if is_packed(head):
        return _read_packed(path, wanted, tell)
    for known, read in _READERS:
        if known(head):
            return read(path, wanted, tell)
    if path.suffix == ".mcap":
        # Its first bytes may be what was overwritten.
        log = read_mcap(path, wanted, tell)
        if log.streams:
            return log
    raise file_fault(path, "V302", _strange(head), f"known: {_KINDS}")


def _strange(head: bytes) -> str:
    """What a file is instead of a log."""
    if head.startswith(b"version https://git-lfs"):
        return "this is a pointer of Git LFS, not the file itself (git lfs pull)"
    if not head.strip(b"\0"):
        return "the file begins with nothing but zero bytes"
    if head[:512].lstrip()[:1] == b"<":
        return "this is a page of the web, not a log"
    return "this is no log that specc knows"


def _read_packed(path: Path, wanted: Wanted, tell: Progress) -> LogFile:
    """The log inside; it is unpacked into a temporary file first."""
    with _temporary(path) as folder:
        inside = Path(folder) / path.stem
        fault = unpack_file(path, inside)
        head = _head(inside)
        if fault and not head:
            raise file_fault(path, "V302", f"nothing of it can be unpacked: {fault}")
        if is_packed(head):
            raise file_fault(path, "V302", "the file is packed twice", "unpack it first")
        try:
            log = open_log(inside, wanted, tell)
        except SpecError as error:
            about = [replace(d, source=Source(str(path), "")) for d in error.diagnostics]
            raise SpecError(about) from error
    told = f"{fault}; no checksum vouches for what was read of it"
    lost = (Loss("packed file damaged", 1, told),) if fault else ()
    return replace(log, source=str(path), losses=(*lost, *log.losses))


def _temporary(path: Path) -> TemporaryDirectory[str]:
    """A folder that is removed with all that is in it."""
    try:
        return TemporaryDirectory(prefix="specc-")
    except OSError as error:
        message = f"it is packed, and no temporary folder can be made: {reason(error)}"
        raise file_fault(path, "V301", message, ELSEWHERE) from error


def _read_folder(path: Path, wanted: Wanted, tell: Progress) -> LogFile:
    """A folder of files that belong together: MCAP, or a ROS 2 bag of either kind."""
    parts = sorted(path.glob("*.mcap")) or sorted(path.glob("*.db3"))
    if not parts:
        message = "the folder holds no log that specc knows"
        raise file_fault(path, "V302", message, f"known: {_KINDS}")
    # An empty part is what a recorder leaves when it is killed.
    empty = [part for part in parts if part.stat().st_size == 0]
    logs = [_read_part(part, wanted, tell) for part in parts if part not in empty]
    if not logs:
        raise file_fault(path, "V302", "every log in the folder is empty")
    lost = tuple(Loss("empty file", 1, part.name) for part in empty)
    joined = _joined(path, logs)
    return replace(joined, losses=(*lost, *joined.losses))


def _read_part(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    if is_sqlite(_head(path)):
        return read_bag2(path, wanted, tell)
    return read_mcap(path, wanted, tell)


def _placed_behind(before: int, stream: Messages) -> Messages:
    """The messages of one file, placed behind so many of the files before it."""
    places = stream.places
    if places is None:
        # Alone in its file, but perhaps not in the folder.
        places = np.arange(stream.times.size, dtype=np.uint32)
    return replace(stream, places=places + np.uint32(before))


def _joined(path: Path, logs: Sequence[MessageLog]) -> MessageLog:
    streams: list[Messages] = []
    for log in logs:
        before = sum(stream.count for stream in streams)
        streams += [_placed_behind(before, stream) for stream in log.streams]
    return MessageLog(
        source=str(path),
        kind=f"folder of {logs[0].kind}",
        streams=tuple(streams),
        losses=tuple(
            Loss(loss.cause, loss.count, f"{Path(log.source).name}: {loss.detail}")
            for log in logs
            for loss in log.losses
        ),
        notes=tuple(dict.fromkeys(note for log in logs for note in log.notes)),
    )
