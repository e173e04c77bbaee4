"""Rows out of the pages of a damaged SQLite database, without the tree that leads to them.

Every page that is the leaf of a table tells by itself which rows it holds.
https://www.sqlite.org/fileformat2.html, 1.6 and 2.1
"""

import mmap
from collections.abc import Iterator
from typing import Final, TypeAlias, final

Bytes: TypeAlias = bytes | mmap.mmap
Value: TypeAlias = int | str | bytes | None

MOST_READINGS: Final = 4
"""So often the bytes of a file are read for its rows, at most. A whole database needs one."""

_HEAD = 100
_TABLE_LEAF = 0x0D
_INTEGER_SIZES = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}


def page_size(data: Bytes) -> int:
    """Bytes a page; what the head says, if that can be."""
    size = int.from_bytes(data[16:18], "big")
    size = 1 << 16 if size == 1 else size
    return size if 512 <= size <= 1 << 16 and size & (size - 1) == 0 else 4096


def pages_claimed(data: Bytes) -> int:
    """How many pages the file should have."""
    return int.from_bytes(data[28:32], "big")


@final
class StrayRows:
    """The byte, the row's number and the values of every row that stands in a whole leaf page.

    Pages of a whole database share no bytes. In a damaged one many cells may lead to the same
    ones, so what is read in all is bounded; `left_out` counts the rows behind that bound.
    """

    def __init__(self, data: Bytes) -> None:
        self._data = data
        self._page = page_size(data)
        self._room = MOST_READINGS * len(data)
        self.left_out = 0

    def __iter__(self) -> Iterator[tuple[int, int, list[Value]]]:
        """Page by page."""
        data, size = self._data, self._page
        for start in range(0, len(data) - size + 1, size):
            head = start + (_HEAD if start == 0 else 0)
            if data[head] != _TABLE_LEAF:
                continue
            for i in range(int.from_bytes(data[head + 3 : head + 5], "big")):
                pointer = head + 8 + 2 * i
                if pointer + 2 > start + size:
                    break
                place = start + int.from_bytes(data[pointer : pointer + 2], "big")
                if place >= pointer + 2 and (row := self._cell(place, start + size)):
                    yield (start, *row)

    def _cell(self, place: int, end: int) -> tuple[int, list[Value]] | None:
        """Number and values of the row at `place`; None where the bytes are no whole row."""
        if place + 20 > end:
            return None
        length, place = _varint(self._data, place)
        number, place = _varint(self._data, place)
        if length > len(self._data):
            return None
        body = self._payload(place, end, length)
        if self._room < 0:
            self.left_out += 1
            return None
        values = None if body is None else _record(body)
        return None if values is None else (number, values)

    def _payload(self, place: int, end: int, length: int) -> bytes | None:
        """The row's bytes, from this page and those that it overflows into."""
        data, page = self._data, self._page
        if length <= page - 35:
            return self._taken(place, length) if place + length <= end else None
        least = (page - 12) * 32 // 255 - 23
        local = least + (length - least) % (page - 4)
        local = local if local <= page - 35 else least
        if place + local + 4 > end:
            return None
        parts = [self._taken(place, local)]
        left = length - local
        following = int.from_bytes(data[place + local : place + local + 4], "big")
        while left > 0 and self._room >= 0:
            start = (following - 1) * page
            if following < 2 or start + page > len(data):
                return None
            parts.append(self._taken(start + 4, min(left, page - 4)))
            left -= page - 4
            following = int.from_bytes(data[start : start + 4], "big")
        return b"".join(parts)

    def _taken(self, place: int, count: int) -> bytes:
        """So many bytes from `place` on; none where no more may be read."""
        self._room -= count
        return bytes(self._data[place : place + count]) if self._room >= 0 else b""


def _varint(data: Bytes, place: int) -> tuple[int, int]:
    """The number at `place`, and where it ends."""
    value = 0
    for i in range(8):
        byte = data[place + i]
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, place + i + 1
    return value << 8 | data[place + 8], place + 9


def _record(body: bytes) -> list[Value] | None:
    """The values of a row; None where its head does not fit its length."""
    values: list[Value] = []
    try:
        place, position = _varint(body, 0)
        head = place
        while position < head:
            kind, position = _varint(body, position)
            value, place = _value(body, kind, place)
            values.append(value)
    except IndexError:
        return None
    return values if place == len(body) and position == head else None


def _value(body: bytes, kind: int, place: int) -> tuple[Value, int]:
    if kind in _INTEGER_SIZES:
        end = place + _INTEGER_SIZES[kind]
        return int.from_bytes(body[place:end], "big", signed=True), end
    if kind in {8, 9}:
        return kind - 8, place
    if kind == 7:
        return None, place + 8
    if kind >= 12:
        end = place + (kind - 12) // 2
        raw = body[place:end]
        return (raw.decode("utf-8", errors="replace") if kind % 2 else raw), end
    return None, place
