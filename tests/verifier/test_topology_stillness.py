"""Axes along which nothing moves: what is fixed there, proved and in words."""

import numpy as np
import pytest

from runtime.program import Kind
from specc.figures.line import draw_line
from specc.figures.palettes import PALETTES
from specc.figures.paper import axes_at, new_figure
from specc.figures.portrait import draw_portrait
from specc.figures.style_names import Style
from specc.texts.portrait import portrait_summary
from tests.verifier.topology_scenes import OSCILLATOR, behavior, line, plane, state
from verifier.topology.portrait import Detail, portrait

QUICK = Detail(plane=65, line=129, trajectories=0)


@pytest.mark.parametrize("field", [("0", "y neg"), ("0", "y x 3 div sub"), ("0", "y 3 pow")])
def test_a_field_that_moves_along_one_axis_only_rests_on_its_nullcline(
    field: tuple[str, str],
) -> None:
    found = portrait(plane(*field), detail=QUICK)
    line_of = {"y neg": 0.0, "y x 3 div sub": 1.0 / 3.0, "y 3 pow": 0.0}[field[1]]
    boxes = found.completeness.undecided
    assert found.completeness.still == ("x",)
    low, high = np.stack([b.low for b in boxes]), np.stack([b.high for b in boxes])
    width = found.axes[1].width
    for x in np.linspace(found.axes[0].low, found.axes[0].high, 41):
        over = (low[:, 0] <= x) & (high[:, 0] >= x)
        at = line_of * x
        assert np.any(over & (low[:, 1] <= at) & (high[:, 1] >= at))
    assert np.all(high[:, 1] - low[:, 1] < 0.05 * width)
    text = portrait_summary(found)
    assert "x' is zero throughout: fixed points fill lines, where y' is zero" in text
    assert "no fixed points found" not in text


def test_a_field_that_drifts_along_one_axis_everywhere_is_proved_to_have_no_fixed_point() -> None:
    found = portrait(plane("0", "y 9 add"), detail=QUICK)
    assert found.completeness.complete
    assert not found.completeness.undecided
    assert "there is no place where y' is zero, too" in portrait_summary(found)
    assert "proved of the formula: there is no fixed point" in portrait_summary(found)


def test_where_nothing_moves_every_point_is_a_fixed_point() -> None:
    text = portrait_summary(portrait(line("0"), detail=QUICK))
    assert "every point is a fixed point" in text
    assert "undecided" not in text


def test_a_rate_of_rounding_beside_the_size_of_the_field_counts_as_zero() -> None:
    held = {OSCILLATOR.states[1].name: 1e-16}
    found = portrait(OSCILLATOR, (OSCILLATOR.states[0].name,), held, QUICK)
    assert found.completeness.still == (OSCILLATOR.states[0].name,)
    assert not found.field.rates.any()
    figure = new_figure(4.0, 3.0, PALETTES[Style.SCREEN])
    axes = axes_at(figure, (0.5, 0.5), (3.0, 2.0))
    legend = [entry.label for entry in draw_line(axes, found, PALETTES[Style.SCREEN])]
    assert "filled with fixed points" in legend
    assert "where it goes" not in legend


def test_a_small_rate_that_is_no_rounding_is_kept() -> None:
    held = {OSCILLATOR.states[1].name: 1e-9}
    found = portrait(OSCILLATOR, (OSCILLATOR.states[0].name,), held, QUICK)
    assert found.field.rates == pytest.approx(1e-9)
    assert not found.completeness.still


def test_footers_keep_the_names_of_states_as_they_are() -> None:
    figure = draw_portrait(portrait(plane("0", "y neg"), detail=QUICK))
    lines = "\n".join(text.get_text() for text in figure.texts).splitlines()
    assert any(text.startswith("x' is zero") for text in lines)
    assert any(text.startswith("Proved of") for text in lines)


def test_rounding_alone_goes_round_no_cycle() -> None:
    """A table or a sum may leave 1e-16 of what is zero; round an angle that would come back."""
    angle = state("x", -np.pi, np.pi, kind=Kind.PERIODIC)
    turning = behavior("turning", (angle, state("y", -2.0, 2.0)), ("y 1e-16 add", "0"))
    found = portrait(turning, ("x",), {"y": 0.0}, QUICK)
    assert found.cycles == ()
    assert "x' is zero throughout: every point is a fixed point" in found.notes
