"""Drawing reports: whatever a report holds can be drawn."""

from dataclasses import replace

import numpy as np
import pytest

from specc.figures.coverage import draw_coverage
from specc.figures.errors import draw_error_map, draw_errors, places_shown
from specc.figures.style import rendered_svg
from specc.figures.verdicts import draw_verdicts
from specc.figures.windows import MOST, draw_windows
from tests.specc.report_scenes import coverage, report
from verifier.report.report import HorizonFigure, Interval, Standing, Verdict


def test_windows_are_drawn_in_panels_of_their_own() -> None:
    figure = draw_windows(report().variables[0])

    assert len(figure.axes) == MOST
    assert rendered_svg(figure) == rendered_svg(draw_windows(report().variables[0]))


@pytest.mark.parametrize("windows", [2, 60, 4000])
def test_errors_are_drawn_however_many_there_are(windows: int) -> None:
    made = report(windows=windows)

    for variable in made.variables:
        svg = rendered_svg(draw_errors(made, variable))
        assert len(svg) < 400_000
        assert len(rendered_svg(draw_error_map(made, variable))) < 400_000


def test_the_map_shows_the_variables_that_coverage_speaks_of() -> None:
    made = report(cells=coverage(2))

    assert places_shown(made) == ("x", "y")
    still = replace(made, coverage=None, places={"x": np.zeros(60), "y": made.places["y"]})
    assert places_shown(still) == ("y",)
    assert rendered_svg(draw_error_map(still, still.variables[0]))


@pytest.mark.parametrize("axes", [1, 2, 3, 4])
def test_coverage_is_drawn_for_regions_of_any_dimension(axes: int) -> None:
    figure = draw_coverage(coverage(axes))

    assert len(figure.axes) == {1: 1, 2: 1, 3: 3, 4: 3}[axes]
    assert rendered_svg(figure)


def test_an_unbounded_interval_can_be_drawn() -> None:
    made = report(Verdict.INCONCLUSIVE)
    open_ended = HorizonFigure(
        5.0, 1, 0.02, 0.01, float("nan"), Interval(0.0, float("inf")), 0.1, Standing.UNDECIDED
    )
    variable = replace(made.variables[0], horizons=(open_ended,), standing=Standing.UNDECIDED)

    assert rendered_svg(draw_verdicts(replace(made, variables=(variable,))))
