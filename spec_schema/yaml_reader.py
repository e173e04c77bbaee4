"""YAML text to a tree with places: the strict YAML of specs, and the one file that imports yaml.

The tree is built from the parser's events, which come one by one whatever the depth of the text:
the reader stops at its own limit, before anything else overflows. Refused, each with its place:
duplicate keys, anchors and aliases, tags, keys that are not text, directives, several documents.
"""

import re
from collections.abc import Iterator
from typing import Any, TypeAlias, final

import yaml

from spec_schema.characters import check_characters
from spec_schema.diagnostics import MOST, Diagnostic, Severity, SpecError, first_ones
from spec_schema.node import Entry, Listing, Mapping, Node, Scalar
from spec_schema.places import Path, dotted
from spec_schema.scalars import resolve
from spec_schema.source import Source, Span
from spec_schema.wording import described, quoted
from spec_schema.yaml_syntax import Complaint, Position, explain

DEEPEST = 64
"""How many lists and mappings may stand inside one another."""

Event: TypeAlias = Any  # the two parsers' events have no type in common

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_WORD = re.compile(r"[^\s,\[\]{}]+")
_FIX_ALIAS = "write the value out: a spec says each thing where it is"
_FIX_BRACES = "put text that starts with a bracket or brace in quotes"
_FIX_DIRECTIVE = "remove the line: scalars are those of YAML 1.2 anyway"
_FIRST_LINES = "start with the lines 'specc: 1' and 'kind: behavior', or the kind that belongs here"


def read(source: Source) -> Mapping:
    """The document as a tree; raises SpecError with all that is wrong with it as YAML."""
    problems = check_characters(source)
    if problems:
        raise SpecError(problems)
    reader = _Reader(source)
    root = reader.document()
    if reader.problems or not isinstance(root, Mapping):
        raise SpecError(first_ones(reader.problems))
    return root


@final
class _Stop(Exception):  # noqa: N818  # no error: there is enough to say
    """The rest of the text isn't looked at."""


