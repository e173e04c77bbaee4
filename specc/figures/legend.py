"""Legends beside the picture: one entry for each kind of thing that is drawn."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

Handle: TypeAlias = Line2D | Patch

Look: TypeAlias = dict[str, Any]
"""How a line or a marker is drawn, as matplotlib is told."""

GAP: Final = 0.18
"""Inches between the picture and its legend."""


@final
@dataclass(frozen=True, slots=True)
class Entry:
    """What stands for one thing in a legend: lines and patches drawn upon each other."""

    label: str
    handles: tuple[Handle, ...]


def line_entry(label: str, **look: Any) -> Entry:
    """An entry that is one line or one marker."""
    return Entry(label, (Line2D([], [], **look),))


def merged(entries: Iterable[Entry]) -> list[Entry]:
    """Each label once: points first, then lines, then areas, each kind in its order."""
    once: dict[str, Entry] = {}
    for entry in entries:
        once.setdefault(entry.label, entry)
    return sorted(once.values(), key=_rank)


def _rank(entry: Entry) -> int:
    first = entry.handles[0]
    if isinstance(first, Patch):
        return 2
    return 0 if first.get_linestyle() == "None" else 1


def draw_legend(at: Axes | Figure, entries: Iterable[Entry], corner: tuple[float, float]) -> None:
    """The legend with its upper left corner at `corner`, a share of the axes or the figure."""
    kept = merged(entries)
    if kept:
        at.legend(
            handles=[entry.handles for entry in kept],
            labels=[entry.label for entry in kept],
            loc="upper left",
            bbox_to_anchor=corner,
            borderaxespad=0.0,
        )
