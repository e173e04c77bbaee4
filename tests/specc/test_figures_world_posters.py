"""Posters of runs: every piece of a trail is there, in the colours of who acted."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.arrays import Array
from specc.figures.footprints import placed
from specc.figures.moments import time_step
from specc.figures.palettes import DARK, JOURNAL, SCREEN, Palette
from specc.figures.scene import NOBODY
from specc.figures.style import rendered
from specc.figures.style_names import Style
from specc.figures.trails import pieces, thinned
from specc.figures.world import draw_world, lux_colors
from tests.specc.world_scenes import scene, trails


def lightness(rgb: Array) -> Array:
    """CIE L* of sRGB colours (n, 3) (IEC 61966-2-1, CIE 15)."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    y = linear @ (0.2126, 0.7152, 0.0722)
    return np.where(y > 0.008856, 116.0 * np.cbrt(y) - 16.0, 903.3 * y)


@given(st.lists(st.integers(NOBODY, 2), min_size=1, max_size=40))
def test_pieces_cover_the_whole_way_and_change_where_the_actor_does(acting: list[int]) -> None:
    found = list(pieces(np.array(acting)))

    assert sum(last - first for _, first, last in found) == len(acting) - 1
    for doer, first, last in found:
        assert set(acting[first:last]) == {doer}


@given(st.integers(2, 80), st.integers(0, 2**32 - 1))
def test_a_thinned_way_misses_nothing_by_more_than_its_margin(count: int, seed: int) -> None:
    way = np.cumsum(np.random.default_rng(seed).normal(size=(count, 2)), axis=0)

    kept = way[thinned(way, 0.5)]

    along = np.diff(kept, axis=0)
    lengths = np.maximum((along**2).sum(axis=1), 1e-300)
    for point in way:
        share = np.clip(((point - kept[:-1]) * along).sum(axis=1) / lengths, 0.0, 1.0)
        nearest = np.hypot(*(kept[:-1] + share[:, None] * along - point).T).min()
        assert nearest <= 0.5 + 1e-9


@pytest.mark.parametrize("palette", [SCREEN, JOURNAL, DARK])
def test_light_is_shown_by_evenly_rising_lightness(palette: Palette) -> None:
    shades = np.asarray(lux_colors(palette)(np.linspace(0.0, 1.0, 11)))[:, :3]
    steps = np.diff(lightness(shades))

    assert steps.min() > 0.0
    assert steps.max() < 1.6 * steps.min()


def test_a_shape_is_turned_and_moved_to_its_pose() -> None:
    there = placed(np.array([[1.0, 0.0], [0.0, 2.0]]), np.array([3.0, 4.0, np.pi / 2.0]))

    np.testing.assert_allclose(there, [[3.0, 5.0], [1.0, 4.0]], atol=1e-12)


def test_marks_of_time_are_few_and_round() -> None:
    assert [time_step(s) for s in (1.0, 12.0, 60.0, 600.0)] == [0.5, 2.0, 10.0, 120.0]


@pytest.mark.parametrize("style", list(Style))
@pytest.mark.parametrize("lit", [True, False])
def test_a_poster_tells_who_acted_what_happened_and_what_was_required(
    style: Style, *, lit: bool
) -> None:
    figure = draw_world(scene(lit=lit), trails(), style)

    told = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    acts = {"seek acts", "avoid acts", "nobody acts"}
    assert acts | {"touched something (2)", "stuck (1)"} <= set(told)
    words = "\n".join(text.get_text() for text in figure.texts)
    assert "✗ violated by 1 cm: always r.clearance > 1 cm" in words
    assert "✓ satisfied: eventually r.x > 2 m" in words
    assert "12 s of simulated time, seed 3. Acting: seek 25 %, avoid 50 %, nobody 25 %" in words


def test_equal_runs_give_equal_bytes() -> None:
    first, second = (rendered(draw_world(scene(), trails()), "png", dpi=50) for _ in range(2))

    assert first == second
