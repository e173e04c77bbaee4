"""Messages on their way into a file: topics with their schemas, and what was said when."""

import io
import json
from collections.abc import Mapping, Sequence
from typing import Any, Final, final

from mcap.writer import CompressionType, Writer

from runtime.recording import foxglove

CHUNK: Final = 1 << 20
NANOSECONDS: Final = 1e9
LIBRARY: Final = "specc"


def nanoseconds(time: float) -> int:
    """The same instant, as MCAP counts it."""
    return round(time * NANOSECONDS)


@final
class Messages:
    """All messages of a recording; `written` puts them in the order of time.

    At one instant they stand in the order in which they were told.
    """

    def __init__(self) -> None:
        stream = io.BytesIO()
        self._stream = stream
        self._writer = Writer(stream, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._writer.start(library=LIBRARY)
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._told: list[tuple[int, int, bytes]] = []

    def json_topic(self, topic: str, properties: Mapping[str, object]) -> int:
        """The number of a topic of JSON objects; properties: by field, its JSON schema."""
        title = topic.strip("/")
        document = {"title": title, "type": "object", "properties": dict(properties)}
        text = json.dumps(document, ensure_ascii=False)
        return self._channel(topic, "json", title, "jsonschema", text.encode())

    def drawn_topic(self, topic: str, kind: str) -> int:
        """The number of a topic that is drawn: `kind` is a Foxglove schema."""
        name = f"{foxglove.PACKAGE}.{kind}"
        return self._channel(topic, "protobuf", name, "protobuf", foxglove.schema())

    def tell(self, channel: int, time: float, data: bytes) -> None:
        """A message at a time in seconds."""
        self._told.append((nanoseconds(time), channel, data))

    def draw(self, channel: int, time: float, message: Any) -> None:
        """A Foxglove message."""
        self.tell(channel, time, message.SerializeToString(deterministic=True))

    def written(
        self, attachments: Sequence[tuple[str, str, bytes]], about: Mapping[str, str]
    ) -> bytes:
        """The bytes of the file; attachments: name, media type, content. It is then finished."""
        self._told.sort(key=lambda message: message[0])
        counts: dict[int, int] = {}
        for time, channel, data in self._told:
            sequence = counts[channel] = counts.get(channel, -1) + 1
            self._writer.add_message(channel, time, data, time, sequence=sequence)
        for name, kind, content in attachments:
            self._writer.add_attachment(0, 0, name, kind, content)
        self._writer.add_metadata("specc", dict(about))
        self._writer.finish()  # type: ignore[no-untyped-call]  # the library's
        return self._stream.getvalue()

    def _channel(self, topic: str, encoding: str, name: str, schema: str, data: bytes) -> int:
        if topic not in self._channels:
            if name not in self._schemas:
                self._schemas[name] = int(self._writer.register_schema(name, schema, data))
            number = self._writer.register_channel(topic, encoding, self._schemas[name])
            self._channels[topic] = int(number)
        return self._channels[topic]
