"""The numbers of the figures of rules, and that each style draws them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Rectangle

from lcs.inputs import Input
from lcs.rules.names import plain_names
from lcs.rules.table import RuleTable
from specc.figures.quantities import range_shown
from specc.figures.rules_plane import Slice, draw_rules, slice_through
from specc.figures.rules_sheet import BAR, INDENT, MOST, draw_rule_sheet
from specc.figures.style import rendered
from specc.figures.style_names import Style
from tests.lcs.rules.tables import WALL, drawn_table, table_of, wall_rules


def words_of(figure: object) -> list[str]:
    from matplotlib.figure import Figure
    from matplotlib.text import Text

    assert isinstance(figure, Figure)
    return [each.get_text() for each in figure.findobj(Text)]


def test_bars_stand_where_the_bounds_are() -> None:
    table = table_of([(0, [1.0, 0.0], [4.0, 2.0], 1000.0)], range_to=4.0)

    figure = draw_rule_sheet(table, plain_names(table), "rules")

    bars = sorted(
        (each for each in figure.axes[0].patches if isinstance(each, Rectangle)),
        key=lambda bar: bar.get_x(),
    )
    column = bars[1].get_x() - INDENT  # the second bar begins where its column does
    assert len(bars) == 2
    assert bars[0].get_width() / (BAR * column) == pytest.approx(3.0 / 4.0)
    assert bars[1].get_width() / (BAR * column) == pytest.approx(2.0 / 4.0)
    assert bars[0].get_x() - INDENT == pytest.approx(BAR * column / 4.0)


def test_a_sheet_says_what_each_rule_asks_and_leaves_out_what_none_does() -> None:
    inputs = (*WALL.inputs, Input("back", "m"))
    table = wall_rules()
    wide = table_of(
        [(int(a), [*low, 0.0], [*up, 5.0], 1000.0) for a, low, up in zip(
            table.action, table.lower.tolist(), table.upper.tolist(), strict=True)],
        range_to=5.0,
    )  # fmt: skip

    words = words_of(draw_rule_sheet(wide, type(WALL)(inputs, WALL.actions), "wall_following"))

    assert {"Wall following", "front [m]", "left [m]", "≤ 0.9", "< 0.5", "sharp right"} <= {*words}
    assert "back [m]" not in words
    assert any("No rule shown asks for back." in each for each in words)


def test_of_many_rules_those_with_most_cases_are_drawn() -> None:
    table = drawn_table(1, rules=MOST + 6)

    words = words_of(draw_rule_sheet(table, plain_names(table), "many"))

    assert any(f"Of {MOST + 6} rules the {MOST} with most cases" in each for each in words)


def test_a_slice_shows_the_rules_that_meet_it() -> None:
    table = table_of(
        [
            (0, [0.0, 0.0, 0.0], [1.0, 1.0, 0.5], 1000.0),
            (0, [0.0, 0.0, 0.5], [0.5, 1.0, 1.0], -1000.0),
        ],
        range_to=1.0,
    )
    names = plain_names(table)

    low = draw_rules(table, names, slice_through(table, names, "x1", "x2", {"x3": 0.25}), "low")
    end = draw_rules(table, names, slice_through(table, names, "x1", "x2", {"x3": 1.0}), "end")
    every = draw_rules(table, names, Slice(0, 1, None), "all")

    assert widths(low.axes[1]) == [1.0]
    assert widths(end.axes[1]) == [0.5]
    assert sorted(widths(every.axes[0])) == [0.5, 1.0]
    assert "Where x3 = 0.25." in "".join(words_of(low))


def widths(axes: object) -> list[float]:
    from matplotlib.axes import Axes

    assert isinstance(axes, Axes)
    return [each.get_width() for each in axes.patches if isinstance(each, Rectangle)]


@pytest.mark.parametrize("style", list(Style))
def test_each_style_draws_both_pictures(style: Style) -> None:
    table, chance = wall_rules(), np.random.default_rng(1)
    examples = chance.random((30, 2)) * 5.0, chance.integers(4, size=30)

    sheet = draw_rule_sheet(table, WALL, "wall", about=["Four rules."], style=style)
    plane = draw_rules(
        table, WALL, Slice(0, 1, np.zeros(2)), "wall", examples=examples, style=style
    )

    assert rendered(sheet, "svg").startswith(b"<?xml")
    assert rendered(plane, "svg").startswith(b"<?xml")


def test_equal_rules_give_equal_bytes() -> None:
    first, second = (draw_rule_sheet(wall_rules(), WALL, "wall") for _ in range(2))

    assert rendered(first, "svg") == rendered(second, "svg")


def test_ends_of_ranges_are_round() -> None:
    assert range_shown(6e-6, 0.99998) == (0.0, 1.0)
    assert range_shown(-np.inf, 2.0) == (-np.inf, 2.0)


@settings(max_examples=3, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 8))
def test_each_bar_has_its_bounds_beside_or_in_it_and_within_its_column(
    seed: int, inputs: int
) -> None:
    chance = np.random.default_rng(seed)
    ends = np.sort(chance.random((12, inputs, 2)), axis=2).round(3)
    lower, upper = np.maximum(ends[..., 0], 0.001), np.minimum(ends[..., 1] + 0.002, 0.999)
    count = np.full(12, 3)
    table = RuleTable(
        2, np.repeat([0, 1], 6), lower, upper, np.ones(12), np.ones(12), count, count,
        np.zeros(inputs), np.ones(inputs),
    )  # fmt: skip
    figure = draw_rule_sheet(table, plain_names(table), "rules")
    FigureCanvasAgg(figure).draw()  # type: ignore[no-untyped-call]  # matplotlib's own
    [axes] = figure.axes
    bounds = [text for text in axes.texts if " to " in text.get_text()]
    boxes = [text.get_window_extent() for text in bounds]
    then = next(text for text in axes.texts if text.get_text() == "then")
    width = (then.get_position()[0] - 0.1) / inputs

    assert len(bounds) == 12 * inputs
    left = axes.get_window_extent().x0
    for box in boxes:
        first, last = ((end - left) / figure.dpi / width for end in (box.x0, box.x1))
        assert int(first + 0.05) == int(last - 0.05)
