"""Edits made in the characters of a spec's text, and checked by reading it again."""

import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

from spec_schema.diagnostics import SpecError
from spec_schema.editing.edits import Edit, EditError, NewKey, NewLines, NewNumber, NewText
from spec_schema.editing.expected import after
from spec_schema.node import Listing, Mapping, Node, Scalar, plain
from spec_schema.places import Path
from spec_schema.source import Source, Span
from spec_schema.yaml_reader import read

NUMBER: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
LINE_END: Final = re.compile(r"\r\n|\n|\r")
UNSAFE: Final = re.compile(r"[,\[\]{}\r\n]")
"""What a text without quotes can't hold within braces."""
QUOTES: Final = ("'", '"')


def edited(source: Source, edits: tuple[Edit, ...]) -> Source:
    """The text with all edits made; everything else is as it was, to the character.

    Raises:
        EditError: a value is not written in a way that can be changed in place.
        SpecError: the text is no YAML of ours.
    """
    page = _Page(source, read(source))
    spots = [_spot(page, edit) for edit in edits if not isinstance(edit, NewKey)]
    keys: dict[Path, list[NewKey]] = {}
    for edit in edits:
        if isinstance(edit, NewKey):
            keys.setdefault(edit.path[:-1], []).append(edit)
    spots += [_keys(page, tuple(group)) for group in keys.values()]
    text = source.text
    for spot in sorted(spots, key=lambda spot: spot.start, reverse=True):
        text = text[: spot.start] + spot.text + text[spot.end :]
    made = Source(source.name, text)
    _check(page.root, made, edits)
    return made


def _check(root: Mapping, made: Source, edits: tuple[Edit, ...]) -> None:
    """What is read of the new text differs from the old by the edits alone."""
    path = edits[0].path if edits else ()
    try:
        found = plain(read(made))
    except SpecError as error:
        raise EditError(path, "it is written in a way that can't be changed in place") from error
    if found != after(plain(root), edits):
        raise EditError(path, "it is written in a way that can't be changed in place")


@final
@dataclass(frozen=True, slots=True)
class _Spot:
    """What replaces the characters from `start` up to but not including `end`."""

    start: int
    end: int
    text: str


@final
@dataclass(frozen=True)
class _Page:
    """A text with its tree, and the index at which each line begins."""

    source: Source
    root: Mapping

    @cached_property
    def lines(self) -> list[int]:
        """Where the lines begin."""
        return [0, *(match.end() for match in LINE_END.finditer(self.source.text))]

    def ends(self, span: Span) -> tuple[int, int]:
        """The indices of a span's first character and of the one behind its last."""
        start = self.lines[span.line - 1] + span.column - 1
        return start, self.lines[span.end_line - 1] + span.end_column - 1

    def node(self, path: Path) -> Node:
        """What stands at a path."""
        node: Node = self.root
        for step in path:
            match node:
                case Mapping() if step in node.entries:
                    node = node.entries[str(step)].value
                case Listing() if isinstance(step, int) and step < len(node.items):
                    node = node.items[step]
                case _:
                    raise EditError(path, "it does not stand in the text")
        return node

    def end_of_line(self, index: int) -> int:
        """Where the line of an index ends, before what ends it."""
        found = LINE_END.search(self.source.text, index)
        return found.start() if found else len(self.source.text)

    def line_of(self, index: int) -> int:
        """The number, from 0, of the line that an index lies in."""
        return bisect_right(self.lines, index) - 1

    @property
    def line_end(self) -> str:
        """How this text ends its lines."""
        found = LINE_END.search(self.source.text)
        return found.group() if found else "\n"


def _spot(page: _Page, edit: NewNumber | NewText | NewLines) -> _Spot:
    if isinstance(edit, NewLines):
        return _lines(page, edit)
    node = page.node(edit.path)
    if not isinstance(node, Scalar):
        raise EditError(edit.path, "it is no single value")
    start, end = page.ends(node.span)
    raw = page.source.text[start:end]
    inner = 1 if raw[:1] in QUOTES else 0
    if isinstance(edit, NewText):
        if raw[inner : len(raw) - inner] != node.text:
            raise EditError(edit.path, "it is written with escapes or in several lines")
        return _Spot(start + inner, end - inner, edit.text)
    blank = len(raw[inner:]) - len(raw[inner:].lstrip(" "))
    found = NUMBER.match(raw, inner + blank)
    if found is None:
        raise EditError(edit.path, "it does not begin with a number")
    return _Spot(start + found.start(), start + found.end(), edit.number)


def _lines(page: _Page, edit: NewLines) -> _Spot:
    """What replaces a value by lines below its key; what stands behind a value in one line stays.

    Lines between a key and what it holds stay, and those within what is replaced go with it.
    """
    parent = page.node(edit.path[:-1])
    if not isinstance(parent, Mapping) or edit.path[-1] not in parent.entries:
        raise EditError(edit.path, "it does not stand in the text")
    entry = parent.entries[str(edit.path[-1])]
    (start, end), text = page.ends(entry.value.span), page.source.text
    indent = " " * (entry.key.column + 1)
    lines = page.line_end.join(indent + line for line in edit.lines)
    last = page.end_of_line(end)
    if entry.value.span.line > entry.key.line:
        return _Spot(page.lines[page.line_of(start)], last, lines)
    behind = text[end:last].strip()
    start = len(text[:start].rstrip())
    return _Spot(start, last, f"{' ' * bool(behind)}{behind}{page.line_end}{lines}")


def _keys(page: _Page, edits: tuple[NewKey, ...]) -> _Spot:
    """New keys of one mapping, in their order."""
    path = edits[0].path[:-1]
    node = page.node(path)
    pairs = [f"{edit.path[-1]}: {edit.text}" for edit in edits]
    if isinstance(node, Scalar) and edits[0].bare:
        start, end = page.ends(node.span)
        value = _within_braces(page.source.text[start:end])
        return _Spot(start, end, f"{{{', '.join([f'{edits[0].bare}: {value}', *pairs])}}}")
    if not isinstance(node, Mapping) or not node.entries:
        raise EditError(path, "there is no mapping to add to")
    start, _ = page.ends(node.span)
    last = list(node.entries.values())[-1]
    if page.source.text[start] == "{":
        end = page.ends(last.value.span)[1]
        return _Spot(end, end, "".join(f", {pair}" for pair in pairs))
    return _below(page, node, pairs)


def _below(page: _Page, node: Mapping, pairs: list[str]) -> _Spot:
    """Lines of their own, below the last entry that is a value in one line."""
    single = [
        entry
        for entry in node.entries.values()
        if isinstance(entry.value, Scalar) and entry.value.span.line == entry.value.span.end_line
    ]
    if not single:
        raise EditError((), "there is no line to add a key below")
    entry = single[-1]
    indent = " " * (entry.key.column - 1)
    line = page.line_of(page.ends(entry.value.span)[1])
    text = "".join(f"{indent}{pair}{page.line_end}" for pair in pairs)
    if line + 1 < len(page.lines):
        at = page.lines[line + 1]
        return _Spot(at, at, text)
    at = len(page.source.text)
    return _Spot(at, at, page.line_end + text.removesuffix(page.line_end))


def _within_braces(raw: str) -> str:
    """A value as it may stand within braces: in quotes where it must."""
    if raw[:1] in QUOTES or not UNSAFE.search(raw):
        return raw
    doubled = raw.replace("'", "''")
    return f"'{doubled}'"
