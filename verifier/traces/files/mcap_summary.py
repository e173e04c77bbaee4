"""The index at the end of an MCAP file: read first, since it declares what the data hold.

What it says is only used where the data say nothing else, and its checksum is compared.
"""

import zlib

from mcap.opcode import Opcode
from mcap.records import Channel, Footer, Schema, Statistics

from verifier.traces.files.mcap_reading import Reading
from verifier.traces.files.mcap_records import HEAD, MAGIC, Bytes, parse

_FOOTER_BYTES = HEAD.size + 20
_LARGEST = 1 << 30


def read_summary(data: Bytes, reading: Reading) -> None:
    """Tells the reading what the index declares, if there is a whole one."""
    place = len(data) - len(MAGIC) - _FOOTER_BYTES
    if place < len(MAGIC) or data[-len(MAGIC) :] != MAGIC:
        return
    footer = parse(Footer, bytes(data[place + HEAD.size : place + _FOOTER_BYTES]))
    if data[place] != Opcode.FOOTER or footer is None or not footer.summary_start:
        return
    start = footer.summary_start
    if not len(MAGIC) < start <= place or place - start > _LARGEST:
        reading.gathering.lose("index disagrees", "the index does not stand where the footer says")
        return
    # The checksum covers the footer too, but for itself.
    summary = bytes(data[start : place + _FOOTER_BYTES - 4])
    if footer.summary_crc and zlib.crc32(summary) != footer.summary_crc:
        reading.gathering.lose("checksum wrong", "of the index at the end; it is not used")
        return
    _foretell(summary, reading, sure=footer.summary_crc != 0)


def _foretell(summary: bytes, reading: Reading, *, sure: bool) -> None:
    schemas: list[Schema] = []
    channels: list[Channel] = []
    position = 0
    while position + HEAD.size <= len(summary):
        opcode, length = HEAD.unpack_from(summary, position)
        begin = position + HEAD.size
        position = begin + length
        body = summary[begin:position]
        if opcode == Opcode.SCHEMA and (schema := parse(Schema, body)):
            schemas.append(schema)
        elif opcode == Opcode.CHANNEL and (channel := parse(Channel, body)):
            channels.append(channel)
        elif opcode == Opcode.STATISTICS and (statistics := parse(Statistics, body)):
            reading.promised = statistics.message_count
        elif opcode == Opcode.CHUNK_INDEX and len(body) >= 24:
            reading.chunks.add(int.from_bytes(body[16:24], "little"))
            reading.chunked = True
    reading.foretell(schemas, channels, sure=sure)
