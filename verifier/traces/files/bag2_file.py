"""ROS 2 bags that are kept in SQLite (`.db3`), row by row; of damaged ones, every row left."""

import mmap
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import TypeAlias
from urllib.parse import quote

from verifier.traces.files.log import MessageLog, Progress, Wanted
from verifier.traces.files.sqlite_pages import (
    MOST_READINGS,
    StrayRows,
    Value,
    page_size,
    pages_claimed,
)
from verifier.traces.files.streams import Gathering
from verifier.traces.files.unpacking import UnpackError, unpack_zstd
from verifier.traces.messages.channel import Channel

Definitions: TypeAlias = dict[str, tuple[str, bytes]]

_TOPICS = "SELECT id, name, type, serialization_format FROM topics ORDER BY id"
_DEFINITIONS = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"
_MESSAGES = "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id"
_BATCH = 1000
_HEAD_BYTES = 100
# Python can't even tell what SQLite says where that quotes bytes that are no text.
_FAULTS = (sqlite3.Error, UnicodeDecodeError)
_ZSTD = b"\x28\xb5\x2f\xfd"


def is_sqlite(head: bytes) -> bool:
    """Whether a file that begins with `head` is an SQLite database."""
    return head.startswith(b"SQLite format 3\0")


def read_bag2(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    """The messages of one database; raises OSError."""
    gathering: Gathering[int] = Gathering(wanted)
    size = path.stat().st_size
    try:
        _check_size(path, size, gathering)
        with closing(_open(path, gathering)) as database:
            _read_topics(database, gathering)
            _read_rows(database, gathering, tell, size)
    except _FAULTS as error:
        # What the tree of pages does not lead to may still stand in its leaves.
        gathering = Gathering(wanted)
        gathering.lose("database damaged", _sentence(error))
        _check_size(path, size, gathering)
        _salvage(path, gathering, tell)
    return gathering.finished(str(path), "ROS 2 bag")


def _check_size(path: Path, size: int, gathering: Gathering[int]) -> None:
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    claimed = pages_claimed(head) * page_size(head)
    if claimed > size:
        gathering.lose("file cut", f"{claimed} bytes expected, {size} found")


def _open(path: Path, gathering: Gathering[int]) -> sqlite3.Connection:
    """The database, with what a killed recorder left beside it; raises sqlite3.Error."""
    name = quote(str(path.absolute()))
    beside = path.with_name(f"{path.name}-wal")
    database = sqlite3.connect(f"file:{name}?mode=ro", uri=True)
    database.text_factory = lambda raw: raw.decode("utf-8", errors="replace")
    try:
        database.execute("PRAGMA trusted_schema = OFF")
        database.execute("SELECT name FROM sqlite_master").fetchall()
    except sqlite3.OperationalError:
        if not beside.exists():
            raise
        database.close()
        gathering.lose("write-ahead log not read", f"{beside.name} can't be opened")
        database = sqlite3.connect(f"file:{name}?immutable=1", uri=True)
    return database


def _read_topics(database: sqlite3.Connection, gathering: Gathering[int]) -> None:
    tables = {name for (name,) in database.execute("SELECT name FROM sqlite_master")}
    if not {"topics", "messages"} <= tables:
        raise sqlite3.DatabaseError("it has no tables 'topics' and 'messages'")
    definitions: Definitions = {}
    if "message_definitions" in tables:
        for name, encoding, text in database.execute(_DEFINITIONS):
            definitions[str(name)] = (str(encoding), str(text).encode())
    for number, name, kind, encoding in database.execute(_TOPICS):
        if isinstance(number, int):
            gathering.declare(number, _channel(str(name), str(kind), str(encoding), definitions))
        else:
            gathering.lose("corrupt record", "a topic without a number")


def _channel(name: str, kind: str, encoding: str, definitions: Definitions) -> Channel:
    schema_encoding, schema = definitions.get(kind, ("", b""))
    return Channel(name, kind, encoding, schema_encoding, schema)


def _read_rows(
    database: sqlite3.Connection, gathering: Gathering[int], tell: Progress, size: int
) -> None:
    rows = database.execute(_MESSAGES)
    last = 0
    done = 0
    while batch := rows.fetchmany(_BATCH):
        for number, topic, log_time, payload in batch:
            _add(gathering, topic, log_time, payload)
            done += len(payload) if isinstance(payload, bytes) else 0
            last = number if isinstance(number, int) else last
        tell(min(done, size), size)
    if last > gathering.count:
        gathering.notes.append(
            f"messages are numbered up to {last}, but {gathering.count} are there"
        )


def _add(gathering: Gathering[int], topic: Value, log_time: Value, payload: Value) -> None:
    if isinstance(topic, int) and isinstance(log_time, int) and isinstance(payload, bytes):
        if log_time < 0:
            gathering.lose("impossible log time", "before the year 1970")
            return
        if payload.startswith(_ZSTD):
            try:
                payload = unpack_zstd(payload)
            except UnpackError as error:
                gathering.lose("corrupt record", f"a message: {error}")
                return
        gathering.add(topic, log_time, payload, 0, len(payload))
    else:
        gathering.lose("corrupt record", "a row of messages with values of other types")


def _salvage(path: Path, gathering: Gathering[int], tell: Progress) -> None:
    """All rows that stand in whole pages, told apart by the types of their values."""
    definitions: Definitions = {}
    topics: dict[int, tuple[str, str, str]] = {}
    last = 0
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        rows = StrayRows(data)
        for place, number, row in rows:
            match row:
                case [None, int(topic), int(log_time), bytes(payload)]:
                    _add(gathering, topic, log_time, payload)
                    last = max(last, number)
                case [None, str(name), str(kind), str(encoding), str(), *_] if name[:1] == "/":
                    topics[number] = (name, kind, encoding)
                case [None, str(name), str(encoding), str(text), *_] if "/" in name:
                    definitions[name] = (encoding, text.encode())
            tell(place, len(data))
    for number, (name, kind, encoding) in topics.items():
        gathering.declare(number, _channel(name, kind, encoding, definitions))
    if gathering.count:
        gathering.lose("unverified messages", "read of single pages", gathering.count)
    if rows.left_out:
        detail = f"they lead to the same bytes more than {MOST_READINGS} times over"
        gathering.lose("rows left out", detail, rows.left_out)
    if last > gathering.count:
        detail = f"they are numbered up to {last}"
        gathering.lose("messages missing", detail, last - gathering.count)


def _sentence(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
