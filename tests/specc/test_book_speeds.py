"""What a mode moves alike everywhere has no portrait, but a plane over what is sensed."""

from pathlib import Path

import numpy as np

from runtime.program import Program
from specc.book.manifest import Setting
from specc.book.speeds import moves_alike, speeds_at
from specc.book.views import views_at
from specc.figures.palettes import PALETTES
from specc.figures.rate_plane import draw_rate_plane
from specc.figures.style import rendered
from specc.figures.style_names import Style
from specc.loading import load_program

SPECS = Path(__file__).parents[2] / "specs"


def program(name: str) -> Program:
    return load_program(SPECS / f"{name}.yaml", allow_code=False)


def default(of: Program) -> tuple[Setting, ...]:
    return (Setting("default", (), {c.name: c.default for c in of.controls}),)


def test_a_turn_that_is_alike_in_every_direction_has_no_portrait() -> None:
    avoid = program("avoid")
    assert all(moves_alike(avoid, index) for index in (0, 1))
    assert views_at(avoid, default(avoid)) == ()


def test_its_plane_has_the_rates_and_the_line_of_the_spec() -> None:
    avoid = program("avoid")
    to_left, to_right = speeds_at(avoid, default(avoid))
    left, right = np.meshgrid(*to_left.nodes, indexing="ij")
    assert [axis.name for axis in to_left.axes] == ["left", "right"]
    assert np.allclose(to_left.rates, 1.5 / (1.0 + (left / 0.5) ** 2) + 0.5, atol=0.02)
    assert np.allclose(to_right.rates, -1.5 / (1.0 + (right / 0.5) ** 2) - 0.5, atol=0.02)
    (way,) = to_left.exits
    assert way.target == "to_right"
    clear = np.abs(right - left - 0.3) > 1e-9
    assert np.array_equal((way.open >= 0.0)[clear], (right >= left + 0.3)[clear])


def test_a_threshold_that_no_eye_sees_makes_no_plane() -> None:
    battery = program("battery")  # 10 lx of 10,000 lx
    assert speeds_at(battery, default(battery)) == ()


def test_planes_are_drawn_to_the_same_bytes() -> None:
    avoid = program("avoid")
    for style in (Style.SCREEN, Style.DARK):
        one, other = (
            rendered(
                draw_rate_plane(speeds_at(avoid, default(avoid))[0], style), "svg", PALETTES[style]
            )
            for _ in range(2)
        )
        assert one == other
        assert b"<svg" in one
