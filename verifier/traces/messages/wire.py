"""Values out of CDR and ROS 1 messages, many messages at once.

Places within a message are fixed while its strings and sequences keep their lengths. So one
message of a group is walked field by field (`layout`), and all others that have the same lengths
at the same places are read with one strided gather per value.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
import numpy.typing as npt

from runtime.arrays import Array, Booleans, Integers
from verifier.traces.messages.columns import Column, Decoded
from verifier.traces.messages.definitions import Struct
from verifier.traces.messages.layout import Layout, Leaves, Slot, WireError, find_layout
from verifier.traces.messages.paths import Steps

# Beyond this many layouts of one size, looking for others alike costs more than it saves.
MOST_LAYOUTS = 64


def decode(
    payloads: Sequence[bytes], encoding: str, root: Struct, asked: Sequence[Steps]
) -> Decoded:
    """The asked-for leaves in all messages; one that can't be walked is marked not readable.

    encoding: `cdr`, `ros1` or `ulog`.
    """
    sink = _Sink(
        numbers=[np.full(len(payloads), np.nan) for _ in asked],
        texts={},
        readable=np.ones(len(payloads), dtype=np.bool_),
        reasons=[],
    )
    leaves: Leaves = tuple(enumerate(asked))
    batch = _batch(payloads)
    for group in _groups(batch, encoding):
        left = group.rows
        layouts = 0
        while left.size:
            try:
                layout = find_layout(payloads[int(left[0])], encoding, root, leaves)
            except WireError as error:
                sink.readable[left[0]] = False
                sink.reasons.append(str(error))
                left = left[1:]
                continue
            layouts += 1
            alike = group.alike(left, layout) if layouts <= MOST_LAYOUTS else left == left[0]
            chosen = left if alike.all() else left[alike]
            for leaf, slot in layout.slots.items():
                _take(group, chosen, leaf, slot, sink)
            left = left[~alike]
    columns = (
        Column(numbers, tuple(sink.texts[leaf]) if leaf in sink.texts else None)
        for leaf, numbers in enumerate(sink.numbers)
    )
    return Decoded(tuple(columns), sink.readable, sink.reasons[0] if sink.reasons else "")


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Sink:
    """Where decoded values go while the groups are worked through."""

    numbers: list[Array]
    texts: dict[int, list[str | None]]
    readable: Booleans
    reasons: list[str]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Batch:
    """Messages, one behind the other: where each begins (T,), and its size (T,) in bytes."""

    payloads: Sequence[bytes]
    data: bytes
    begins: Integers
    sizes: Integers

    def gather(self, rows: Integers, offset: int, kind: str) -> npt.NDArray[np.generic]:
        """The numbers of numpy's `kind` at the offset in the messages `rows` (c,)."""
        dtype = np.dtype(kind)
        # Every place in the bytes as a number, whatever its alignment; only `rows` are looked at.
        places = len(self.data) - dtype.itemsize + 1
        every = np.ndarray((max(places, 0),), dtype=dtype, buffer=self.data, strides=(1,))
        return every[self.begins[rows] + offset]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Group:
    """Rows (k,) of a batch, of messages of one size and byte order."""

    batch: _Batch
    rows: Integers
    order: str

    def gather(self, rows: Integers, slot: Slot) -> npt.NDArray[np.generic]:
        return self.batch.gather(rows, slot.offset, f"{self.order}{slot.code}")

    def alike(self, left: Integers, layout: Layout) -> Booleans:
        """Which of the messages `left` have the layout's lengths at its places."""
        alike = np.ones(left.size, dtype=np.bool_)
        for offset, value in layout.lengths:
            alike &= self.gather(left, Slot(offset, "u4", 4)) == value
        return alike


def _batch(payloads: Sequence[bytes]) -> _Batch:
    sizes = np.fromiter(map(len, payloads), dtype=np.int64, count=len(payloads))
    return _Batch(payloads, b"".join(payloads), np.cumsum(sizes) - sizes, sizes)


def _groups(batch: _Batch, encoding: str) -> Iterator[_Group]:
    """Messages of one size and encapsulation together."""
    kinds = batch.sizes << 16
    if encoding == "cdr":
        headed = np.flatnonzero(batch.sizes >= 2)
        kinds[headed] += batch.gather(headed, 0, ">u2").astype(np.int64)
    for kind in np.unique(kinds):
        rows = np.flatnonzero(kinds == kind)
        # Of the encapsulations that are read, the odd ones are little-endian.
        big = encoding == "cdr" and kind % 2 == 0
        yield _Group(batch, rows, ">" if big else "<")


def _take(group: _Group, rows: Integers, leaf: int, slot: Slot, sink: _Sink) -> None:
    if slot.code:
        with np.errstate(invalid="ignore"):  # a signalling NaN is a NaN
            sink.numbers[leaf][rows] = group.gather(rows, slot)
        return
    payloads = group.batch.payloads
    texts = sink.texts.setdefault(leaf, [None] * len(payloads))
    shared: dict[bytes, str] = {}
    for row in rows.tolist():
        raw = payloads[row][slot.offset : slot.offset + slot.length]
        if raw not in shared:
            shared[raw] = raw.decode("utf-8", errors="replace")
        texts[row] = shared[raw]
