"""Runs as films: GIF by Pillow, MP4 where ffmpeg is there.

What stands still is drawn once; each frame draws only what moves, on a copy of that.
"""

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, Final, TypeAlias, final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from PIL import Image

from runtime.arrays import Array, Integers
from spec_schema.diagnostics import SpecError
from specc.faults import fault
from specc.figures.legend import Entry, draw_legend, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import axes_at, new_figure
from specc.figures.scene import NOBODY, Scene, Trails
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.trails import DOERS, look_of, names_of
from specc.figures.world import LAMP, bounds, floor, light_image, outline, patch, placed
from specc.files import unknown_suffix, write_atomically

Progress: TypeAlias = Callable[[str, int, int], None]

RATE: Final = 12.0
"""Frames per second of the run's time."""
DPI: Final = 80
LONG: Final = 6.4
"""Inches of the longer side of the floor."""
HEAD: Final = 0.45
LEGEND: Final = 1.6
MARGIN: Final = 0.12
TAIL: Final = 8.0
"""Seconds of way that a robot draws behind it."""
COLORS: Final = 128
"""Of a GIF."""
CORNERS: Final = 20


def animate(
    scene: Scene,
    trails: Trails,
    path: Path,
    progress: Progress | None = None,
    *,
    style: Style = Style.SCREEN,
    rate: float = RATE,
) -> None:
    """Write a run as .gif or .mp4, at the speed of its time; whole or not at all.

    Raises:
        SpecError: another suffix, .mp4 without ffmpeg, or a file that can't be written.
    """
    require_film(path)
    tell = progress or _in_silence
    film = frames(scene, trails, style, rate, tell)
    if path.suffix.lower() == ".gif":
        data = _gif(film, len(frame_rows(trails.times, rate)), rate, PALETTES[style])
    else:
        data = _mp4(film, rate)
    write_atomically(path, data)


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
    scene: Scene, trails: Trails, style: Style, rate: float, tell: Progress
) -> Iterator[Image.Image]:
    """The pictures of a film, one after the other, all of one size."""
    rows = frame_rows(trails.times, rate)
    with look(PALETTES[style]):
        stage = _Stage(scene, trails, PALETTES[style])
        for done, row in enumerate(rows.tolist()):
            tell("drawing", done, len(rows))
            yield stage.at(row)
    tell("drawing", len(rows), len(rows))


def frame_rows(times: Array, rate: float) -> Integers:
    """Which samples are shown: the last one that is not later than each frame."""
    count = int(np.floor((times[-1] - times[0]) * rate + 1e-9)) + 1
    wanted = times[0] + np.arange(count) / rate
    rows: Integers = np.searchsorted(times, wanted + 1e-9, side="right").astype(np.int64) - 1
    return rows


