"""The report of a verification as one HTML file that needs nothing else.

The page's contents are gathered as data; the template only lays them out, and escapes every
text, because names in it come from logs and specs of strangers.
"""

from typing import Final

import jinja2
from markupsafe import Markup

from specc import __version__
from specc.figures.coverage import draw_coverage
from specc.figures.errors import draw_error_map, draw_errors, places_shown
from specc.figures.quantities import number, quantity, seconds
from specc.figures.verdicts import draw_verdicts
from specc.figures.windows import draw_windows
from specc.pages.page import Page, Plot, Row, RunsPage, Table, VariablePart
from specc.pages.parts import explanations, limits_of_verdict, plotted
from specc.pages.prose import prose
from specc.pages.sentences import (
    about_coverage,
    about_variable,
    how_to_read_coverage,
    how_to_read_errors,
    how_to_read_the_map,
    how_to_read_the_overview,
    how_to_read_the_table,
    how_to_read_windows,
    ranged,
)
from verifier.report.examination import Examination
from verifier.report.report import Report, TraceIdentity, VariableResult, Verdict
from verifier.report.wording import date_of

SIGNS: Final = {Verdict.PASS: "✓", Verdict.FAIL: "✗", Verdict.INCONCLUSIVE: "?"}
COLUMNS: Final = ("tolerance", "departure", "its interval", "RMSE", "mean error", "windows")


def report_page(examination: Examination) -> str:
    """One trace as self-contained HTML: the verdict first, its evidence after it."""
    return rendered("report.html.j2", gathered(examination))


def rendered(template: str, page: Page | RunsPage) -> str:
    """A page laid out by one of the templates."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("specc.pages"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["prose"] = prose
    # The style sheet is ours; within <style> it must not be escaped.
    sheet = environment.get_template("report.css").render()
    return environment.get_template(template).render(page=page, style=Markup(sheet))  # noqa: S704


def gathered(examination: Examination, prefix: str = "", *, is_drawn: bool = True) -> Page:
    """What the page says, in the order in which it is read.

    Args:
        prefix: keeps the ids of figures apart where a page holds several traces.
        is_drawn: whether the variables get figures.
    """
    report = examination.report
    coverage = report.coverage
    return Page(
        title=f"{report.verdict.upper()}: {report.spec.name}",
        verdict=str(report.verdict),
        sign=SIGNS[report.verdict],
        headline=f"{report.spec.name} against {report.trace.source}",
        reasons=report.reasons,
        columns=COLUMNS,
        rows=tuple(map(_row, report.variables)),
        how=how_to_read_the_table(report),
        overview=_overview(report, prefix),
        explanations=explanations(examination, prefix),
        variables=tuple(
            _part(report, f"{prefix}v{i}", variable, is_drawn=is_drawn)
            for i, variable in enumerate(report.variables)
        ),
        coverage=() if _has_no_region(examination) else about_coverage(coverage),
        coverage_figure=coverage
        and plotted(draw_coverage(coverage), f"{prefix}coverage", how_to_read_coverage(coverage)),
        limits=limits_of_verdict(examination, prefix),
        exclusions=_exclusions(report),
        losses=_losses(report),
        notes=report.notes,
        provenance=_provenance(report),
        advice=report.advice,
    )


def _has_no_region(examination: Examination) -> bool:
    """Of what is required of a run, and of decisions, no region is covered."""
    return bool(examination.requirements) or examination.arbitration is not None


def _overview(report: Report, prefix: str) -> Plot | None:
    if not report.variables:
        return None
    caption = how_to_read_the_overview(report)
    return plotted(draw_verdicts(report), f"{prefix}overview", caption)


def _row(variable: VariableResult) -> Row:
    at, unit = variable.declared, variable.unit
    return Row(
        name=variable.name,
        standing=str(variable.standing),
        cells=(
            quantity(variable.tolerance, unit),
            quantity(at.departure, unit),
            ranged(at.interval, unit),
            quantity(at.rmse, unit),
            quantity(variable.mean, unit),
            str(at.windows),
        ),
    )


def _part(report: Report, name: str, variable: VariableResult, *, is_drawn: bool) -> VariablePart:
    figures: list[Plot] = []
    if variable.views and is_drawn:
        windows = draw_windows(variable)
        figures.append(plotted(windows, f"{name}-windows", how_to_read_windows(variable)))
    if variable.errors.size and is_drawn:
        errors = draw_errors(report, variable)
        figures.append(plotted(errors, f"{name}-errors", how_to_read_errors(report, variable)))
        places = places_shown(report)
        if places:
            caption = how_to_read_the_map(places)
            figures.append(plotted(draw_error_map(report, variable), f"{name}-map", caption))
    return VariablePart(
        name=variable.name,
        sentences=about_variable(report, variable),
        figures=tuple(figures),
        horizons=_horizons(variable),
    )


def _horizons(variable: VariableResult) -> Table | None:
    if len(variable.horizons) < 2:
        return None
    rows = tuple(
        (
            seconds(at.horizon),
            quantity(at.rmse, variable.unit),
            quantity(at.departure, variable.unit),
            ranged(at.interval, variable.unit),
            str(at.windows),
        )
        for at in variable.horizons
    )
    return Table(("after", "RMSE", "departure", "its interval", "windows"), rows)


def _exclusions(report: Report) -> Table | None:
    rows = tuple((e.cause, seconds(e.seconds), str(e.samples)) for e in report.exclusions)
    return Table(("why", "time", "samples"), rows) if rows else None


def _losses(report: Report) -> Table | None:
    rows = tuple((loss.cause, str(loss.count), loss.detail) for loss in report.losses)
    return Table(("what", "how often", "where"), rows, last=1) if rows else None


def _provenance(report: Report) -> tuple[tuple[str, str], ...]:
    """What was judged, and how; of what has no horizon, or is certain, nothing of that."""
    trace = report.trace
    confidence = f"{number(100.0 * report.confidence)} %"
    return (
        ("spec", f"{report.spec.name} ({report.spec.file})"),
        *([("spec text, SHA-256", report.spec.sha256)] if report.spec.sha256 else []),
        ("trace", trace.source),
        ("recorded", _when(trace)),
        ("length", f"{seconds(trace.duration)}, of which {seconds(trace.judged)} were judged"),
        *([("horizon", seconds(report.horizon))] if report.horizon else []),
        *([("confidence", confidence)] if report.confidence < 1.0 else []),
        ("specc", __version__),
    )


def _when(trace: TraceIdentity) -> str:
    """The log's own clock as a date, where it is set."""
    date = date_of(trace.start)
    if date is None:
        return f"clock of the log at the first sample: {seconds(trace.start)}"
    return f"{date:%Y-%m-%d %H:%M:%S} UTC"
