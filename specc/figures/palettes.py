"""The colours and the type of portraits: for screens, for journals in grey, for dark pages.

Whatever a colour says, a dash pattern, a width or a marker says too; the screen's colours are
Okabe and Ito's (2008), which people with colour-blindness tell apart, and the journal's survive
a photocopier.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Final, final

from matplotlib.colors import LinearSegmentedColormap

from specc.figures.style_names import Style


@final
@dataclass(frozen=True, slots=True)
class Palette:
    """One style's colours.

    ink, faint, paper: text and axes, small print, ground. slow, fast: the field's lines at the
    lowest and the highest speed; `faster` is the word for the latter. nullcline, cycle, stable,
    unstable (branches of saddles), path, switch, alarm (what the tables invented or lost, and
    boxes that could not be decided): lines. tints: grounds of basins, one after the other; hatches:
    what is drawn on them beside where greys alone don't tell, "" for nothing.
    settings: what matplotlib is told beside (fonts).
    """

    ink: str
    faint: str
    paper: str
    slow: str
    fast: str
    faster: str
    nullcline: str
    cycle: str
    stable: str
    unstable: str
    path: str
    switch: str
    alarm: str
    tints: tuple[str, ...]
    hatches: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def speeds(self) -> LinearSegmentedColormap:
        """The colours of the field's lines, from slow (0) to fast (1)."""
        return LinearSegmentedColormap.from_list("speed", [self.slow, self.fast])


SERIF: Final = MappingProxyType(
    {
        "font.family": ["STIXGeneral", "DejaVu Sans"],  # the latter has marks that STIX lacks
        "mathtext.fontset": "stix",
        "font.size": 10.5,
        "axes.labelsize": 11.5,
        "axes.titlesize": 11.5,
        "xtick.labelsize": 10.0,
        "ytick.labelsize": 10.0,
        "legend.fontsize": 10.0,
        "axes.linewidth": 0.6,
        "hatch.color": "#8a8a8a",
        "hatch.linewidth": 0.4,
        "xtick.direction": "in",
        "ytick.direction": "in",
    }
)

SCREEN: Final = Palette(
    ink="#1b1f24",
    faint="#5f6873",
    paper="#ffffff",
    slow="#ccd4dd",
    fast="#76879d",
    faster="darker",
    nullcline="#0072b2",
    cycle="#d55e00",
    stable="#00805d",
    unstable="#a6498a",
    path="#1b1f24",
    switch="#7a5c00",
    alarm="#c0272d",
    tints=("#dcebf7", "#fdecd2", "#dff1e8", "#f2e2ef", "#f8f3c9", "#e3e7ea"),
)

JOURNAL: Final = Palette(
    ink="#000000",
    faint="#3c3c3c",
    paper="#ffffff",
    slow="#c6c6c6",
    fast="#808080",
    faster="darker",
    nullcline="#5a5a5a",
    cycle="#000000",
    stable="#000000",
    unstable="#000000",
    path="#4a4a4a",
    switch="#000000",
    alarm="#000000",
    tints=("#e6e6e6", "#f7f7f7", "#dadada", "#f0f0f0", "#d0d0d0", "#ffffff"),
    hatches=("", "---", "|||", "xxx", "///", "..."),
    settings=SERIF,
)

DARK: Final = Palette(
    ink="#e9eef4",
    faint="#9aa7b5",
    paper="#10151c",
    slow="#2b3745",
    fast="#7288a0",
    faster="brighter",
    nullcline="#62bdf0",
    cycle="#ff8a3c",
    stable="#3ad6a5",
    unstable="#e394cf",
    path="#e9eef4",
    switch="#f0d060",
    alarm="#ff6b6b",
    tints=("#16283a", "#33261a", "#15302a", "#2f2031", "#2e2d17", "#242a31"),
)

PALETTES: Final = MappingProxyType({Style.SCREEN: SCREEN, Style.JOURNAL: JOURNAL, Style.DARK: DARK})
