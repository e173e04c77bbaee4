"""A run in the terminal, while it is computed or as a replay: `specc simulate --watch`."""

import math
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final, TypeAlias, final

from rich.console import Console, RenderableType
from rich.live import Live
from rich.table import Table
from rich.text import Text

from runtime.arrays import Array, Integers
from specc.figures.braille import Canvas
from specc.figures.footprints import lamps_at, outline, placed, reach_of
from specc.figures.names import named_on_films
from specc.figures.pace import Pace
from specc.figures.quantities import number
from specc.figures.scene import NOBODY, Scene
from specc.figures.world import bounds

Show: TypeAlias = Callable[[float, Array, Array, Integers], None]
"""Is told a time, poses of things (t, 3) and of robots (r, 3), and who acts (r,)."""

TAIL: Final = 10.0
"""Seconds of way that robots draw behind them."""
SIDE: Final = 24
"""Letters beside the floor."""
SMALLEST: Final = (44, 8)
"""Columns and rows of a terminal in which anything can be seen."""
CORNERS: Final = 24
STYLES: Final = ("yellow", "magenta", "green", "cyan", "red", "bright_yellow", "blue")
QUIET: Final = "bright_black"
ARROWS: Final = "→↗↑↖←↙↓↘"
PLAIN: Final = ">/^\\</v\\"


@final
class View:
    """Draws one moment of a run as letters that fit a terminal."""

    def __init__(self, scene: Scene, doers: Sequence[Sequence[str]], console: Console) -> None:
        self._scene, self._doers, self._console = scene, doers, console
        self._names: tuple[str, ...] = ()
        self._plain = not console.encoding.lower().startswith("utf")
        self._things = [outline(item.shape, CORNERS) for item in scene.things]
        self._robots = [outline(item.shape, CORNERS) for item in scene.robots]
        self._named = named_on_films(scene)
        self._size = (0, 0)
        self._still: Canvas | None = None
        self._ways: deque[tuple[float, Array, Integers]] = deque()

    def at(self, now: float, things: Array, robots: Array, acting: Integers) -> RenderableType:
        """The moment as something that rich prints."""
        self._names = tuple(dict.fromkeys(name for names in self._doers for name in names))
        self._ways.append((now, robots[:, :2].copy(), acting.copy()))
        while self._ways[0][0] < now - TAIL:
            self._ways.popleft()
        size = self._console.size
        if size.width < SMALLEST[0] or size.height < SMALLEST[1]:
            return Text(f"{number(now)} s (this terminal is too small to show more)", end="")
        if self._still is None or self._size != (size.width, size.height):
            self._size = (size.width, size.height)
            self._still = self._ground(things)
        canvas = self._still.copy()
        self._draw(canvas, things, robots, acting)
        table = Table.grid(padding=(0, 1))
        table.add_column(no_wrap=True, width=canvas.columns)
        table.add_column(no_wrap=True, width=SIDE - 2, overflow="ellipsis")
        table.add_row(canvas.text(), self._beside(now, acting))
        return table

    def _ground(self, things: Array) -> Canvas:
        """Walls and what can't move, drawn once for a size of the terminal."""
        width, height = self._size
        canvas = Canvas(width - SIDE - 1, height - 2, bounds(self._scene), ascii_only=self._plain)
        canvas.stroke(self._scene.arena, "bold", closed=True)
        for index, item in enumerate(self._scene.things):
            if item.is_fixed:
                for part in self._things[index]:
                    canvas.stroke(placed(part, things[index]), "bold", closed=True)
        return canvas

    def _draw(self, canvas: Canvas, things: Array, robots: Array, acting: Integers) -> None:
        for index, item in enumerate(self._scene.things):
            if not item.is_fixed:
                for part in self._things[index]:
                    canvas.stroke(placed(part, things[index]), closed=True)
        for _, points, doers in self._ways:
            for robot, point in enumerate(points):
                canvas.dots(point[None, :], self._style(robot, int(doers[robot])))
        for x, y in lamps_at(self._scene, things).tolist():
            canvas.letter(x, y, "*", "bold bright_yellow")
        for robot, pose in enumerate(robots):
            style = self._style(robot, int(acting[robot]))
            for part in self._robots[robot]:
                canvas.stroke(placed(part, pose), style, closed=True)
            x, y, heading = pose.tolist()
            canvas.letter(x, y, self._arrow(heading), f"bold {style}")
        self._name(canvas, things, robots, acting)

    def _name(self, canvas: Canvas, things: Array, robots: Array, acting: Integers) -> None:
        """Names, each where nothing else is drawn; first those of robots."""
        for robot, (x, y, _) in enumerate(robots.tolist()):
            style = f"bold {self._style(robot, int(acting[robot]))}"
            reach = reach_of(self._robots[robot])
            canvas.word((x, y), self._scene.robots[robot].name, style, reach)
        for lamp, (x, y) in zip(
            self._scene.lamps, lamps_at(self._scene, things).tolist(), strict=True
        ):
            canvas.word((x, y), lamp.name)
        for index in self._named:
            x, y, _ = things[index].tolist()
            canvas.word((x, y), self._scene.things[index].name, "", reach_of(self._things[index]))

    def _beside(self, now: float, acting: Integers) -> Text:
        """The time, and who has its way in each robot."""
        text = Text(no_wrap=True, overflow="ellipsis")
        text.append(f"{self._scene.title}\n", "bold")
        text.append(f"{now:.1f} s\n\n")
        for robot, item in enumerate(self._scene.robots):
            doer = int(acting[robot])
            name = "nobody" if doer == NOBODY else self._doers[robot][doer]
            text.append(f"{item.name}: ", "bold")
            text.append(f"{name}\n", self._style(robot, doer))
        text.append(f"\n{self._arrow(0.0)}", "bold")
        text.append(" robot")
        if self._scene.lamps:
            text.append("\n*", "bold bright_yellow")
            text.append(" light")
        return text

    def _arrow(self, heading: float) -> str:
        """A letter that points where a robot looks."""
        return (PLAIN if self._plain else ARROWS)[round(heading / (math.pi / 4.0)) % 8]

    def _style(self, robot: int, doer: int) -> str:
        if doer == NOBODY:
            return QUIET
        return STYLES[self._names.index(self._doers[robot][doer]) % len(STYLES)]


@contextmanager
def live_view(
    scene: Scene,
    doers: Sequence[Sequence[str]],
    console: Console,
    *,
    speed: float | None = 1.0,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[Show]:
    """A view in the terminal; what it yields shows a moment, and waits until its time has come.

    doers: for each robot the names of what may act; they may become more on the way.
    speed: seconds of the run in one of a clock on the wall; None: as fast as it comes.
    The terminal is as before afterwards, also after an exception such as Ctrl-C.
    """
    view = View(scene, doers, console)
    last: tuple[float, Array, Array, Integers] | None = None
    pace = Pace(speed, clock, sleep)
    with Live(
        console=console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False
    ) as live:

        def show(now: float, things: Array, robots: Array, acting: Integers) -> None:
            nonlocal last
            pace.wait(now)
            last = (now, things, robots, acting)
            if pace.is_due():
                live.update(view.at(*last), refresh=True)
                pace.shown()

        yield show
        if last is not None:
            live.update(view.at(*last), refresh=True)
