"""The report as plain text: the verdict and its reason first, then the figures."""

from collections.abc import Sequence

from verifier.report.layout import INDENT, bullets, section, table, wrapped
from verifier.report.report import Coverage, HorizonFigure, Report, VariableResult
from verifier.report.situations import stands
from verifier.report.wording import listed, number, percent, seconds, shown, span, suffix


def as_text(report: Report, sections: Sequence[str] = ()) -> str:
    """The whole report; colours are the caller's business. Ends without a line break.

    sections: texts that stand after the figures, before what was left out.
    """
    parts = [
        _head(report),
        _figures(report),
        _shorter(report),
        _seen(report),
        *sections,
        section("not judged", [_excluded(report)]),
        section("lost in the log", [_lost(report)]),
        section("notes", [bullets(report.notes)]),
        section("next", [bullets(report.advice)]),
        f"spec {report.spec.name}, {report.spec.file}, sha256 {report.spec.sha256[:12]}",
    ]
    return "\n\n".join(part for part in parts if part)


def _head(report: Report) -> str:
    title = f"{report.verdict.upper()}  {report.spec.name} on {report.trace.source}"
    return "\n".join([title, *(wrapped(reason) for reason in report.reasons)])


def _figures(report: Report) -> str:
    if not report.variables:
        return ""
    header = (
        f"after {number(report.horizon)} s",
        "unit",
        "tolerance",
        "departure",
        f"{percent(report.confidence)} interval",
        "scatter",
        "noise",
        "",
    )
    return table([header, *(_row(result) for result in report.variables)])


def _row(result: VariableResult) -> tuple[str, ...]:
    figure, unit = result.declared, result.unit
    return (
        result.name,
        unit.text,
        shown(result.tolerance, unit),
        shown(figure.departure, unit),
        span(figure.interval.low, figure.interval.high, unit).removesuffix(suffix(unit)),
        shown(result.scatter, unit),
        shown(result.noise.sigma, unit),
        stands(result),
    )


def _shorter(report: Report) -> str:
    """Departures at every horizon; only the declared one decides."""
    shorter = [result for result in report.variables if len(result.horizons) > 1]
    if not shorter:
        return ""
    times = [figure.horizon for figure in shorter[0].horizons]
    header = ("departure after", *(f"{number(time)} s" for time in times), "")
    rows = [(r.name, *(_short(f, r) for f in r.horizons), r.unit.text) for r in shorter]
    return table([header, *rows])


def _short(figure: HorizonFigure, result: VariableResult) -> str:
    return shown(figure.departure, result.unit) if figure.windows else "-"


def _seen(report: Report) -> str:
    trace = report.trace
    windows = f", {len(report.starts)} windows of {number(report.horizon)} s"
    if report.horizon == 0.0:
        windows = f", {len(report.starts)} decisions" if report.starts.size else ""
    lines = [f"judged    {seconds(trace.judged)} of {seconds(trace.duration)}{windows}"]
    if report.coverage is not None:
        lines.append(f"coverage  {_covered(report.coverage)}")
    return "\n".join(lines)


def _covered(coverage: Coverage) -> str:
    spans = [
        f"{a.name} ({', '.join(a.values)})"
        if a.values
        else f"{a.name} {span(a.low, a.high, a.unit)}"
        for a in coverage.axes
    ]
    required = f"{percent(coverage.required)} required" if coverage.required else "none required"
    return f"{percent(coverage.share)} of {listed(spans)} was seen, {required}"


def _excluded(report: Report) -> str:
    rows = [
        (seconds(each.seconds), f"{each.samples} samples", each.cause) for each in report.exclusions
    ]
    return table(rows, INDENT)


def _lost(report: Report) -> str:
    rows = [(f"{loss.count} x", loss.cause, loss.detail) for loss in report.losses]
    return table(rows, INDENT)
