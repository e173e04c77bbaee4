"""What happened along a way, and when: marks of time, touches, and where robots were stuck."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes

from specc.figures.labels import Labels, Note, Words
from specc.figures.legend import Entry, Look, line_entry
from specc.figures.palettes import Palette
from specc.figures.quantities import seconds
from specc.figures.scene import Mark, Trails

STEPS: Final = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0)
"""Seconds between two marks of time."""
MOST_MARKS: Final = 8
DOT: Final = 2.4
"""Points from the middle of a mark of time to its rim."""
SQUARE: Final = 5.5
"""Points from the middle of a square, where a robot was stuck, to its side."""
NEAR: Final = 4.0
"""Points between two marks that are told of together."""
MOST_WORDS: Final = 6
"""Places with words of how long a robot was stuck there; of more only the legend tells."""
OLD: Final = 0.25
"""How strongly a touch is drawn that was long ago."""


@final
@dataclass(frozen=True, slots=True)
class Stop:
    """A place on a robot's way, with the marks of time that lie there: their numbers."""

    x: float
    y: float
    counts: tuple[int, ...]

    def text(self, step: float) -> str:
        """When the robot was there.

        >>> Stop(0.0, 0.0, (2,)).text(10.0), Stop(0.0, 0.0, (2, 3, 4)).text(10.0)
        ('20 s', '20 s to 40 s')
        >>> Stop(0.0, 0.0, (2, 5)).text(10.0)
        '20 s, 50 s'
        """
        counts, told = self.counts, []
        breaks = [i for i in range(1, len(counts)) if counts[i] != counts[i - 1] + 1]
        for first, after in zip([0, *breaks], [*breaks, len(counts)], strict=True):
            begun, ended = seconds(counts[first] * step), seconds(counts[after - 1] * step)
            told.append(begun if after == first + 1 else f"{begun} to {ended}")
        return ", ".join(told)


def time_step(duration: float) -> float:
    """Seconds between marks: the least of the usual ones that gives few enough.

    >>> time_step(60.0), time_step(3.0)
    (10.0, 0.5)
    """
    return next((step for step in STEPS if duration / step <= MOST_MARKS), STEPS[-1])


def stops_of(trails: Trails, robot: int, near: float) -> tuple[float, list[Stop]]:
    """The seconds between marks of time, and where they lie; those within `near` m together."""
    times = trails.times
    step = time_step(float(times[-1] - times[0]))
    found: list[Stop] = []
    first = math.floor(float(times[0]) / step + 1e-9) + 1
    for count in range(first, math.ceil(float(times[-1]) / step - 1e-9)):
        at = int(np.searchsorted(times, count * step - 1e-9))
        x, y = trails.robots[at, robot, :2].tolist()
        here = next((i for i, s in enumerate(found) if math.hypot(s.x - x, s.y - y) < near), None)
        if here is None:
            found.append(Stop(x, y, (count,)))
        else:
            old = found[here]
            found[here] = Stop(old.x, old.y, (*old.counts, count))
    return step, found


def mark_times(axes: Axes, trails: Trails, labels: Labels, palette: Palette) -> list[Note]:
    """Dots along all ways at round times; gives what is to be written beside them."""
    marks = [
        (step, stop)
        for robot in range(trails.robots.shape[1])
        for step, stops in [stops_of(trails, robot, NEAR / labels.per_metre)]
        for stop in stops
    ]
    for _, stop in marks:
        axes.plot(
            stop.x, stop.y, "o", ms=3.4, mfc=palette.paper, mec=palette.ink, mew=0.9, zorder=6
        )
        labels.keep_off_mark((stop.x, stop.y), DOT)
    return [
        Note(Words(stop.text(step), 7.0, palette.ink, palette.paper), (stop.x, stop.y), DOT)
        for step, stop in marks
    ]


def mark_touches(
    axes: Axes, trails: Trails, since: float, labels: Labels, palette: Palette
) -> list[Entry]:
    """Where robots touched something; faint, where that was before `since`."""
    touch: Look = {
        "marker": "x", "linestyle": "None", "ms": 5.0, "mew": 1.4, "color": palette.alarm,
        "zorder": 7,
    }  # fmt: skip
    if not trails.contacts:
        return []
    near = NEAR / labels.per_metre
    old = apart([m for m in trails.contacts if m.time < since], near)
    new = apart([m for m in trails.contacts if m.time >= since], near)
    for marks, alpha in ((old, OLD), (new, 1.0)):
        if marks:
            axes.plot([m.x for m in marks], [m.y for m in marks], **touch, alpha=alpha)
    labels.spare_places(np.array([(m.x, m.y) for m in new]).reshape(-1, 2))
    return [line_entry(f"touched something ({len(trails.contacts)})", **touch)]


def mark_jams(
    axes: Axes, trails: Trails, labels: Labels, palette: Palette
) -> tuple[list[Entry], list[Note]]:
    """Squares where robots were stuck; gives what is to be written beside them, too."""
    stuck: Look = {
        "marker": "s", "linestyle": "None", "ms": 9.0, "mew": 1.6, "mec": palette.alarm,
        "mfc": "none", "zorder": 7,
    }  # fmt: skip
    if not trails.jams:
        return [], []
    notes = []
    for marks in gathered(trails.jams, 2.0 * SQUARE / labels.per_metre):
        at = (marks[0].x, marks[0].y)
        axes.plot(*at, **stuck)
        labels.keep_off_mark(at, SQUARE)
        notes.append(Note(Words(_how_long(marks), 7.0, palette.alarm, palette.paper), at, SQUARE))
    count, longest = len(trails.jams), max(jam.end - jam.time for jam in trails.jams)
    told = f"stuck ({count})" if count == 1 else f"stuck ({count}, at most {seconds(longest)})"
    return [line_entry(told, **stuck)], notes if len(notes) <= MOST_WORDS else []


def _how_long(marks: Sequence[Mark]) -> str:
    """How long a robot was stuck at a place: each time, where that was seldom."""
    spans = [mark.end - mark.time for mark in marks]
    if len(spans) > 2:
        return f"stuck {len(spans)} times, at most {seconds(max(spans))}"
    return "stuck for " + " and ".join(seconds(span) for span in spans)


def gathered(marks: Sequence[Mark], near: float) -> list[list[Mark]]:
    """Marks that lie within `near` metres of the first of them, together."""
    found: list[list[Mark]] = []
    for mark in marks:
        for here in found:
            if math.hypot(here[0].x - mark.x, here[0].y - mark.y) < near:
                here.append(mark)
                break
        else:
            found.append([mark])
    return found


def apart(marks: Sequence[Mark], near: float) -> list[Mark]:
    """One of all marks that lie within `near` metres of it."""
    return [marks[0] for marks in gathered(marks, near)]
