"""Values out of CDR and ROS 1 messages, many messages at once.

Places within a message are fixed while its strings and sequences keep their lengths. So one
message of a group is walked field by field (`layout`), and all others that have the same lengths
at the same places are read with one strided gather per value.
"""

from collections import defaultdict
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

SLAB_BYTES = 1 << 25
# Beyond this many layouts of one size, looking for others alike costs more than it saves.
MOST_LAYOUTS = 64


def decode(
    payloads: Sequence[bytes], encoding: str, root: Struct, asked: Sequence[Steps]
) -> Decoded:
    """The asked-for leaves in all messages; one that can't be walked is marked not readable.

    encoding: `cdr` or `ros1`.
    """
    sink = _Sink(
        numbers=np.full((len(asked), len(payloads)), np.nan),
        texts={},
        readable=np.ones(len(payloads), dtype=np.bool_),
        reasons=[],
    )
    leaves: Leaves = tuple(enumerate(asked))
    for slab in _slabs(payloads, encoding):
        left = np.arange(slab.rows.size)
        layouts = 0
        while left.size:
            try:
                layout = find_layout(slab.payload(left[0]), encoding, root, leaves)
            except WireError as error:
                sink.readable[slab.rows[left[0]]] = False
                sink.reasons.append(str(error))
                left = left[1:]
                continue
            layouts += 1
            alike = slab.alike(left, layout) if layouts <= MOST_LAYOUTS else left == left[0]
            for leaf, slot in layout.slots.items():
                _take(slab, left[alike], leaf, slot, sink)
            left = left[~alike]
    columns = (
        Column(numbers, tuple(sink.texts[leaf]) if leaf in sink.texts else None)
        for leaf, numbers in enumerate(sink.numbers)
    )
    return Decoded(tuple(columns), sink.readable, sink.reasons[0] if sink.reasons else "")


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Sink:
    """Where decoded values go while the slabs are worked through."""

    numbers: Array
    texts: dict[int, list[str | None]]
    readable: Booleans
    reasons: list[str]


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Slab:
    """Rows (k,) of `payloads` of one size and byte order; their bytes as block (k, size)."""

    payloads: Sequence[bytes]
    rows: Integers
    block: npt.NDArray[np.uint8]
    order: str

    def payload(self, index: int) -> bytes:
        return self.payloads[int(self.rows[index])]

    def gather(self, chosen: Integers, slot: Slot) -> npt.NDArray[np.generic]:
        """The numbers at the slot in the chosen messages (c,)."""
        raw = self.block[:, slot.offset : slot.offset + slot.length]
        raw = raw if chosen.size == len(raw) else raw[chosen]
        return np.ascontiguousarray(raw).view(f"{self.order}{slot.code}")[:, 0]

    def alike(self, left: Integers, layout: Layout) -> Booleans:
        """Which of the messages `left` have the layout's lengths at its places."""
        alike = np.ones(left.size, dtype=np.bool_)
        for offset, value in layout.lengths:
            alike &= self.gather(left, Slot(offset, "u4", 4)) == value
        return alike


def _slabs(payloads: Sequence[bytes], encoding: str) -> Iterator[_Slab]:
    """Messages of one size and encapsulation together, at most `SLAB_BYTES` of them."""
    head = 2 if encoding == "cdr" else 0
    groups: defaultdict[tuple[int, bytes], list[int]] = defaultdict(list)
    for row, payload in enumerate(payloads):
        groups[len(payload), payload[:head]].append(row)
    for (size, start), rows in groups.items():
        count = max(1, SLAB_BYTES // max(size, 1))
        for begin in range(0, len(rows), count):
            some = rows[begin : begin + count]
            block = np.frombuffer(b"".join([payloads[row] for row in some]), dtype=np.uint8)
            order = ">" if start == b"\0\0" else "<"
            yield _Slab(payloads, np.array(some), block.reshape(len(some), size), order)


def _take(slab: _Slab, chosen: Integers, leaf: int, slot: Slot, sink: _Sink) -> None:
    rows = slab.rows[chosen]
    if slot.code:
        with np.errstate(invalid="ignore"):  # a signalling NaN is a NaN
            sink.numbers[leaf, rows] = slab.gather(chosen, slot)
        return
    texts = sink.texts.setdefault(leaf, [None] * len(slab.payloads))
    for row in rows:
        raw = slab.payloads[row][slot.offset : slot.offset + slot.length]
        texts[row] = raw.decode("utf-8", errors="replace")
