"""A run as lines of text, for a pipe or a file: where robots are and who acts, now and then."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final

from rich.console import Console
from rich.text import Text

from runtime.arrays import Array, Integers
from specc.figures.live import Show
from specc.figures.moments import STEPS
from specc.figures.quantities import degrees, number, seconds
from specc.figures.scene import NOBODY, Scene

MOST: Final = 60
"""Lines of a run for each robot, at most."""


def line_every(duration: float) -> float:
    """Seconds between two lines: the least of the usual ones that gives few enough.

    >>> line_every(20.0), line_every(60.0), line_every(600.0)
    (0.5, 1.0, 10.0)
    """
    return next((step for step in STEPS if duration / step <= MOST), STEPS[-1])


@contextmanager
def live_lines(
    scene: Scene, doers: Sequence[Sequence[str]], console: Console, *, duration: float
) -> Iterator[Show]:
    """What it yields prints a line for each robot at round times, and the last moment; no waiting.

    doers: for each robot what may act; it may grow.
    """
    every = line_every(duration)
    due = 0.0
    last: Callable[[], None] | None = None

    def show(now: float, things: Array, robots: Array, acting: Integers) -> None:  # noqa: ARG001  as of all that show
        nonlocal due, last

        def tell() -> None:
            for robot, pose in enumerate(robots):
                console.print(Text(_line(scene, doers, robot, now, pose, int(acting[robot]))))

        last = tell
        if now >= due - 1e-9:
            tell()
            last = None
            due += every

    yield show
    if last is not None:
        last()


def _line(
    scene: Scene, doers: Sequence[Sequence[str]], robot: int, now: float, pose: Array, doer: int
) -> str:
    x, y, heading = pose.tolist()
    who = "nobody" if doer == NOBODY else doers[robot][doer]
    at = f"x {number(x)} m, y {number(y)} m, heading {degrees(heading)}"
    return f"{seconds(now)}  {scene.robots[robot].name}: {at}; {who} acts"
