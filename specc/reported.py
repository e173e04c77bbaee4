"""Verdicts as files: a page, numbers, text, or what CI systems read."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from spec_schema.diagnostics import render
from specc import __version__
from specc.files import json_bytes, unknown_suffix, write_atomically
from specc.pages.report_page import report_page
from specc.pages.runs_page import runs_page
from specc.runs import Outcome, Unusable, unusable, verifications
from specc.runs_record import run_record, runs_record
from specc.runs_text import runs_text
from specc.verifying import Verification
from verifier.report.examination_text import examination_text
from verifier.report.findings import Finding, Level, Rule, findings_of
from verifier.report.junit import as_junit
from verifier.report.sarif import as_sarif

KINDS: Final = (".html", ".json", ".txt", ".xml", ".sarif")
"""Of reports; .xml is JUnit's."""


def write_report(verification: Verification, path: Path | str) -> None:
    """Write a verdict as .html, .json, .txt, .xml (JUnit) or .sarif."""
    path = Path(path)
    match path.suffix.lower():
        case ".html":
            write_atomically(path, report_page(verification.examination).encode())
        case ".json":
            write_atomically(path, json_bytes(run_record(verification)))
        case ".txt":
            write_atomically(path, examination_text(verification.examination).encode())
        case _:
            write_reports([verification], path)


def write_reports(outcomes: Sequence[Outcome], path: Path | str) -> None:
    """Write the verdicts on many recordings as one file of the same kinds."""
    path = Path(path)
    match path.suffix.lower():
        case ".html":
            data = runs_page(outcomes).encode()
        case ".json":
            data = json_bytes(runs_record(outcomes))
        case ".txt":
            data = runs_text(outcomes).encode()
        case ".xml":
            made = [each.examination for each in verifications(outcomes)]
            broken = [(each.source, render(each.error.diagnostics)) for each in unusable(outcomes)]
            data = as_junit(made, broken)
        case ".sarif":
            found = [(source_of(each), findings_in(each)) for each in outcomes]
            data = json_bytes(as_sarif(found, __version__))
        case _:
            raise unknown_suffix(path, ", ".join(KINDS))
    write_atomically(path, data)


def source_of(outcome: Outcome) -> str:
    """The recording that it is about."""
    return outcome.source if isinstance(outcome, Unusable) else outcome.report.trace.source


def findings_in(outcome: Outcome) -> tuple[Finding, ...]:
    """All findings about one recording; of one that can't be used, why it can't."""
    if isinstance(outcome, Unusable):
        return tuple(
            Finding(Rule.UNUSABLE, Level.ERROR, each.code, each.message, each.place)
            for each in outcome.error.diagnostics
        )
    return findings_of(outcome.examination)