@final
class _Reader:
    """Turns the events of one text into nodes, and gathers the problems on the way."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.problems: list[Diagnostic] = []
        self._events: Iterator[Event] = yaml.parse(source.text, Loader=_LOADER)
        self._quoted = Span(0, 0, 0, 0)

    def document(self) -> Node | None:
        """The one document of the text, or None where there is none to read."""
        try:
            return self._document()
        except _Stop:
            return None
        except yaml.YAMLError as error:
            self._syntax(error)
            return None

    def _document(self) -> Node | None:
        next(self._events)  # the start of the stream
        start = next(self._events)
        if isinstance(start, yaml.StreamEndEvent):
            self._refuse("S007", "the file is empty", None, help_=_FIRST_LINES)
            return None
        self._directives(start)
        root = self._node(next(self._events), ())
        next(self._events)  # the end of the document
        self._several(next(self._events))
        if not isinstance(root, Mapping):
            self._no_mapping(root)
        return root

    def _node(self, event: Event, path: Path) -> Node:
        if isinstance(event, yaml.AliasEvent):
            span = _span(event)
            message = f"the alias *{event.anchor}: aliases are not part of the language"
            self._refuse("S003", message, span, path, _FIX_ALIAS)
            return Scalar(None, "", span)
        self._properties(event, path)
        if isinstance(event, yaml.ScalarEvent):
            if event.style in {"'", '"'}:
                self._quoted = _span(event)
            value = event.value if event.style else resolve(event.value)
            return Scalar(value, event.value, _span(event))
        if len(path) >= DEEPEST:
            message = f"more than {DEEPEST} lists and mappings inside one another"
            self._refuse("S013", message, _span(event), help_="no spec needs more than a few")
            raise _Stop
        if isinstance(event, yaml.SequenceStartEvent):
            return self._listing(event, path)
        return self._mapping(event, path)

    def _listing(self, start: Event, path: Path) -> Listing:
        items: list[Node] = []
        for event in self._events:
            if isinstance(event, yaml.SequenceEndEvent):
                return Listing(
                    tuple(items), _around(start, event, items[-1].span if items else None)
                )
            items.append(self._node(event, (*path, len(items))))
        raise AssertionError("the parser ends what it begins")

    def _mapping(self, start: Event, path: Path) -> Mapping:
        entries: dict[str, Entry] = {}
        last: Span | None = None
        for event in self._events:
            if isinstance(event, yaml.MappingEndEvent):
                return Mapping(entries, _around(start, event, last))
            key = self._node(event, (*path, "?"))
            name = self._name(key, event, path)
            value = self._node(next(self._events), (*path, name or "?"))
            if _is_absent(value):
                value = Scalar(None, "", key.span)
            last = value.span
            if name is not None:
                self._enter(entries, name, Entry(key.span, value), path)
        raise AssertionError("the parser ends what it begins")

    def _enter(self, entries: dict[str, Entry], name: str, entry: Entry, path: Path) -> None:
        if name in entries:
            first = entries[name].key
            message = f"the key {quoted(name)} stands twice in one mapping"
            help_ = f"it stands first in line {first.line}, column {first.column}; remove one"
            self._refuse("S002", message, entry.key, (*path, name), help_)
            return
        entries[name] = entry

    def _name(self, key: Node, event: Event, path: Path) -> str | None:
        """The text of a key; None where it is none."""
        if isinstance(event, yaml.AliasEvent):
            return None
        if not isinstance(key, Scalar):
            kind = "mapping" if isinstance(key, Mapping) else "list"
            message = f"a {kind} as a key: keys are names"
            self._refuse("S005", message, key.span, path, _FIX_BRACES)
            return None
        if key.text == "<<" and key.value == "<<" and not event.style:
            message = "the merge key '<<' is not part of the language"
            self._refuse("S003", message, key.span, path, _FIX_ALIAS)
            return None
        if isinstance(key.value, str):
            return key.value
        message = f"a key is text, not {described(key.value)}"
        help_ = (
            f'put it in quotes: "{key.text}": ...' if key.text else "write a name before the ':'"
        )
        self._refuse("S005", message, key.span, path, help_)
        return None

    def _properties(self, event: Event, path: Path) -> None:
        """Refuse anchors and tags."""
        if event.anchor is not None:
            span = self._property(event, "&")
            message = f"the anchor {quoted(event.anchor)}: anchors are not part of the language"
            self._refuse("S003", message, span, path, _FIX_ALIAS)
        if getattr(event, "tag", None) is not None:
            message = "a tag: tags are not part of the language"
            self._refuse("S004", message, self._property(event, "!"), path, "remove it")

    def _property(self, event: Event, sign: str) -> Span:
        """Where an anchor or a tag stands before its value."""
        line, column = _position(event.start_mark)
        text = self.source.line(line)
        start = max(text.find(sign, column - 1), column - 1)
        word = _WORD.match(text, start)
        return Span(line, start + 1, line, (word.end() if word else start + 1) + 1)

    def _directives(self, start: Event) -> None:
        for number in range(1, start.end_mark.line + 2):
            line = self.source.line(number)
            if line.startswith("%"):
                span = Span(number, 1, number, len(line) + 1)
                self._refuse(
                    "S014", "a YAML directive: a spec has none", span, help_=_FIX_DIRECTIVE
                )

    def _several(self, event: Event) -> None:
        if isinstance(event, yaml.DocumentStartEvent):
            message = "a second document begins here; a file holds one"
            self._refuse("S006", message, _span(event), help_="put it into a file of its own")

    def _no_mapping(self, root: Node) -> None:
        if _is_absent(root):
            self._refuse("S007", "the file is empty", None, help_=_FIRST_LINES)
            return
        got = described(root.value) if isinstance(root, Scalar) else "a list"
        message = f"a spec is a mapping of keys to values, not {got}"
        self._refuse("S008", message, root.span, help_=_FIRST_LINES)

    def _syntax(self, error: yaml.YAMLError) -> None:
        mark = getattr(error, "problem_mark", None)
        context = getattr(error, "context_mark", None) or mark
        complaint = Complaint(
            getattr(error, "problem", None) or "",
            _position(mark) if mark else (1, 1),
            _position(context) if context else (1, 1),
            self._quoted,
        )
        found = explain(complaint, self.source)
        self._refuse("S001", found.message, found.span, help_=found.help)

    def _refuse(
        self,
        code: str,
        message: str,
        span: Span | None,
        path: Path = (),
        help_: str = "",
    ) -> None:
        if len(self.problems) > MOST:
            raise _Stop
        where = dotted(path) if path else ""
        self.problems.append(
            Diagnostic(code, Severity.ERROR, message, self.source, span, where, help_)
        )


def _position(mark: Any) -> Position:
    return mark.line + 1, mark.column + 1


def _span(event: Event) -> Span:
    return Span(*_position(event.start_mark), *_position(event.end_mark))


def _around(start: Event, end: Event, last: Span | None) -> Span:
    """A list or mapping: to its bracket, or to the end of its last value in block style."""
    first = _position(start.start_mark)
    if last is None or end.end_mark.index > end.start_mark.index:
        return Span(*first, *_position(end.end_mark))
    return Span(*first, last.end_line, last.end_column)


def _is_absent(node: Node) -> bool:
    """Whether nothing at all was written where a value belongs."""
    return isinstance(node, Scalar) and node.value is None and not node.text
