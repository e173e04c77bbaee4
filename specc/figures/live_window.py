"""A run in a window, while it is computed: `specc simulate --watch` where there is a display."""

import sys
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from os import environ
from typing import Any, Final, final

import numpy as np

from runtime.arrays import Array, Integers
from specc.figures.eyes import Glimpse
from specc.figures.live import Show
from specc.figures.pace import RATE, Pace
from specc.figures.palettes import PALETTES
from specc.figures.paper import spaced
from specc.figures.scene import Scene
from specc.figures.stage import TAIL, Moment, Stage
from specc.figures.style import look
from specc.figures.style_names import Style

OVER: Final = "the run is over: close this window to go on"


def has_display() -> bool:
    """Whether there is a desktop for windows, and not only a terminal far away."""
    if sys.platform in {"win32", "darwin"}:
        return "SSH_CONNECTION" not in environ
    return bool(environ.get("DISPLAY") or environ.get("WAYLAND_DISPLAY"))


def open_window(title: str) -> "Window | None":
    """A window; None where there is no display, or Python came without tkinter."""
    if not has_display() or find_spec("tkinter") is None:
        return None
    tkinter = import_module("tkinter")
    try:
        return Window(tkinter.Tk(), f"{spaced(title)} (specc)")
    except tkinter.TclError:
        return None


@final
class Window:
    """A window with one picture; once it is closed nothing is shown any more."""

    def __init__(self, root: Any, title: str) -> None:
        """root: tkinter's; it is imported only here, for it is not everywhere."""
        self._root, self._images = root, import_module("PIL.ImageTk")
        self._root.title(title)
        self._root.protocol("WM_DELETE_WINDOW", self._close)
        self._label = import_module("tkinter").Label(root, borderwidth=0)
        self._label.pack()
        self._picture: Any = None
        self.is_open = True

    def _close(self) -> None:
        self.is_open = False

    def show(self, stage: Stage, moment: Moment) -> None:
        """A moment of the run."""
        self._picture = self._images.PhotoImage(stage.at(moment), master=self._root)
        self._label.configure(image=self._picture)
        self._root.update()

    def hold(self, title: str, sleep: Callable[[float], None]) -> None:
        """Leave the last picture until the window is closed; Ctrl-C ends it, too."""
        self._root.title(title)
        while self.is_open:
            self._root.update()
            sleep(1.0 / RATE)

    def end(self) -> None:
        """Take it away."""
        self._root.destroy()


@contextmanager
def live_window(
    window: Window,
    scene: Scene,
    doers: Sequence[Sequence[str]],
    glimpses: Sequence[Sequence[Glimpse | None]],
    *,
    speed: float | None = 1.0,
    style: Style = Style.SCREEN,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[Show]:
    """A window; what it yields shows a moment there, and waits until its time has come.

    doers, glimpses: for each robot what may act, and what its eyes say; both may change on the way.
    Who closes the window lets the run go on unseen, as fast as it can.
    """
    pace, past = Pace(speed, clock, sleep), deque[tuple[float, Array, Integers]]()
    palette, latest = PALETTES[style], list[Array]()
    stage = Stage(scene, doers, palette, (), speed=speed or 1.0)

    def show(now: float, things: Array, robots: Array, acting: Integers) -> None:
        if not window.is_open:
            return
        pace.wait(now)
        past.append((now, robots.copy(), acting.copy()))
        while past[0][0] < now - TAIL:
            past.popleft()
        latest[:] = [things]
        if pace.is_due():
            draw()
            pace.shown()

    def draw() -> None:
        times, ways, actors = (np.array(each) for each in zip(*past, strict=True))
        seen = tuple(tuple(each) for each in glimpses)
        moment = Moment(times[-1], latest[0], ways[-1], actors[-1], ways, actors, seen)
        with look(palette):
            window.show(stage, moment)

    try:
        yield show
        if window.is_open and past:
            draw()
        window.hold(f"{spaced(scene.title)}: {OVER}", sleep)
    finally:
        window.end()
