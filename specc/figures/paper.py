"""Where things stand on a figure, in inches: panels, the head above them, small print below."""

import re
import textwrap
from collections.abc import Collection
from dataclasses import dataclass
from typing import Final, final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from specc.figures.legend import Look
from specc.figures.palettes import Palette
from specc.figures.quantities import quantity
from verifier.topology.features import AxisRange, Held, Portrait

LEFT: Final = 0.8
"""For ticks and the axis' name."""

BELOW: Final = 0.62
"""For ticks and the axis' name."""

LEGEND: Final = 2.5
"""For the legend beside the panels."""

LINE: Final = 0.165
"""The height of a line of small print."""

TITLE: Final = 0.26

PER_INCH: Final = 14.5
"""Characters of small print in an inch, at most."""


@final
@dataclass(frozen=True, slots=True)
class Heading:
    """What stands above and below the panels."""

    title: str
    above: tuple[str, ...]
    below: tuple[str, ...]

    @property
    def height(self) -> float:
        """Of the lines above the panels, in inches."""
        return TITLE + LINE * len(self.above) + 0.1


def heading(
    title: str, above: list[str], below: list[str], width: float, names: Collection[str] = ()
) -> Heading:
    """The lines wrapped to `width` inches; at most three lines are kept of each sentence.

    names: of states and controls; a sentence that begins with one is not made to begin large.
    """
    small = [_begun(line, names) for line in below]
    return Heading(spaced(title), _wrapped(above, width), _wrapped(small, width))


def _begun(line: str, names: Collection[str]) -> str:
    """A sentence with its first letter large, if no name begins with it.

    >>> _begun("x does not move", ["x"]), _begun("there is one cycle", ["x"])
    ('x does not move', 'There is one cycle')
    """
    first = re.match(r"\w*", line)
    return line if first and first.group() in names else line[:1].upper() + line[1:]


def names_in(portrait: Portrait) -> tuple[str, ...]:
    """All names of states and controls that a sentence on a portrait may begin with."""
    return (*(axis.name for axis in portrait.axes), *(held.name for held in portrait.held))


def new_figure(width: float, height: float, palette: Palette) -> Figure:
    """A figure of this size in inches on the palette's paper."""
    return Figure(figsize=(width, height), facecolor=palette.paper)


def axes_at(figure: Figure, place: tuple[float, float], size: tuple[float, float]) -> Axes:
    """Axes with their lower left corner at `place`, of a `size`, all in inches."""
    width, height = figure.get_size_inches()
    return figure.add_axes((place[0] / width, place[1] / height, size[0] / width, size[1] / height))


def write_heading(
    figure: Figure, text: Heading, palette: Palette, left: float, top: float, below: float
) -> None:
    """The title at `top`, lines under it, and small print from `below` downwards; in inches."""
    width, height = figure.get_size_inches()
    figure.text(left / width, top / height, text.title, fontsize=12.5, fontweight="bold", va="top")
    small: Look = {"fontsize": 8.5, "color": palette.faint, "va": "top", "linespacing": 1.35}
    if text.above:
        lines = "\n".join(text.above)
        figure.text(left / width, (top - TITLE + 0.02) / height, lines, **small)
    if text.below:
        figure.text(left / width, below / height, "\n".join(text.below), **small)


def held_text(held: tuple[Held, ...]) -> str:
    """What the portrait holds still: `mu = 1, mode = forward`."""
    return ", ".join(f"{h.name} = {h.label or quantity(h.value, h.unit)}" for h in held)


def panel_size(
    states: tuple[AxisRange, ...], most: tuple[float, float], *, same_scale: bool
) -> tuple[float, float]:
    """The size of a panel within `most`; two lengths of one unit get the same scale."""
    if not same_scale:
        return most
    x, y = states
    scale = min(most[0] / x.width, most[1] / y.width)
    return scale * x.width, scale * y.width


def spaced(name: str) -> str:
    """A name as a title: `first_light` is `First light`; that of a file stays."""
    if "." in name.split(maxsplit=1)[0]:
        return name  # a file
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]


def _wrapped(sentences: list[str], width: float) -> tuple[str, ...]:
    lines: list[str] = []
    for sentence in sentences:
        wrapped = textwrap.wrap(sentence, max(30, int(width * PER_INCH)))
        lines += wrapped if len(wrapped) <= 3 else [*wrapped[:2], wrapped[2] + " …"]
    return tuple(lines)