@final
class _Stage:
    """What stands still, drawn once, and the parts that are moved for each frame."""

    def __init__(self, scene: Scene, trails: Trails, palette: Palette) -> None:
        self._scene, self._trails, self._palette = scene, trails, palette
        self._names, self._glow = names_of(trails), scene.glow
        figure, self._axes, self._image = _set(scene, trails, palette)
        self._canvas = _canvas(figure)
        self._things = [outline(item.shape, CORNERS) for item in scene.things]
        self._robots = [outline(item.shape, CORNERS) for item in scene.robots]
        self._loose = [i for i, item in enumerate(scene.things) if not item.is_fixed]
        self._moving = self._movers(figure)
        self._figure, self._lit = figure, -1
        self._relight(0)

    def at(self, row: int) -> Image.Image:
        """The frame of one sample."""
        self._move(row)
        if self._glow is not None:
            self._relight(self._glow.at(float(self._trails.times[row])))
        self._canvas.restore_region(self._still)
        for artist in self._moving:
            artist.draw(self._canvas.get_renderer())
        return Image.fromarray(np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy())

    def _relight(self, lit: int) -> None:
        """Draw all that stands still, where the light is another than before."""
        if lit == self._lit:
            return
        self._lit = lit
        if self._glow is not None and self._image is not None:
            self._image.set_data(self._glow.lux[lit])
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self._figure.bbox)

    def _movers(self, figure: Figure) -> list[Artist]:
        palette = self._palette
        self._pushed = PolyCollection([], fc=palette.tints[5], ec=palette.ink, lw=0.8, zorder=3)
        self._ways = LineCollection([], linewidths=2.2, zorder=4)
        self._bodies = PolyCollection([], ec=palette.ink, lw=1.0, zorder=5)
        self._noses = LineCollection([], colors=palette.paper, linewidths=1.6, zorder=6)
        movers: list[Artist] = [self._pushed, self._ways, self._bodies, self._noses]
        for collection in (self._pushed, self._ways, self._bodies, self._noses):
            self._axes.add_collection(collection, autolim=False)
        (self._lamps,) = self._axes.plot(
            [], [], "*", ms=13.0, mfc=LAMP, mec=palette.ink, mew=0.8, zorder=8
        )
        width, height = figure.get_size_inches()
        self._clock = figure.text(
            1.0 - MARGIN / width, 1.0 - 0.1 / height, "", fontsize=11, ha="right", va="top"
        )
        movers += [self._lamps, self._clock]
        for artist in movers:
            artist.set_animated(True)
        return movers

    def _move(self, row: int) -> None:
        trails = self._trails
        poses = trails.things[row]
        self._pushed.set_verts(
            [placed(part, poses[i]) for i in self._loose for part in self._things[i]]
        )
        self._bodies.set_verts(
            [
                placed(p, trails.robots[row, i])
                for i, parts in enumerate(self._robots)
                for p in parts
            ]
        )
        self._bodies.set_facecolor(
            [self._color(i, row) for i, parts in enumerate(self._robots) for _ in parts]
        )
        self._noses.set_segments(
            [
                placed(np.array([[0.0, 0.0], [_reach(parts), 0.0]]), trails.robots[row, i])
                for i, parts in enumerate(self._robots)
            ]
        )
        self._draw_ways(row)
        self._lamps.set_data(*np.array(_lamps(self._scene, poses)).reshape(-1, 2).T)
        self._clock.set_text(f"{trails.times[row]:.1f} s")

    def _draw_ways(self, row: int) -> None:
        """The last seconds of each robot's way, a piece for each frame, by who acted."""
        trails = self._trails
        first = int(np.searchsorted(trails.times, trails.times[row] - TAIL))
        step = max((row - first) // 80, 1)
        marks = np.append(np.arange(first, row, step), row)
        segments, colors = [], []
        for robot in range(len(self._robots)):
            points = trails.robots[marks, robot, :2]
            segments += list(np.stack([points[:-1], points[1:]], axis=1))
            colors += [self._color(robot, mark) for mark in marks[:-1].tolist()]
        self._ways.set_segments(segments)
        self._ways.set_color(colors or ["none"])

    def _color(self, robot: int, row: int) -> str:
        doer = int(self._trails.acting[row, robot])
        place = NOBODY if doer == NOBODY else self._names.index(self._trails.doers[robot][doer])
        return str(look_of(place, self._palette)["color"])


def _set(scene: Scene, trails: Trails, palette: Palette) -> tuple[Figure, Axes, AxesImage | None]:
    """The figure with all that stands still, and the light on its floor."""
    left, low, right, high = bounds(scene)
    scale = LONG / max(right - left, high - low)
    size = (scale * (right - left), scale * (high - low))
    width = even(MARGIN * 2 + size[0] + LEGEND)
    height = even(MARGIN + max(size[1], 1.2) + HEAD)
    figure = new_figure(width, height, palette)
    figure.set_dpi(DPI)
    axes = axes_at(figure, (MARGIN, MARGIN), size)
    floor(axes, scene)
    axes.set_xticks([])
    axes.set_yticks([])
    shown = None
    if scene.glow is not None:
        shown = light_image(axes, scene.glow, palette)
        shown.set_clip_path(patch([scene.arena]).get_path(), axes.transData)
    for index, item in enumerate(scene.things):
        if item.is_fixed:
            parts = [placed(part, trails.things[0, index]) for part in outline(item.shape)]
            axes.add_patch(patch(parts, fc=palette.faint, ec=palette.ink, lw=0.8, zorder=2))
    title = scene.title.replace("_", " ")
    figure.text(MARGIN / width, 1.0 - 0.1 / height, title, fontsize=12, fontweight="bold", va="top")
    corner = ((MARGIN + size[0] + 0.12) / width, (MARGIN + size[1]) / height)
    draw_legend(figure, _entries(trails, palette), corner)
    return figure, axes, shown


def _canvas(figure: Figure) -> Any:
    """What a figure is drawn on; its methods have no types."""
    return FigureCanvasAgg(figure)


def even(inches: float) -> float:
    """A length that is an even number of pixels, as coders of films want it.

    >>> even(1.0), even(1.001) * 80
    (1.0, 82.0)
    """
    return 2 * int(np.ceil(0.5 * inches * DPI - 1e-9)) / DPI


def _entries(trails: Trails, palette: Palette) -> list[Entry]:
    """What each colour of a robot and its way means."""
    places: Iterable[tuple[int, str]] = enumerate(names_of(trails))
    drawn = [(place, f"{name} acts") for place, name in places]
    drawn += [(NOBODY, "nobody acts")] if (trails.acting == NOBODY).any() else []
    return [
        line_entry(label, color=look_of(place, palette)["color"], linewidth=2.6)
        for place, label in drawn
    ]


def _reach(parts: list[Array]) -> float:
    return max(float(np.hypot(part[:, 0], part[:, 1]).max()) for part in parts)


def _lamps(scene: Scene, poses: Array) -> list[Array]:
    """Where lights are."""
    return [
        placed(np.array([[lamp.x, lamp.y]]), poses[lamp.on] if lamp.on >= 0 else np.zeros(3))[0]
        for lamp in scene.lamps
    ]


def _gif(film: Iterator[Image.Image], count: int, rate: float, palette: Palette) -> bytes:
    """The frames, as long as they should be all together: a GIF counts hundredths of a second."""
    ends = np.round(np.arange(count + 1) * (100.0 / rate))
    first = next(film)
    table = _table(first, palette)
    coded = (frame.quantize(palette=table, dither=Image.Dither.NONE) for frame in film)
    buffer = BytesIO()
    first.quantize(palette=table, dither=Image.Dither.NONE).save(
        buffer, format="GIF", save_all=True, append_images=coded,
        duration=(10.0 * np.diff(ends)).astype(int).tolist(), loop=0, optimize=False, disposal=1,
    )  # fmt: skip
    return buffer.getvalue()


def _table(first: Image.Image, palette: Palette) -> Image.Image:
    """The colours of a GIF: what may move has its own, small as it is in the first frame."""
    looks = [str(look_of(place, palette)["color"]) for place in range(NOBODY, len(DOERS))]
    named = [*looks, palette.ink, palette.paper, palette.tints[5], LAMP]
    own = [round(255 * part) for color in named for part in to_rgb(color)]
    rest = first.quantize(COLORS - len(named), dither=Image.Dither.NONE).getpalette() or []
    table = Image.new("P", (1, 1))
    table.putpalette((own + rest)[: 3 * COLORS])
    return table


def _mp4(film: Iterator[Image.Image], rate: float) -> bytes:
    """The frames through ffmpeg."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise _no_ffmpeg(Path("film.mp4"))
    first = next(film)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.mp4"
        size = f"{first.width}x{first.height}"
        told = [
            program, "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size,
            "-r", f"{rate:g}", "-i", "-", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
            str(path),
        ]  # fmt: skip
        with subprocess.Popen(told, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as coder:  # noqa: S603  a fixed program with our own arguments
            assert coder.stdin is not None
            coder.stdin.write(first.tobytes())
            for frame in film:
                coder.stdin.write(frame.tobytes())
            _, said = coder.communicate()
        if coder.returncode:
            why = said.decode(errors="replace").strip().splitlines()
            raise fault("V347", path.name, f"ffmpeg failed: {why[-1] if why else 'no reason'}")
        return path.read_bytes()


def _no_ffmpeg(path: Path) -> SpecError:
    message = "an .mp4 is made by ffmpeg, and no ffmpeg is on the PATH"
    return fault("V345", path, message, f"install ffmpeg, or write {path.with_suffix('.gif').name}")


def _in_silence(_what: str, _done: int, _of: int) -> None:
    """Nobody watches."""
