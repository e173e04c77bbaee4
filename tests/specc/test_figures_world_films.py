"""Films of runs: as long as the run, in step with it, whole or not at all."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from spec_schema.diagnostics import SpecError
from specc.figures.animation import animate, frame_rows
from specc.figures.footprints import outline, placed
from specc.figures.labels import Box, meets_polygon
from specc.figures.moving_names import MovingNames
from specc.figures.palettes import SCREEN
from specc.figures.paper import axes_at, new_figure
from specc.figures.scene import NOBODY, Eye, EyeKind
from specc.figures.stage import Stage, even, moment_of
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.trails import DOERS, names_of, shares_of
from tests.specc.world_scenes import a_run, scene, trails


def test_frames_show_the_last_sample_that_is_not_later() -> None:
    times = np.array([0.0, 0.1, 0.24, 0.26, 0.5, 1.0])

    assert frame_rows(times, 4.0).tolist() == [0, 2, 4, 4, 5]


def test_films_are_even_in_pixels() -> None:
    assert all(round(even(inches) * 80) % 2 == 0 for inches in np.linspace(1.0, 9.0, 77))


@pytest.mark.parametrize("lit", [True, False])
def test_a_film_lasts_as_long_as_its_run(tmp_path: Path, *, lit: bool) -> None:
    path = tmp_path / "film.gif"
    told: list[tuple[str, int, int]] = []

    animate(scene(lit=lit), trails(3.0), path, lambda *now: told.append(now))

    with Image.open(path) as film:
        lasted = 0.0
        for frame in range(film.n_frames):
            film.seek(frame)
            lasted += film.info["duration"]
        assert lasted == pytest.approx(3083.0, abs=10.0)  # 37 frames, in hundredths of a second
    assert told[-1] == ("drawing the film", 37, 37)


def test_robots_have_the_colour_of_what_acts(tmp_path: Path) -> None:
    path = tmp_path / "film.gif"
    animate(scene(), trails(3.0), path, style=Style.SCREEN)

    with Image.open(path) as film:
        film.seek(film.n_frames - 1)
        colors = {color for _, color in film.convert("RGB").getcolors(1 << 16)}
    wanted = DOERS[1].removeprefix("#")  # avoid acts at the end
    assert tuple(bytes.fromhex(wanted)) in colors


def test_without_ffmpeg_an_mp4_is_refused_before_any_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))

    with pytest.raises(SpecError, match="no ffmpeg is on the PATH") as refused:
        animate(scene(), trails(1.0), tmp_path / "film.mp4")

    assert refused.value.diagnostics[0].help == "install ffmpeg, or write film.gif"
    assert not (tmp_path / "film.mp4").exists()


def test_an_interrupted_film_leaves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "film.gif"

    def interrupt(_what: str, done: int, _of: int) -> None:
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(scene(), trails(2.0), path, interrupt)

    assert list(tmp_path.iterdir()) == []


def test_another_suffix_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match=r"no output of kind '.avi' can be written"):
        animate(scene(), trails(1.0), tmp_path / "film.avi")


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.integers(0, 9))
def test_no_names_on_a_film_meet_robots_or_one_another(seed: int, robots: int, things: int) -> None:
    drawn, run = a_run(seed, robots, things)
    figure = new_figure(8.0, 4.0, SCREEN)
    axes = axes_at(figure, (0.0, 0.0), (8.0, 4.0))
    axes.set(xlim=(0.0, 4.0), ylim=(0.0, 2.0))
    names = MovingNames(axes, drawn, SCREEN)

    for row in (0, len(run.times) // 2, -1):
        names.move(run.things[row], run.robots[row])
        boxes = [*names.shown.values()]
        hulls = [
            144.0 * placed(part, pose)  # two inches for a metre
            for item, pose in zip(drawn.robots, run.robots[row], strict=True)
            for part in outline(item.shape)
        ]
        for index, box in enumerate(boxes):
            assert box.is_in(Box(0.0, 0.0, 576.0, 288.0))
            assert not any(box.meets(other) for other in boxes[:index])
            assert not any(meets_polygon(box, hull) for hull in hulls)


def test_a_name_is_stamped_where_its_box_is_and_nowhere_else() -> None:
    drawn, run = a_run(3, 1, 0)
    figure = new_figure(8.0, 4.0, SCREEN)
    axes = axes_at(figure, (0.0, 0.0), (8.0, 4.0))
    axes.set(xlim=(0.0, 4.0), ylim=(0.0, 2.0))
    names = MovingNames(axes, replace(drawn, lamps=()), SCREEN)
    names.move(run.things[0], run.robots[0])
    picture = np.full((400, 800, 3), 200, dtype=np.uint8)

    names.stamp(picture)

    (box,) = names.shown.values()
    rows, columns = np.nonzero((picture != 200).any(axis=2))
    pixels = 100.0 / 72.0 * np.array([box.left, 288.0 - box.high, box.right, 288.0 - box.low])
    np.testing.assert_allclose(
        [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1], pixels, atol=1.0
    )


def test_the_legend_of_a_film_tells_of_those_who_act_often_and_of_sensors() -> None:
    eye = Eye(EyeKind.RANGE, 0.0, 0.0, 0.0, 1.0, 1.0)
    drawn = scene(lit=False)
    drawn = replace(drawn, robots=(replace(drawn.robots[0], eyes=(eye,)),))
    run = trails()
    acting = np.where(np.arange(len(run.times)) < 5, NOBODY, 0)[:, None]
    shares = shares_of(replace(run, acting=acting))
    stage = Stage(
        drawn, run.doers, SCREEN, names_of(run), told=[n for n, s in shares.items() if s > 0.02]
    )

    with look(SCREEN):
        stage.at(moment_of(run, 0))

    (legend,) = stage._figure.legends
    told = [text.get_text() for text in legend.get_texts()]
    assert told == ["seek acts", "found by a sensor", "free up to there"]
