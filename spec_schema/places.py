"""From a path in the data (`("field", "formula", "x")`) to a place in the text."""

import re
from collections.abc import Mapping as AbstractMapping
from dataclasses import dataclass, field
from typing import TypeAlias, final

from spec_schema.node import Entry, Listing, Mapping, Node, Scalar
from spec_schema.source import Source, Span
from spec_schema.wording import quoted

Path: TypeAlias = tuple[str | int, ...]

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")
_QUOTES = ('"', "'")


def dotted(path: Path) -> str:
    """The path in the notation of the diagnostics.

    >>> dotted(("arrows", "sketch", 0, "at", 1)), dotted(("traces", "*.mcap"))
    ('$.arrows.sketch[0].at[1]', "$.traces['*.mcap']")
    """
    return "$" + "".join(map(_step, path))


def as_written(path: Path, kept: AbstractMapping[Path, tuple[int, ...]]) -> Path:
    """The path in the text, of one in data where lists have lost items.

    kept: for each such list, by its path in the text, the indices of the items that are left.

    >>> as_written(("points", 1, "at", 0), {("points",): (0, 2)})
    ('points', 2, 'at', 0)
    """
    found: Path = ()
    for step in path:
        left = kept.get(found)
        known = left is not None and isinstance(step, int) and step < len(left)
        found = (*found, left[int(step)] if left is not None and known else step)
    return found


@final
@dataclass(frozen=True, slots=True)
class Places:
    """The places of all keys and values of one document.

    A path that goes further than what is written means the last thing that is written. Where lists
    have lost items, `kept` leads from the paths of what is left to the text (see `as_written`).
    renamed: how keys were written that were taken for others, by what they were taken for.
    """

    source: Source
    root: Node
    kept: AbstractMapping[Path, tuple[int, ...]] = field(default_factory=dict)
    renamed: AbstractMapping[Path, str] = field(default_factory=dict)

    def value(self, path: Path) -> Span:
        """Where the value stands; for an empty one, its key."""
        return self._walk(path)[1].span

    def key(self, path: Path) -> Span:
        """Where the key stands; for an item of a list, the item."""
        entry, node, _ = self._walk(path)
        return entry.key if entry else node.span

    def written(self, path: Path) -> Path:
        """The longest beginning of `path` that stands in the text."""
        return self._as_written(path)[: self._walk(path)[2]]

    def within(self, path: Path, start: int, end: int, *, key: bool = False) -> Span:
        """Where the characters `start` to `end` of a text, or of the last key of the path, stand.

        The whole value where the text on the page is not the text that was read: several lines,
        escapes, or a number.
        """
        entry, node, depth = self._walk(path)
        span = node.span
        text = node.text if isinstance(node, Scalar) else None
        if key and entry is not None:
            span, text = entry.key, str(self._as_written(path)[depth - 1])
        offset = self._offset(span, text)
        if offset is None or not 0 <= start <= end <= span.end_column - span.column:
            return span
        line, column = span.line, span.column + offset
        return Span(line, column + start, line, column + end)

    def dotted(self, path: Path) -> str:
        """The path in the notation of the diagnostics."""
        return dotted(self._as_written(path))

    def origin(self, path: Path) -> str:
        """`file:line:column` of the key, else of the item."""
        span = self.key(path)
        return f"{self.source.name}:{span.line}:{span.column}"

    def _walk(self, path: Path) -> tuple[Entry | None, Node, int]:
        entry: Entry | None = None
        node = self.root
        for depth, step in enumerate(self._as_written(path)):
            match node:
                case Mapping() if step in node.entries:
                    entry = node.entries[str(step)]
                    node = entry.value
                case Listing() if isinstance(step, int) and 0 <= step < len(node.items):
                    entry = None
                    node = node.items[step]
                case _:
                    return entry, node, depth
        return entry, node, len(path)

    def _as_written(self, path: Path) -> Path:
        items = as_written(path, self.kept)
        return tuple(self.renamed.get(items[: k + 1], step) for k, step in enumerate(items))

    def _offset(self, span: Span, text: str | None) -> int | None:
        """How many characters precede the text in its span; None where they differ."""
        if text is None or span.line != span.end_line:
            return None
        shown = self.source.line(span.line)[span.column - 1 : span.end_column - 1]
        if shown == text:
            return 0
        return 1 if shown in [f"{quote}{text}{quote}" for quote in _QUOTES] else None


def _step(part: str | int) -> str:
    if isinstance(part, int):
        return f"[{part}]"
    return f".{part}" if _WORD.fullmatch(part) else f"[{quoted(part)}]"
