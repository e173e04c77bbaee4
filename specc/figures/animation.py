"""Runs as films: GIF by Pillow, MP4 where ffmpeg is there."""

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from runtime.arrays import Array, Integers
from runtime.progress import Progress, in_silence
from spec_schema.diagnostics import SpecError
from specc.faults import fault
from specc.figures.palettes import PALETTES, Palette
from specc.figures.scene import NOBODY, Scene, Trails
from specc.figures.stage import TAIL, Stage, moment_of
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.trails import DOERS, SELDOM, look_of, names_of, shares_of
from specc.figures.world import LAMP
from specc.files import unknown_suffix, write_atomically

RATE: Final = 12.0
"""Frames per second."""
LONGEST: Final = 30.0
"""Seconds of a film, where no speed is asked for."""
SPEEDS: Final = (1.0, 2.0, 4.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
MOST: Final = 4.0
"""Times as long as in a film at the run's own speed are ways, at most."""
COLORS: Final = 128
"""Of a GIF."""


def animate(
    scene: Scene,
    trails: Trails,
    path: Path,
    progress: Progress | None = None,
    *,
    style: Style = Style.SCREEN,
    speed: float | None = None,
    rate: float = RATE,
) -> None:
    """Write a run as .gif or .mp4; whole or not at all.

    speed: seconds of the run in one of the film; None: so many that it is not too long.

    Raises:
        SpecError: another suffix, .mp4 without ffmpeg, or a file that can't be written.
    """
    require_film(path)
    tell = progress or in_silence
    fast = speed or speed_for(float(trails.times[-1] - trails.times[0]))
    film = frames(scene, trails, style, (rate, fast), tell)
    if path.suffix.lower() == ".gif":
        count = len(frame_rows(trails.times, rate / fast))
        data = _gif(film, count, rate, PALETTES[style])
    else:
        data = _mp4(film, path, rate)
    write_atomically(path, data)


def speed_for(duration: float) -> float:
    """The least of the usual speeds by which a film of a run is not too long.

    >>> speed_for(12.0), speed_for(120.0), speed_for(600.0)
    (1.0, 4.0, 20.0)
    """
    return next((speed for speed in SPEEDS if duration / speed <= LONGEST), SPEEDS[-1])


def require_film(path: Path) -> None:
    """Refuse what can't be written in the end, before the work begins.

    Raises:
        SpecError: another suffix, or .mp4 where there is no ffmpeg.
    """
    if path.suffix.lower() not in {".gif", ".mp4"}:
        raise unknown_suffix(path, ".gif, .mp4")
    if path.suffix.lower() == ".mp4" and shutil.which("ffmpeg") is None:
        raise _no_ffmpeg(path)


def frames(
    scene: Scene, trails: Trails, style: Style, pace: tuple[float, float], tell: Progress
) -> Iterator[Image.Image]:
    """The pictures of a film, one after the other, all of one size.

    pace: frames per second, and seconds of the run in a second.
    """
    rate, speed = pace
    rows = frame_rows(trails.times, rate / speed)
    with look(PALETTES[style]):
        told = [name for name, share in shares_of(trails).items() if share >= SELDOM]
        names = names_of(trails)
        stage = Stage(scene, trails.doers, PALETTES[style], names, speed=speed, told=told)
        for done, row in enumerate(rows.tolist()):
            tell("drawing the film", done, len(rows))
            yield stage.at(moment_of(trails, row, TAIL * min(speed, MOST)))
    tell("drawing the film", len(rows), len(rows))


def frame_rows(times: Array, rate: float) -> Integers:
    """Which samples are shown: the last one that is not later than each frame."""
    count = int(np.floor((times[-1] - times[0]) * rate + 1e-9)) + 1
    wanted = times[0] + np.arange(count) / rate
    rows: Integers = np.searchsorted(times, wanted + 1e-9, side="right").astype(np.int64) - 1
    return rows


def _gif(film: Iterator[Image.Image], count: int, rate: float, palette: Palette) -> bytes:
    """The frames, as long as they should be all together: a GIF counts hundredths of a second."""
    ends = np.round(np.arange(count + 1) * (100.0 / rate))
    first = next(film)
    table = _table(first, palette)
    coded = (frame.quantize(palette=table, dither=Image.Dither.NONE) for frame in film)
    buffer = BytesIO()
    first.quantize(palette=table, dither=Image.Dither.NONE).save(
        buffer, format="GIF", save_all=True, append_images=coded,
        duration=(10.0 * np.diff(ends)).astype(int).tolist(), loop=0, optimize=True, disposal=1,
    )  # fmt: skip
    return buffer.getvalue()


def _table(first: Image.Image, palette: Palette) -> Image.Image:
    """The colours of a GIF: what may move has its own, small as it is in the first frame."""
    looks = [str(look_of(place, palette)["color"]) for place in range(NOBODY, len(DOERS))]
    sensed = [palette.stable, palette.alarm]
    named = [*looks, *sensed, palette.ink, palette.paper, palette.tints[5], LAMP]
    own = [round(255 * part) for color in named for part in to_rgb(color)]
    rest = first.quantize(COLORS - len(named), dither=Image.Dither.NONE).getpalette() or []
    table = Image.new("P", (1, 1))
    table.putpalette((own + rest)[: 3 * COLORS])
    return table


def _mp4(film: Iterator[Image.Image], path: Path, rate: float) -> bytes:
    """The frames through ffmpeg."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise _no_ffmpeg(path)
    first = next(film)
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "film.mp4"
        size = f"{first.width}x{first.height}"
        told = [
            program, "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size,
            "-r", f"{rate:g}", "-i", "-", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
            str(made),
        ]  # fmt: skip
        with subprocess.Popen(told, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as coder:  # noqa: S603  a fixed program with our own arguments
            assert coder.stdin is not None
            with suppress(BrokenPipeError):  # it has ended already, and says why
                coder.stdin.write(first.tobytes())
                for frame in film:
                    coder.stdin.write(frame.tobytes())
            _, said = coder.communicate()
        if coder.returncode:
            why = said.decode(errors="replace").strip().splitlines()
            raise fault("V347", path.name, f"ffmpeg failed: {why[-1] if why else 'no reason'}")
        return made.read_bytes()


def _no_ffmpeg(path: Path) -> SpecError:
    message = "an .mp4 is made by ffmpeg, and no ffmpeg is on the PATH"
    return fault("V345", path, message, f"install ffmpeg, or write {path.with_suffix('.gif').name}")
