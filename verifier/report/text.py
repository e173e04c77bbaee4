"""The report as plain text: the verdict and its reason first, then the figures."""

import textwrap
from collections.abc import Sequence
from typing import Final

from verifier.report.report import Coverage, HorizonFigure, Report, VariableResult
from verifier.report.wording import listed, number, percent, seconds, shown, span, suffix

WIDTH: Final = 100
INDENT: Final = "  "


def as_text(report: Report) -> str:
    """The whole report; colours are the caller's business. Ends without a line break."""
    parts = [
        _head(report),
        _figures(report),
        _shorter(report),
        _seen(report),
        _section("not judged", [_excluded(report)]),
        _section("lost in the log", [_lost(report)]),
        _section("notes", [_bullets(report.notes)]),
        _section("next", [_bullets(report.advice)]),
        f"spec {report.spec.name}, {report.spec.file}, sha256 {report.spec.sha256[:12]}",
    ]
    return "\n\n".join(part for part in parts if part)


def _head(report: Report) -> str:
    title = f"{report.verdict.upper()}  {report.spec.name} on {report.trace.source}"
    return "\n".join([title, *(_wrapped(reason) for reason in report.reasons)])


def _wrapped(sentence: str, first: str = INDENT) -> str:
    return textwrap.fill(
        sentence,
        width=WIDTH,
        initial_indent=first,
        subsequent_indent=" " * len(first),
        break_on_hyphens=False,
        break_long_words=False,
    )


def _figures(report: Report) -> str:
    if not report.variables:
        return ""
    header = (
        f"after {number(report.horizon)} s",
        "unit",
        "tolerance",
        "departure",
        f"{percent(report.confidence)} interval",
        "rmse",
        "noise",
        "",
    )
    return _table([header, *(_row(result) for result in report.variables)])


def _row(result: VariableResult) -> tuple[str, ...]:
    figure, unit = result.declared, result.unit
    return (
        result.name,
        unit.text,
        shown(result.tolerance, unit),
        shown(figure.departure, unit),
        span(figure.interval.low, figure.interval.high, unit).removesuffix(suffix(unit)),
        shown(figure.rmse, unit),
        shown(result.noise.sigma, unit),
        str(result.standing),
    )


def _shorter(report: Report) -> str:
    """Departures at every horizon; only the declared one decides."""
    shorter = [result for result in report.variables if len(result.horizons) > 1]
    if not shorter:
        return ""
    times = [figure.horizon for figure in shorter[0].horizons]
    header = ("departure after", *(f"{number(time)} s" for time in times), "")
    rows = [(r.name, *(_short(f, r) for f in r.horizons), r.unit.text) for r in shorter]
    return _table([header, *rows])


def _short(figure: HorizonFigure, result: VariableResult) -> str:
    return shown(figure.departure, result.unit) if figure.windows else "-"


def _seen(report: Report) -> str:
    trace = report.trace
    windows = f"{len(report.starts)} windows of {number(report.horizon)} s"
    lines = [f"judged    {seconds(trace.judged)} of {seconds(trace.duration)}, {windows}"]
    if report.coverage is not None:
        lines.append(f"coverage  {_covered(report.coverage)}")
    return "\n".join(lines)


def _covered(coverage: Coverage) -> str:
    spans = [f"{a.name} {span(a.low, a.high, a.unit)}" for a in coverage.axes]
    required = f"{percent(coverage.required)} required" if coverage.required else "none required"
    return f"{percent(coverage.share)} of {listed(spans)} was seen, {required}"


def _excluded(report: Report) -> str:
    rows = [
        (seconds(each.seconds), f"{each.samples} samples", each.cause) for each in report.exclusions
    ]
    return _table(rows, INDENT)


def _lost(report: Report) -> str:
    rows = [(f"{loss.count} x", loss.cause, loss.detail) for loss in report.losses]
    return _table(rows, INDENT)


def _bullets(sentences: Sequence[str]) -> str:
    return "\n".join(_wrapped(sentence, f"{INDENT}- ") for sentence in sentences)


def _section(title: str, blocks: Sequence[str]) -> str:
    filled = [block for block in blocks if block]
    return "\n".join([title, *filled]) if filled else ""


def _table(rows: Sequence[Sequence[str]], indent: str = "") -> str:
    """Columns padded to their widest entry, two blanks apart."""
    if not rows:
        return ""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = [
        indent + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        for row in rows
    ]
    return "\n".join(line.rstrip() for line in lines)
