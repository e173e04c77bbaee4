"""Drawing portraits: every kind can be drawn, the same bytes each time, seams are respected."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import rcParams

from runtime.program import Kind, Program, Unit
from specc.figures.axes_of_states import split_at_seams
from specc.figures.portrait import draw_portrait
from specc.figures.style import Format, rendered
from tests.verifier.topology_scenes import (
    OSCILLATOR,
    behavior,
    control,
    henon,
    line,
    pendulum,
    plane,
    state,
    van_der_pol,
)
from verifier.topology.features import AxisRange
from verifier.topology.portrait import Detail, portrait

SMALL = Detail(plane=65, line=257, trajectories=2)

ANGLES = behavior(
    "torus",
    tuple(state(n, -math.pi, math.pi, kind=Kind.PERIODIC, unit=Unit("rad", 1.0)) for n in "ab"),
    ("b sin", "a sin"),
)
LOGISTIC = behavior(
    "logistic",
    (state("x", 0.0, 1.0),),
    ("r x mul 1 x sub mul",),
    (control("r", 0.0, 4.0, 3.2),),
    every=1.0,
)


def legend(program: Program) -> list[str]:
    (axes,) = draw_portrait(portrait(program, detail=SMALL)).axes
    return [text.get_text() for text in axes.get_legend().get_texts()]


@pytest.mark.parametrize(
    "program",
    [
        van_der_pol(),
        OSCILLATOR,
        ANGLES,
        LOGISTIC,
        line("x neg"),
        line("0"),
        plane("0", "0"),
        plane("x sqrt", "y neg"),
    ],
)
def test_every_portrait_can_be_drawn(program: Program) -> None:
    assert draw_portrait(portrait(program, detail=SMALL)).axes


@pytest.mark.parametrize("program", [pendulum(), henon()], ids=lambda p: p.name)
def test_the_same_portrait_gives_the_same_bytes(program: Program) -> None:
    found = portrait(program, detail=SMALL)

    first, second = (rendered(draw_portrait(found), "svg") for _ in range(2))

    assert first == second
    assert first.startswith(b"<?xml")


@pytest.mark.parametrize(("form", "magic"), [("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_other_formats_are_deterministic_too(form: Format, magic: bytes) -> None:
    found = portrait(line("x neg"), detail=SMALL)

    first, second = (rendered(draw_portrait(found), form, dpi=60) for _ in range(2))

    assert first == second
    assert first.startswith(magic)


def test_the_legend_names_what_is_drawn() -> None:
    names = legend(pendulum())

    assert names[:2] == ["stable focus", "saddle"]
    assert {"d angle/dt = 0", "d rate/dt = 0", "stable manifold", "unstable manifold"} <= set(names)


def test_a_map_is_labelled_as_one() -> None:
    assert {"next x = x", "orbit"} <= set(legend(henon()))


def test_axes_carry_names_and_units_and_angles_multiples_of_pi() -> None:
    (axes,) = draw_portrait(portrait(pendulum(), detail=SMALL)).axes

    assert axes.get_xlabel() == "angle [rad]"
    assert axes.get_ylabel() == "rate [rad/s]"
    labels = [tick.get_text() for tick in axes.get_xticklabels()]
    assert labels[0] == "−π"
    assert labels[-1] == "π"
    assert "π/2" in labels


def test_the_title_names_the_behavior_and_what_is_held() -> None:
    texts = [t.get_text() for t in draw_portrait(portrait(pendulum(0.3), detail=SMALL)).texts]

    assert texts[:2] == ["Pendulum", "friction = 0.3"]


def test_drawing_leaves_matplotlibs_settings_alone() -> None:
    before = dict(rcParams)

    rendered(draw_portrait(portrait(line("x neg"), detail=SMALL)), "svg")

    assert dict(rcParams) == before


ANGLE = AxisRange("angle", Unit("rad", 1.0), -math.pi, math.pi, periodic=True)
HEIGHT = AxisRange("height", Unit("m", 1.0), 0.0, 1.0, periodic=False)


@given(
    st.lists(st.floats(-1.5, 1.5), min_size=1, max_size=30),
    st.floats(-20.0, 20.0),
)
def test_a_path_cut_at_its_seams_lies_in_the_domain_and_keeps_its_length(
    steps: list[float], start: float
) -> None:
    angle = start + np.concatenate([[0.0], np.cumsum(steps)])
    path = np.stack([angle, np.linspace(0.0, 1.0, len(angle))], axis=-1)

    pieces = split_at_seams((ANGLE, HEIGHT), path)

    inside = np.concatenate(pieces)[:, 0]
    assert np.all((inside >= -math.pi - 1e-9) & (inside <= math.pi + 1e-9))
    lengths = [np.linalg.norm(np.diff(piece, axis=0), axis=-1).sum() for piece in pieces]
    expected = np.linalg.norm(np.diff(path, axis=0), axis=-1).sum()
    assert sum(lengths) == pytest.approx(expected, rel=1e-9, abs=1e-9)
