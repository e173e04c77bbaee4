"""What is wrong, where, by which rule, and what to write instead: data first, text last."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import final
from unicodedata import combining, east_asian_width

from spec_schema.source import Source, Span

MOST = 100
"""How many diagnostics of one text are listed."""

WIDEST = 100
"""How many characters of a line are shown at most."""


@final
class Severity(StrEnum):
    """Whether a diagnostic stops the compiler."""

    ERROR = "error"
    WARNING = "warning"


@final
@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding. `path` is in the notation `$.fields[0].gain`; `label` stands after the carets.

    `span` is None where a file as a whole is meant.
    """

    code: str
    severity: Severity
    message: str
    source: Source
    span: Span | None
    path: str = ""
    help: str = ""
    label: str = ""

    @property
    def place(self) -> str:
        """`file:line:column`, as editors and CI understand it."""
        if self.span is None:
            return self.source.name
        return f"{self.source.name}:{self.span.line}:{self.span.column}"

    def as_json(self) -> dict[str, object]:
        """The flat record that `specc check --format json` prints."""
        span = self.span or Span(1, 1, 1, 1)
        return {
            "code": self.code,
            "severity": str(self.severity),
            "message": self.message,
            "file": self.source.name,
            "line": span.line,
            "column": span.column,
            "end_line": span.end_line,
            "end_column": span.end_column,
            "path": self.path,
            "help": self.help,
        }


@final
class SpecError(Exception):
    """A user's text that can't be used, with everything that is wrong with it."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = in_file_order(diagnostics)
        assert self.diagnostics, "what is refused without a word can't be mended"
        super().__init__(render(self.diagnostics))

    def __reduce__(self) -> tuple[type["SpecError"], tuple[tuple[Diagnostic, ...]]]:
        """So that it can be raised in another process."""
        return type(self), (self.diagnostics,)


def in_file_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Sorted by file, place and code, without repetitions."""
    nowhere = Span(0, 0, 0, 0)

    def place(d: Diagnostic) -> tuple[str, Span, str, str]:
        return d.source.name, d.span or nowhere, d.code, d.message

    return tuple(sorted(set(diagnostics), key=place))


def first_ones(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """The first `MOST` in file order; where there are more, a last one says so."""
    found = in_file_order(diagnostics)
    if len(found) <= MOST:
        return found
    message = "the mistakes from here on are not listed"
    end = replace(found[MOST], code="S016", message=message, path="", help="", label="")
    return (*found[:MOST], end)


def render(diagnostics: Iterable[Diagnostic]) -> str:
    """All diagnostics as text for people, with a last line that counts them."""
    found = in_file_order(diagnostics)
    if not found:
        return ""
    return "\n\n".join([*map(render_one, found), summary(found)])


def render_one(diagnostic: Diagnostic) -> str:
    """One diagnostic: the place and the message, the line with carets, the path, the help."""
    head = f"{diagnostic.place}: {diagnostic.severity}[{diagnostic.code}]: {diagnostic.message}"
    lines = [head, *_excerpt(diagnostic)]
    margin = " " * _gutter(diagnostic)
    if diagnostic.path:
        lines.append(f"{margin}= at: {diagnostic.path}")
    if diagnostic.help:
        first, *more = diagnostic.help.splitlines()
        lines.append(f"{margin}= help: {first}")
        lines.extend(f"{margin}        {line}" for line in more)
    return "\n".join(lines)


def summary(diagnostics: Iterable[Diagnostic]) -> str:
    """`2 errors and 1 warning in specs/reach.yaml`."""
    found = tuple(diagnostics)
    counts = [
        _count(sum(d.severity is severity for d in found), str(severity))
        for severity in Severity
        if any(d.severity is severity for d in found)
    ]
    files = sorted({d.source.name for d in found if d.span is not None or "=" not in d.source.name})
    if not files:  # a value on the command line, `mu=9`, is no file
        return " and ".join(counts)
    where = files[0] if len(files) == 1 else f"{len(files)} files"
    return f"{' and '.join(counts)} in {where}"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")


def _gutter(diagnostic: Diagnostic) -> int:
    return len(str(diagnostic.span.line)) + 1 if diagnostic.span else 2


def _excerpt(diagnostic: Diagnostic) -> list[str]:
    span = diagnostic.span
    if span is None:
        return []
    text = diagnostic.source.line(span.line)
    start = span.column - 1
    end = span.end_column - 1 if span.end_line == span.line else len(text)
    shown = _window(text, start, end)
    indent = " " * _width(shown.before)
    carets = "^" * max(1, _width(shown.meant))
    margin = " " * _gutter(diagnostic)
    label = f" {diagnostic.label}" if diagnostic.label else ""
    line = f"{shown.before}{shown.meant}{shown.after}".rstrip()
    return [f"{margin}|", f"{span.line} | {line}".rstrip(), f"{margin}| {indent}{carets}{label}"]


@final
@dataclass(frozen=True, slots=True)
class _Window:
    """The part of a line that is shown: what is meant, and what stands around it."""

    before: str
    meant: str
    after: str


def _window(text: str, start: int, end: int) -> _Window:
    """At most `WIDEST` characters of a line around those that are meant."""
    first = 0 if len(text) <= WIDEST or start <= WIDEST // 2 else start - WIDEST // 4
    last = first + WIDEST
    before, meant, after = text[first:start], text[start : min(end, last)], text[end:last]
    return _Window(
        _visible(f"…{before}" if first else before),
        _visible(meant),
        _visible(f"{after}…" if last < len(text) else after),
    )


def _visible(text: str) -> str:
    """The text with nothing in it that moves a terminal's cursor."""
    return "".join(c if c.isprintable() else " " if c == "\t" else "�" for c in text)


def _width(text: str) -> int:
    """How many columns of a terminal the text fills."""
    return sum(0 if combining(c) else 2 if east_asian_width(c) in {"W", "F"} else 1 for c in text)
