"""A YAML parser's complaint, said for people: what is missing, where it began, what to write."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias, final

from spec_schema.source import Source, Span
from spec_schema.wording import quoted

Position: TypeAlias = tuple[int, int]
"""A line and a column, from 1."""


@final
@dataclass(frozen=True, slots=True)
class Complaint:
    """What the parser says: the problem, where it noticed, and where the thing at fault began.

    last_quoted: the last text in quotes that it read.
    """

    problem: str
    noticed: Position
    began: Position
    last_quoted: Span


@final
@dataclass(frozen=True, slots=True)
class Explanation:
    """What to tell the user."""

    message: str
    span: Span
    help: str


def explain(complaint: Complaint, source: Source) -> Explanation:
    """The complaint of either of PyYAML's parsers (they word it differently) in our words."""
    late = complaint.last_quoted
    if late.line < late.end_line == complaint.noticed[0]:
        return _late_quote(late)
    for words, explanation in _EXPLANATIONS:
        if any(word in complaint.problem for word in words):
            return explanation(complaint, source)
    message = f"this can't be read as YAML: {complaint.problem}"
    return Explanation(message, _character(source, complaint.noticed), "put text in quotes")


def _late_quote(text: Span) -> Explanation:
    return Explanation(
        f"the text in quotes that begins here ends only in line {text.end_line}",
        Span(text.line, text.column, text.line, text.column + 1),
        "close the quote in the line in which it opens",
    )


def _unclosed_quote(complaint: Complaint, source: Source) -> Explanation:
    return Explanation(
        "the quote that opens here is never closed",
        _character(source, complaint.began),
        "close the text with the same quote",
    )


def _stray_colon(complaint: Complaint, source: Source) -> Explanation:
    return Explanation(
        "a ':' where no key can end",
        _character(source, complaint.noticed),
        "if it belongs to a text, put the text in quotes;\n"
        "if it ends a key, indent the key like those beside it",
    )


def _no_colon(complaint: Complaint, source: Source) -> Explanation:
    return Explanation(
        "a line that is neither 'key: value' nor an item of a list",
        _rest_of_line(source, complaint.began),
        "write 'key: value', with a space after the ':'",
    )


def _strange_start(complaint: Complaint, source: Source) -> Explanation:
    span = _character(source, complaint.noticed)
    character = source.line(span.line)[span.column - 1 :][:1]
    return Explanation(
        f"no value can start with {quoted(character)}", span, "put the text in quotes"
    )


def _strange_escape(complaint: Complaint, source: Source) -> Explanation:
    return Explanation(
        "a backslash in double quotes starts an escape, and this is none",
        _character(source, complaint.noticed),
        "write \\\\ for a backslash, or use single quotes",
    )


def _no_value(complaint: Complaint, source: Source) -> Explanation:
    span = _character(source, complaint.noticed)
    return Explanation("a value is expected here", span, "write a value, or put text in quotes")


def _unclosed_bracket(complaint: Complaint, source: Source) -> Explanation:
    span = _character(source, complaint.began)
    opened = source.line(span.line)[span.column - 1 :][:1]
    kind, closing = ("mapping", "}") if opened == "{" else ("list", "]")
    line, column = complaint.noticed
    return Explanation(
        f"the {kind} that opens here lacks its '{closing}', or a ',' between two entries",
        span,
        f"noticed in line {line}, column {column}; write '{closing}' or ',' before it",
    )


def _misplaced(complaint: Complaint, source: Source) -> Explanation:
    line, column = complaint.began
    noticed_line, noticed_column = complaint.noticed
    before = source.line(noticed_line)[: noticed_column - 1].strip()
    span = _rest_of_line(source, complaint.noticed)
    if before:
        return Explanation(
            f"nothing can follow {quoted(before[-1])} on this line",
            span,
            "put the whole value in quotes, or begin a new line",
        )
    what = (
        "an item of the list"
        if source.line(line)[column - 1 :][:1] == "-"
        else "a key of the mapping"
    )
    return Explanation(
        f"{what} above is expected here, and this is none",
        span,
        f"what belongs together starts in one column: here column {column}, as in line {line}",
    )


def _character(source: Source, at: Position) -> Span:
    """The character at a position; where the file ends before it, the last one there is."""
    line, column = at
    while line > 1 and not source.line(line):
        line -= 1
        column = len(source.line(line))
    column = max(1, min(column, len(source.line(line))))
    return Span(line, column, line, column + 1)


def _rest_of_line(source: Source, at: Position) -> Span:
    start = _character(source, at)
    text = source.line(start.line)[start.column - 1 :].split(" #")[0].rstrip()
    return Span(start.line, start.column, start.line, start.column + max(1, len(text)))


_EXPLANATIONS: tuple[tuple[tuple[str, ...], Callable[[Complaint, Source], Explanation]], ...] = (
    (("',' or",), _unclosed_bracket),
    (("end of stream", "document separator"), _unclosed_quote),
    (("mapping values are not allowed",), _stray_colon),
    (("could not find expected ':'",), _no_colon),
    (("expected key", "block end", "'-' indicator"), _misplaced),
    (("cannot start any token",), _strange_start),
    (("escape", "hexdecimal", "hexadecimal"), _strange_escape),
    (("node content",), _no_value),
)
"""By what words of PyYAML's the first that fits is known; it does write "hexdecimal"."""
