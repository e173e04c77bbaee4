"""What a spec's text may be made of: UTF-8, at most 1 MiB, no tabs, no control characters."""

import re
from collections.abc import Iterator

from spec_schema.diagnostics import Diagnostic, Severity
from spec_schema.source import Source, Span

LARGEST = 2**20
"""Bytes of a spec. Larger data belongs into a file beside it (`grid: {file: ...}`)."""

_TAB = re.compile(r"\t")
# What YAML 1.2 calls printable, less the line ends that only YAML 1.1 knows (NEL, LS, PS): editors
# and readers disagree on the line numbers after those.
_FORBIDDEN = re.compile(
    r"[^\t\n\r\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"
)
_LINE_END = re.compile(r"\r\n|\n|\r")


def decode(name: str, data: bytes) -> tuple[Source, tuple[Diagnostic, ...]]:
    """The text of a file, and why it can't be used.

    A byte order mark is dropped. Of a text that is not UTF-8 the readable beginning is kept.
    """
    try:
        return Source(name, data.decode("utf-8-sig")), ()
    except UnicodeDecodeError as error:
        source = Source(name, data.decode("utf-8-sig", errors="replace"))
        before = data[: error.start].decode("utf-8-sig")
        message = f"the file is not UTF-8 text: byte 0x{data[error.start]:02x} stands here"
        help_ = "save the file as UTF-8"
        return source, (_error(source, "S011", message, span_at(before, len(before)), help_),)


def too_large(source: Source, size: int) -> Diagnostic:
    """A file beyond the limit, which was not read any further."""
    message = f"the file has {size} bytes; a spec has at most {LARGEST}"
    help_ = "keep large tables in a file of their own: grid: {file: field.npy}"
    return _error(source, "S012", message, None, help_)


def check_characters(source: Source) -> tuple[Diagnostic, ...]:
    """Why the text is none that can be read as YAML, before any YAML is looked for."""
    size = len(source.text.encode(errors="surrogatepass"))
    if size > LARGEST:
        return (too_large(source, size),)
    return (*_tabs(source), *_control_characters(source))


def span_at(text: str, index: int, length: int = 1) -> Span:
    """The place of the character `index` of a text, `length` characters long."""
    ends = [match.end() for match in _LINE_END.finditer(text, 0, index)]
    column = index - (ends[-1] if ends else 0) + 1
    return Span(len(ends) + 1, column, len(ends) + 1, column + length)


def _tabs(source: Source) -> Iterator[Diagnostic]:
    found = [match.start() for match in _TAB.finditer(source.text)]
    if found:
        message = f"a tab{_more(len(found))}: how wide it is, no two editors agree"
        help_ = "write spaces; in a text in double quotes, write \\t"
        yield _error(source, "S009", message, span_at(source.text, found[0]), help_)


def _control_characters(source: Source) -> Iterator[Diagnostic]:
    found = [match.start() for match in _FORBIDDEN.finditer(source.text)]
    if found:
        code = ord(source.text[found[0]])
        message = f"the character U+{code:04X}{_more(len(found))} can't stand in a spec"
        help_ = (
            f'remove it; in a text in double quotes, write "\\u{code:04x}"'
            if code < 2**16
            else "remove it"
        )
        yield _error(source, "S010", message, span_at(source.text, found[0]), help_)


def _more(count: int) -> str:
    return "" if count == 1 else f" (the first of {count})"


def _error(source: Source, code: str, message: str, span: Span | None, help_: str) -> Diagnostic:
    return Diagnostic(code, Severity.ERROR, message, source, span, help=help_)
