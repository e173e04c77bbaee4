"""What can't be done with a file or a value that the user named, as a diagnostic."""

from pathlib import Path

from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source


def fault(code: str, named: Path | str, message: str, remedy: str = "") -> SpecError:
    """The error about what the user named: a file, or `x=1`."""
    source = Source(str(named), "")
    return SpecError([Diagnostic(code, Severity.ERROR, message, source, None, help=remedy)])
