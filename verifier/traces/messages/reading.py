"""The values at given paths in the messages of one channel, decoded batch by batch."""

from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from runtime.arrays import Array, Booleans, Integers
from verifier.traces.messages.channel import Channel
from verifier.traces.messages.codecs import Codec, find_codec
from verifier.traces.messages.columns import Column, GrowingColumn
from verifier.traces.messages.fields import FieldError, StampLeaves, check, leaves, stamp_leaves
from verifier.traces.messages.leaves import all_paths
from verifier.traces.messages.paths import MessagePath, Steps
from verifier.traces.messages.quaternions import angle

LATEST_SECONDS = 4e9


@final
@dataclass(frozen=True, eq=False, slots=True)
class Values:
    """What was read of the first k messages of a channel.

    readable: (k,) which of them could be decoded at all; `reason` says what was wrong with the
    first that could not. stamps: of the r readable ones, (r,) nanoseconds of the sensor, 0 where
    it gave none; None where the messages have no stamp. columns: (r,) each, by the path's text.
    faults: why a path finds no number here, by the path's text; all of them where the messages
    can't be read at all, which `fault` says.
    """

    readable: Booleans
    reason: str
    stamps: Integers | None
    columns: Mapping[str, Column]
    faults: Mapping[str, FieldError]
    fault: FieldError | None


@final
class Reader:
    """Takes the messages of one channel, batch by batch, and keeps only the values asked for."""

    def __init__(self, channel: Channel, paths: Sequence[MessagePath] | None) -> None:
        self._channel = channel
        self._wanted = paths
        self._paths: list[MessagePath] = []
        self._codec: Codec | None = None
        self._leaves: dict[str, tuple[Steps, ...]] = {}
        self._stamp: StampLeaves | None = None
        self._asked: list[Steps] = []
        self._columns: dict[str, GrowingColumn] = {}
        self._stamps = array("q")
        self._readable = bytearray()
        self._reason = ""
        self._faults: dict[str, FieldError] = {}
        self._fault: FieldError | None = None

    def feed(self, payloads: Sequence[bytes]) -> None:
        """The next messages."""
        if self._codec is None and self._fault is None:
            self._open(payloads)
        if self._codec is None:
            self._readable += bytes(len(payloads))
            return
        decoded = self._codec.decode(payloads, self._asked)
        self._readable += decoded.readable.tobytes()
        self._reason = self._reason or decoded.reason
        rows = np.flatnonzero(decoded.readable)
        whole = rows.size == len(payloads)
        columns = decoded.columns if whole else tuple(one.rows(rows) for one in decoded.columns)
        found = dict(zip(self._asked, columns, strict=True))
        for path in self._paths:
            self._columns[path.text].add(
                _value(path, [found[leaf] for leaf in self._leaves[path.text]])
            )
        if self._stamp:
            seconds, rest = found[self._stamp.seconds], found[self._stamp.nanoseconds]
            self._stamps.frombytes(_stamps(seconds, rest).tobytes())

    def finished(self) -> Values:
        """All that was read; nothing may be fed afterwards."""
        if self._codec is None and self._fault is None:
            self._open(())
        return Values(
            readable=np.frombuffer(self._readable, dtype=np.bool_),
            reason=self._reason,
            stamps=np.frombuffer(self._stamps, dtype=np.int64) if self._stamp else None,
            columns={text: column.finished() for text, column in self._columns.items()},
            faults=self._faults,
            fault=self._fault,
        )

    def _open(self, examples: Sequence[bytes]) -> None:
        """Finds the shape of the messages, and which of the paths lead to numbers in it."""
        try:
            self._codec = find_codec(self._channel, examples)
        except FieldError as error:
            self._fault = error
            self._faults = {path.text: error for path in self._wanted or ()}
            return
        root = self._codec.root
        wanted = all_paths(root, self._channel.topic) if self._wanted is None else self._wanted
        for path in wanted:
            try:
                check(root, path)
            except FieldError as error:
                self._faults[path.text] = error
            else:
                self._paths.append(path)
                self._leaves[path.text] = leaves(root, path)
        self._stamp = stamp_leaves(root)
        self._asked = list(dict.fromkeys(leaf for found in self._leaves.values() for leaf in found))
        if self._stamp:
            stamp = (self._stamp.seconds, self._stamp.nanoseconds)
            self._asked += [leaf for leaf in stamp if leaf not in self._asked]
        self._columns = {path.text: GrowingColumn() for path in self._paths}


def _value(path: MessagePath, found: Sequence[Column]) -> Column:
    if not path.derived:
        return found[0]
    x, y, z, w = (column.numbers for column in found)
    return Column(angle(path.derived, x, y, z, w), None)


def _stamps(seconds: Column, nanoseconds: Column) -> Integers:
    whole = _integers(seconds.numbers)
    return whole * 1_000_000_000 + _integers(nanoseconds.numbers)


def _integers(numbers: Array) -> Integers:
    """Whole numbers; 0 for what is none, or is too large for seconds."""
    safe = np.where(np.isfinite(numbers) & (np.abs(numbers) < LATEST_SECONDS), numbers, 0.0)
    return safe.astype(np.int64)
