"""A verdict as a file: a page, numbers, or text."""

from pathlib import Path

from specc.files import json_bytes, unknown_suffix, write_atomically
from specc.pages.report_page import report_page
from specc.verifying import Verification
from verifier.report.record import as_json
from verifier.report.text import as_text


def write_report(verification: Verification, path: Path | str) -> None:
    """Write a verdict as .html, .json or .txt."""
    report = verification.report
    path = Path(path)
    match path.suffix.lower():
        case ".html":
            write_atomically(path, report_page(report).encode())
        case ".json":
            write_atomically(path, json_bytes(as_json(report)))
        case ".txt":
            write_atomically(path, as_text(report).encode())
        case _:
            raise unknown_suffix(path, ".html, .json, .txt")
