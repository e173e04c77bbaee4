"""A YAML document as a tree in which every key and every value knows its place."""

from dataclasses import dataclass
from typing import TypeAlias, final

from spec_schema.scalars import ScalarValue
from spec_schema.source import Span

Plain: TypeAlias = "ScalarValue | list[Plain] | dict[str, Plain]"


@final
@dataclass(frozen=True, slots=True)
class Scalar:
    """One value. `text` is what its quotes hold, or what stands there without quotes."""

    value: ScalarValue
    text: str
    span: Span


@final
@dataclass(frozen=True, slots=True)
class Listing:
    """A YAML sequence."""

    items: "tuple[Node, ...]"
    span: Span


@final
@dataclass(frozen=True, slots=True)
class Entry:
    """A key of a mapping, and its value."""

    key: Span
    value: "Node"


@final
@dataclass(frozen=True, slots=True)
class Mapping:
    """A YAML mapping, in the order of the file."""

    entries: dict[str, Entry]
    span: Span


Node: TypeAlias = Scalar | Listing | Mapping


def plain(node: Node) -> Plain:
    """The data alone, without places."""
    match node:
        case Scalar():
            return node.value
        case Listing():
            return [plain(item) for item in node.items]
        case Mapping():
            return {name: plain(entry.value) for name, entry in node.entries.items()}
