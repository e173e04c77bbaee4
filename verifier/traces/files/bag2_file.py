"""ROS 2 bags that are kept in SQLite (`.db3`), through the library rosbags."""

from pathlib import Path
from typing import TypeAlias

from rosbags.interfaces import Connection, MessageDefinitionFormat
from rosbags.rosbag2 import Reader
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

from verifier.traces.files.log import MessageLog, Progress, Wanted
from verifier.traces.files.streams import Gathering
from verifier.traces.messages.channel import Channel

_SCHEMA_ENCODINGS = {
    MessageDefinitionFormat.MSG: "ros2msg",
    MessageDefinitionFormat.IDL: "ros2idl",
    MessageDefinitionFormat.NONE: "",
}

AnyReader: TypeAlias = Reader | Sqlite3Reader


def is_sqlite(head: bytes) -> bool:
    """Whether a file that begins with `head` is an SQLite database."""
    return head.startswith(b"SQLite format 3\0")


def read_bag2(path: Path, wanted: Wanted, tell: Progress) -> MessageLog:
    """The messages of a bag: a folder with `metadata.yaml`, or one database file."""
    gathering: Gathering[str] = Gathering(wanted)
    reader: AnyReader = Reader(path) if path.is_dir() else Sqlite3Reader(path)
    # The library meets damage with whatever exception comes first; all of them mean the same.
    try:
        reader.open()
    except Exception as error:  # noqa: BLE001  # see above
        gathering.lose("bag can't be opened", _sentence(error))
        return gathering.finished(str(path), "ROS 2 bag")
    try:
        _read_messages(reader, gathering)
    except Exception as error:  # noqa: BLE001  # see above
        gathering.lose("bag damaged", f"nothing is read after: {_sentence(error)}")
    finally:
        reader.close()
    return gathering.finished(str(path), "ROS 2 bag")


def _read_messages(reader: AnyReader, gathering: Gathering[str]) -> None:
    for connection in reader.connections:
        gathering.declare(_key(connection), _channel(connection))
    for connection, log_time, payload in reader.messages(reader.connections):
        gathering.add(_key(connection), log_time, bytes(payload), 0, len(payload))


def _key(connection: Connection) -> str:
    return f"{connection.id} {connection.topic}"


def _channel(connection: Connection) -> Channel:
    return Channel(
        topic=connection.topic,
        message_type=connection.msgtype,
        encoding=getattr(connection.ext, "serialization_format", "cdr"),
        schema_encoding=_SCHEMA_ENCODINGS[connection.msgdef.format],
        schema=connection.msgdef.data.encode(),
    )


def _sentence(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
