"""Results as files, each written whole or not at all; the suffix says which kind."""

import csv
import io
import json
from pathlib import Path

from runtime.program import Program
from runtime.recording import recorded
from runtime.rollout import Rollout
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source
from specc.api import Verification
from specc.figures.portrait import draw_portrait
from specc.figures.style import rendered
from specc.files import write_atomically
from specc.pages.report_page import report_page
from verifier.report.record import as_json as report_json
from verifier.report.text import as_text as report_text
from verifier.topology.features import Portrait
from verifier.topology.portrait_json import as_json as portrait_json


def record(program: Program, rollout: Rollout, path: Path) -> None:
    """Write a run as .mcap (with the compiled spec attached) or as .csv."""
    match path.suffix.lower():
        case ".mcap":
            write_atomically(path, recorded(rollout, program))
        case ".csv":
            write_atomically(path, _csv(program, rollout).encode())
        case _:
            raise _unknown(path, ".mcap, .csv")


def draw(portrait: Portrait, path: Path) -> None:
    """Write a portrait as .svg, .png or .pdf, or its numbers as .json."""
    suffix = path.suffix.lower()
    match suffix:
        case ".json":
            write_atomically(path, _json_bytes(portrait_json(portrait)))
        case ".svg":
            write_atomically(path, rendered(draw_portrait(portrait), "svg"))
        case ".png":
            write_atomically(path, rendered(draw_portrait(portrait), "png"))
        case ".pdf":
            write_atomically(path, rendered(draw_portrait(portrait), "pdf"))
        case _:
            raise _unknown(path, ".svg, .png, .pdf, .json")


def write_report(verification: Verification, path: Path) -> None:
    """Write a verdict as .html, .json or .txt."""
    report = verification.report
    match path.suffix.lower():
        case ".html":
            write_atomically(path, report_page(report).encode())
        case ".json":
            write_atomically(path, _json_bytes(report_json(report)))
        case ".txt":
            write_atomically(path, report_text(report).encode())
        case _:
            raise _unknown(path, ".html, .json, .txt")


def require_suffix(path: Path | None, *suffixes: str) -> None:
    """Refuse a file that could not be written in the end, before the work begins.

    Raises:
        SpecError: none of `suffixes` fits.
    """
    if path is not None and path.suffix.lower() not in suffixes:
        raise _unknown(path, ", ".join(suffixes))


def _json_bytes(record: object) -> bytes:
    return (json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()


def _csv(program: Program, rollout: Rollout) -> str:
    """A column for time, each state, control and output, in the spec's units."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    states, controls, outputs = program.states, program.controls, program.outputs
    names = [*(s.name for s in states), *(c.name for c in controls), *(o.name for o in outputs)]
    writer.writerow(["t", *names])
    for time, x, y in zip(rollout.times, rollout.states, rollout.outputs, strict=True):
        row = [v / s.unit.scale for s, v in zip(states, x, strict=True)]
        row += [v / c.unit.scale for c, v in zip(controls, rollout.controls, strict=True)]
        row += [v / o.unit.scale for o, v in zip(outputs, y, strict=True)]
        if all(value == value for value in row):  # noqa: PLR0124  NaN: the run has ended
            writer.writerow([repr(float(v)) for v in (time, *row)])
    return text.getvalue()


def _unknown(path: Path, known: str) -> SpecError:
    message = f"no output of kind '{path.suffix or path.name}' can be written"
    source = Source(str(path), "")
    return SpecError(
        [Diagnostic("V345", Severity.ERROR, message, source, None, help=f"known are {known}")]
    )
