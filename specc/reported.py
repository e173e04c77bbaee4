"""Verdicts as files: a page, numbers, text, or what CI systems read."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from spec_schema.diagnostics import render
from specc import __version__
from specc.files import json_bytes, unknown_suffix, write_atomically
from specc.pages.report_page import report_page
from specc.pages.runs_page import runs_page
from specc.texts.runs import runs_text
from specc.verifying.architecture import NotJudged
from specc.verifying.recording import RunVerification
from specc.verifying.runs import (
    Outcome,
    Runs,
    Unusable,
    not_judged,
    runs_of,
    source_of,
    unusable,
    verifications,
)
from specc.verifying.runs_record import record_of
from specc.verifying.trace import Verification
from verifier.report.examination_text import examination_text
from verifier.report.findings import Finding, Level, Rule, findings_of
from verifier.report.junit import as_junit
from verifier.report.sarif import as_sarif

KINDS: Final = (".html", ".json", ".txt", ".xml", ".sarif")
"""Of reports; .xml is JUnit's."""
OPEN: Final = {Rule.UNDECIDED, Rule.COVERAGE, Rule.INCONCLUSIVE}
"""What more recordings may decide."""


def write_report(verification: Verification | RunVerification, path: Path | str) -> None:
    """Write a verdict as .html, .json, .txt, .xml (JUnit) or .sarif."""
    if isinstance(verification, RunVerification):
        write_reports([*verification.judged, *verification.not_judged], path)
    else:
        write_reports([verification], path)


def write_reports(outcomes: Sequence[Outcome] | Runs, path: Path | str) -> None:
    """Write the verdicts on many recordings, each and together, as one file of the same kinds."""
    path = Path(path)
    runs = outcomes if isinstance(outcomes, Runs) else runs_of(outcomes)
    one = runs.only
    match path.suffix.lower():
        case ".html":
            data = (runs_page(runs) if one is None else report_page(one.examination)).encode()
        case ".json":
            data = json_bytes(record_of(runs))
        case ".txt":
            data = (runs_text(runs) if one is None else examination_text(one.examination)).encode()
        case ".xml":
            data = _junit(runs)
        case ".sarif":
            data = json_bytes(as_sarif(findings_by_source(runs), __version__))
        case _:
            raise unknown_suffix(path, ", ".join(KINDS))
    write_atomically(path, data)


def _junit(runs: Runs) -> bytes:
    judged = verifications(runs.outcomes)
    made = [*(p.examination for p in runs.pools), *(each.examination for each in judged)]
    parts = frozenset(each.examination for each in runs.members)
    skipped = [(each.source, each.why) for each in not_judged(runs.outcomes)]
    broken = [(each.source, render(each.error.diagnostics)) for each in unusable(runs.outcomes)]
    return as_junit(made, broken, parts, skipped)


def findings_by_source(runs: Runs) -> list[tuple[str, tuple[Finding, ...]]]:
    """All findings, each list with what it is about: all recordings together, or one.

    What one recording leaves open is a note where others decide with it.
    """
    found = [(pool.report.trace.source, findings_of(pool.examination)) for pool in runs.pools]
    members = runs.members
    for each in runs.outcomes:
        findings = findings_in(each)
        if each in members:
            findings = tuple(_as_part(finding) for finding in findings)
        found.append((source_of(each), findings))
    return found


def _as_part(finding: Finding) -> Finding:
    is_open = finding.level is Level.WARNING and finding.rule in OPEN
    return replace(finding, level=Level.NOTE) if is_open else finding


def findings_in(outcome: Outcome) -> tuple[Finding, ...]:
    """All findings about one recording; of one that can't be used, why it can't."""
    if isinstance(outcome, Unusable):
        return tuple(
            Finding(Rule.UNUSABLE, Level.ERROR, each.code, each.message, each.place)
            for each in outcome.error.diagnostics
        )
    if isinstance(outcome, NotJudged):
        return (Finding(Rule.NOT_JUDGED, Level.NOTE, "node", outcome.why, ""),)
    return findings_of(outcome.examination)
