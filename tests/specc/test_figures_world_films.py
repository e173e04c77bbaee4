"""Films of runs: as long as the run, in step with it, whole or not at all."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from spec_schema.diagnostics import SpecError
from specc.figures.animation import animate, frame_rows
from specc.figures.stage import even
from specc.figures.style_names import Style
from specc.figures.trails import DOERS
from tests.specc.world_scenes import scene, trails


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
