"""Drawing reports: whatever a report holds can be drawn."""

from dataclasses import replace

import numpy as np
import pytest

from specc.figures.candidates import draw_candidates
from specc.figures.coverage import draw_coverage
from specc.figures.errors import draw_error_map, draw_errors, places_shown
from specc.figures.style import rendered_svg
from specc.figures.verdicts import draw_verdicts
from specc.figures.windows import MOST, draw_windows
from tests.specc.examination_scenes import examination
from tests.specc.report_scenes import coverage, report
from verifier.report.diagnosis import Candidate
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


def test_values_of_a_discrete_variable_stand_at_its_axis_by_name() -> None:
    made = report(cells=coverage(2))
    cells = made.coverage
    assert cells is not None
    first, second = cells.axes
    named = replace(
        second,
        low=-0.5,
        high=second.count - 0.5,
        values=tuple(f"mode {k}" for k in range(second.count)),
    )
    seen = replace(cells, axes=(first, named))
    places = {**made.places, second.name: np.zeros(len(made.starts))}

    drawn = draw_coverage(seen)
    mapped = draw_error_map(replace(made, coverage=seen, places=places), made.variables[0])

    for figure in (drawn, mapped):
        labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
        assert labels == list(named.values)


def test_explanations_are_drawn_as_they_are_told_and_then_by_what_they_explain() -> None:
    diagnosis = examination().diagnosis
    assert diagnosis is not None
    one = diagnosis.candidates[0]

    def told(label: str, share: float, *, is_taken: bool) -> Candidate:
        evidence = replace(one.evidence, share=share)
        return replace(one, label=label, evidence=evidence, is_taken=is_taken)

    shuffled = (
        told("a little", 0.1, is_taken=False),
        told("first", 0.8, is_taken=True),
        told("most", 0.7, is_taken=False),
        told("then", 0.3, is_taken=True),
    )
    axes = draw_candidates(replace(diagnosis, candidates=shuffled)).axes[0]

    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert labels == ["first", "then", "most", "a little"]
