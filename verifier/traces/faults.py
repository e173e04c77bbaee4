"""Why a log can't be used for a spec: the diagnostics V301 to V314 and where they point.

V301 the file can't be opened        V302 not a log that we know
V303 no such topic or column         V304 no such field
V305 not a number                    V306 no samples left
V307 an encoding that we can't read  V308 the path is not written as one
V309 no time column                  V310 a driven state is not bound
V311 no message definition           V312 no sensor stamps
V313 losses where none are allowed   V314 a reading of an arbiter in another unit
"""

import re
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

from runtime.program import Binding, Program
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source, Span

MOST_LISTED = 12


def file_fault(path: Path, code: str, message: str, help: str = "") -> SpecError:  # noqa: A002  # as in Diagnostic
    """The file itself is at fault."""
    return SpecError([file_diagnostic(path, code, message, help)])


def file_diagnostic(path: Path, code: str, message: str, help: str = "") -> Diagnostic:  # noqa: A002  # as in Diagnostic
    """A diagnostic about a whole file."""
    return Diagnostic(code, Severity.ERROR, message, Source(str(path), ""), None, help=help)


def binding_diagnostic(
    program: Program,
    binding: Binding,
    code: str,
    message: str,
    *,
    help: str = "",  # noqa: A002  # as in Diagnostic
    part: tuple[int, int] | None = None,
) -> Diagnostic:
    """A diagnostic at a binding's path in the user's YAML; `part` narrows it to some characters."""
    source = Source(program.source.file, program.source.text)
    span = _path_span(source, binding, part)
    where = f"$.trace.{binding.name}"
    return Diagnostic(code, Severity.ERROR, message, source, span, path=where, help=help)


def origin_span(source: Source, origin: str) -> Span | None:
    """The key or value that begins at `file:line:column`; None where that is no place."""
    try:
        _, line_text, column_text = origin.rsplit(":", 2)
        line, column = int(line_text), int(column_text)
    except ValueError:
        return None
    rest = source.line(line)[column - 1 :]
    key = re.match(r"[\w-]+(?=\s*:)", rest)
    width = len(key.group() if key else rest.split("#", 1)[0].rstrip()) or 1
    return Span(line, column, line, column + width)


def nearest_help(word: str, candidates: Sequence[str], noun: str) -> str:
    """`did you mean '/odom'?` and the list of what there is."""
    listed = ", ".join(candidates[:MOST_LISTED]) or "none"
    more = len(candidates) - MOST_LISTED
    known = f"{noun}: {listed}" + (f" and {more} more" if more > 0 else "")
    close = _same_end(word, candidates) or get_close_matches(word, candidates, n=1, cutoff=0.5)
    return f"did you mean '{close[0]}'?\n{known}" if close else known


def _same_end(word: str, candidates: Sequence[str]) -> list[str]:
    """The candidates that differ in their namespace only: `/odom` and `/husky/odom`."""
    last = word.rsplit("/", 1)[-1].lower()
    return [known for known in candidates if last and known.rsplit("/", 1)[-1].lower() == last]


def _path_span(source: Source, binding: Binding, part: tuple[int, int] | None) -> Span | None:
    """The path's text, sought from the binding's place on (it may stand in a mapping below)."""
    whole = origin_span(source, binding.origin)
    if whole is None or not binding.path:
        return whole
    for line in range(whole.line, whole.line + 8):
        # The place is that of the key, which may be spelled like the path.
        start = source.line(line).find(":", whole.column) if line == whole.line else 0
        found = source.line(line).find(binding.path, max(start, 0))
        if found >= 0:
            low, high = part or (0, len(binding.path))
            return Span(line, found + low + 1, line, found + max(high, low + 1) + 1)
    return whole
