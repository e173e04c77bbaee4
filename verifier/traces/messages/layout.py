"""Where the fields of one CDR or ROS 1 message stand, found by walking it along its definition.

CDR: OMG formal/02-06-51, 15.3, in the little- and big-endian encapsulations 0x0001 and 0x0000;
a number is aligned to its size, counted from the end of the four encapsulation bytes. XCDR2 of
final types (OMG DDS-XTypes 1.3, 7.4.3), encapsulations 0x0007 and 0x0006, aligns to four bytes at
most, and puts the size in bytes before lists of anything but numbers. ROS 1 and ULog pack
everything without padding, little-endian.
"""

import struct
from dataclasses import dataclass
from typing import TypeAlias, assert_never, final

from verifier.traces.messages.definitions import Many, Node, Number, Struct, Text
from verifier.traces.messages.paths import Steps

DEEPEST = 64

Leaves: TypeAlias = tuple[tuple[int, Steps], ...]


@final
class WireError(Exception):
    """A message that its definition doesn't describe; the message says why."""


@final
@dataclass(frozen=True, slots=True)
class Packing:
    """How a message's bytes are laid out after its first `head` bytes.

    align: numbers stand at multiples of their size, but of no more than this. sized: lists of
    anything but numbers have their size in bytes before them. spare: how many bytes may be left
    at the end: CDR writers may pad it to four bytes, PX4 to eight.
    """

    head: int
    align: int
    sized: bool
    order: str
    spare: int

    @property
    def aligned(self) -> bool:
        """Whether this is CDR, of either version."""
        return self.align > 1


_PACKED = {
    "ros1": Packing(0, align=1, sized=False, order="<", spare=0),
    "ulog": Packing(0, align=1, sized=False, order="<", spare=7),
}
_CDR = {
    b"\0\0": Packing(4, align=8, sized=False, order=">", spare=3),
    b"\0\1": Packing(4, align=8, sized=False, order="<", spare=3),
    b"\0\6": Packing(4, align=4, sized=True, order=">", spare=3),
    b"\0\7": Packing(4, align=4, sized=True, order="<", spare=3),
}


@final
@dataclass(frozen=True, slots=True)
class Slot:
    """Where a leaf stands: numpy's code, or empty for a text of `length` bytes."""

    offset: int
    code: str
    length: int


@final
@dataclass(frozen=True, slots=True)
class Layout:
    """slots: where the leaves stand; a leaf that the message lacks is missing.

    lengths: (offset, value) of the lengths of strings and sequences before the last of them, on
    which these places depend.
    """

    slots: dict[int, Slot]
    lengths: tuple[tuple[int, int], ...]


def packing(payload: bytes, encoding: str) -> Packing:
    """How the message is packed; raises WireError for an encapsulation other than plain CDR."""
    if encoding in _PACKED:
        return _PACKED[encoding]
    found = _CDR.get(payload[:2])
    if found is None or len(payload) < found.head:
        raise WireError(f"encapsulation 0x{payload[:2].hex()} is not plain CDR or XCDR2")
    return found


def find_layout(payload: bytes, encoding: str, root: Struct, leaves: Leaves) -> Layout:
    """Where the leaves stand in this message; raises WireError."""
    walker = _Walker(payload, packing(payload, encoding))
    walker.visit(root, leaves, 0)
    spare = len(payload) - walker.position
    if not 0 <= spare <= walker.packing.spare:
        raise WireError(f"{len(payload)} bytes, its definition makes {walker.position} of it")
    return Layout(walker.slots, tuple(walker.lengths[: walker.needed]))


class _Walker:
    """A position in a message, moved along its definition."""

    def __init__(self, payload: bytes, packing: Packing) -> None:
        self.payload = payload
        self.packing = packing
        self.position = packing.head
        self.slots: dict[int, Slot] = {}
        self.lengths: list[tuple[int, int]] = []
        self.needed = 0
        # Every step but those into empty types takes a byte, so honest messages stay far below.
        self.steps_left = 4 * len(payload) + 10_000

    def visit(self, node: Node, leaves: Leaves, depth: int) -> None:
        self.steps_left -= 1
        if depth > DEEPEST or self.steps_left < 0:
            raise WireError("its definition nests without end")
        match node:
            case Number():
                self.number(node, leaves)
            case Text():
                self.text(leaves)
            case Many():
                self.many(node, leaves, depth)
            case Struct():
                if not node.fields and self.packing.aligned:
                    self.advance(1)  # ROS 2 gives an empty type one unused byte
                for name, child in node.fields:
                    self.visit(child, _below(leaves, name), depth + 1)
            case _:
                assert_never(node)

    def number(self, node: Number, leaves: Leaves) -> None:
        self.align(node.size)
        start = self.advance(node.size)
        self.found(leaves, Slot(start, node.code, node.size))

    def text(self, leaves: Leaves) -> None:
        length = self.length()
        start = self.advance(length)
        # CDR counts the closing zero byte.
        letters = length - 1 if self.packing.aligned and length else length
        self.found(leaves, Slot(start, "", letters))

    def many(self, node: Many, leaves: Leaves, depth: int) -> None:
        if self.packing.sized and not isinstance(node.item, Number):
            self.length()
        count = self.length() if node.count is None else node.count
        if count > len(self.payload):
            raise WireError(f"it claims a sequence of {count} items in {len(self.payload)} bytes")
        if isinstance(node.item, Number):
            self.numbers(node.item, count, leaves)
            return
        wanted = {i: _below(leaves, i) + _below(leaves, i - count) for i in _indices(leaves, count)}
        if leaves:
            self.needed = len(self.lengths)
        for i in range(count):
            self.visit(node.item, wanted.get(i, ()), depth + 1)

    def numbers(self, item: Number, count: int, leaves: Leaves) -> None:
        if leaves:
            self.needed = len(self.lengths)
        if count:
            self.align(item.size)
        start = self.advance(item.size * count)
        for i in _indices(leaves, count):
            slot = Slot(start + i * item.size, item.code, item.size)
            self.found(_below(leaves, i) + _below(leaves, i - count), slot)

    def found(self, leaves: Leaves, slot: Slot) -> None:
        for leaf, steps in leaves:
            if not steps:
                self.slots[leaf] = slot
                self.needed = len(self.lengths)

    def align(self, size: int) -> None:
        if self.packing.aligned:
            head, size = self.packing.head, min(size, self.packing.align)
            self.position = head + (self.position - head + size - 1) // size * size

    def advance(self, size: int) -> int:
        start = self.position
        self.position += size
        if self.position > len(self.payload):
            raise WireError(f"it ends after {len(self.payload)} bytes, in the middle of a field")
        return start

    def length(self) -> int:
        self.align(4)
        start = self.advance(4)
        (value,) = struct.unpack_from(f"{self.packing.order}I", self.payload, start)
        self.lengths.append((start, int(value)))
        return int(value)


def _below(leaves: Leaves, step: str | int) -> Leaves:
    return tuple((leaf, steps[1:]) for leaf, steps in leaves if steps and steps[0] == step)


def _indices(leaves: Leaves, count: int) -> tuple[int, ...]:
    """The items of a list of `count` that the leaves reach into, from its start or its end."""
    asked = {steps[0] for _, steps in leaves if steps and isinstance(steps[0], int)}
    inside = {
        i + count if i < 0 else i for i in asked if isinstance(i, int) and -count <= i < count
    }
    return tuple(sorted(inside))
