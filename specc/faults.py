"""What can't be done with a file or a value that the user named, as a diagnostic."""

from pathlib import Path

from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source


def mistake(code: str, named: Path | str, message: str, remedy: str = "") -> Diagnostic:
    """What is wrong with what the user named: a file, or `x=1`."""
    return Diagnostic(code, Severity.ERROR, message, Source(str(named), ""), None, help=remedy)


def fault(code: str, named: Path | str, message: str, remedy: str = "") -> SpecError:
    """The error about one mistake."""
    return SpecError([mistake(code, named, message, remedy)])
