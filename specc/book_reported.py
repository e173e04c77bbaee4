"""Where the modules of a book stand, as files: a page, numbers, text, or what CI systems read."""

from dataclasses import replace
from pathlib import Path

from spec_schema.diagnostics import render
from specc import __version__
from specc.files import json_bytes, unknown_suffix, write_atomically
from specc.pages.book_verdict_page import book_verdict_page
from specc.reported import KINDS, findings_in
from specc.texts.book_verdict import book_text, module_names
from specc.verifying.book_modules import BookVerdict, ModuleVerdict, Standing
from specc.verifying.book_record import book_record
from verifier.report.annotations import as_annotations
from verifier.report.examination import Examination
from verifier.report.findings import Finding, Level, Rule, findings_of
from verifier.report.junit import as_junit
from verifier.report.report import Verdict
from verifier.report.sarif import as_sarif


def write_book_report(verdict: BookVerdict, path: Path, *, procedures: bool = False) -> None:
    """Write it as .html, .json, .txt, .xml (JUnit) or .sarif.

    procedures: whether people are also told what to record of modules without recordings.
    """
    match path.suffix.lower():
        case ".html":
            data = book_verdict_page(verdict, procedures=procedures).encode()
        case ".json":
            data = json_bytes(book_record(verdict))
        case ".txt":
            data = book_text(verdict, procedures=procedures).encode()
        case ".xml":
            data = _junit(verdict)
        case ".sarif":
            data = json_bytes(as_sarif(_findings(verdict), __version__))
        case _:
            raise unknown_suffix(path, ", ".join(KINDS))
    write_atomically(path, data)


def annotations_of(verdict: BookVerdict) -> str:
    """What is wrong with modules, as annotations of a pull request."""
    lines = [as_annotations(found, source) for source, found in _findings(verdict)]
    return "\n".join(line for line in lines if line)


def _findings(verdict: BookVerdict) -> list[tuple[str, tuple[Finding, ...]]]:
    """All findings, each list with the module that it is about."""
    names = module_names(verdict)
    found = [(names[id(each)], _findings_of(each)) for each in verdict.modules]
    return [*found, *((each.source, findings_in(each)) for each in verdict.unusable)]


def _findings_of(each: ModuleVerdict) -> tuple[Finding, ...]:
    """Of all recordings together, and of those that fail by themselves."""
    if each.together is None:
        level = Level.NOTE if each.standing is Standing.FREE else Level.WARNING
        return (Finding(Rule.NOT_JUDGED, level, each.piece.place.node, each.why[0], ""),)
    failing = [m for m in each.members if m.report.verdict is Verdict.FAIL]
    alone = [found for m in failing for found in findings_of(m.examination)]
    return (*findings_of(each.together), *(alone if len(each.members) > 1 else ()))


def _junit(verdict: BookVerdict) -> bytes:
    """A test suite for each module; what no recording holds is an error, and code is skipped."""
    names = module_names(verdict)
    judged = [each for each in verdict.modules if each.together is not None]
    made = [_named(each, names[id(each)]) for each in judged]
    missing = [each for each in verdict.modules if each.together is None]
    free = [(names[id(e)], e.why[0]) for e in missing if e.standing is Standing.FREE]
    broken = [(names[id(e)], e.why[0]) for e in missing if e.standing is not Standing.FREE]
    broken += [(each.source, render(each.error.diagnostics)) for each in verdict.unusable]
    return as_junit(made, broken, (), free)


def _named(each: ModuleVerdict, name: str) -> Examination:
    """What decides about a module, under its name: a recording that fails, or all together."""
    failing = [m.examination for m in each.members if m.report.verdict is Verdict.FAIL]
    assert each.together is not None, "it was judged"
    shown = failing[0] if failing else each.together
    trace = replace(shown.report.trace, source=name)
    return replace(shown, report=replace(shown.report, trace=trace))
