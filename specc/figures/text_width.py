"""How wide texts are, as the font has it."""

from functools import lru_cache
from typing import Final

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from specc.figures.style import FAMILY

POINTS: Final = 72.0
"""In an inch."""


@lru_cache(maxsize=4096)
def text_width(text: str, size: float, *, bold: bool = False) -> float:
    """The width in inches of one line of `size` points.

    >>> text_width("iii", 7.0) < text_width("mmm", 7.0) < text_width("mmm", 7.0, bold=True)
    True
    """
    if not text.strip():
        return 0.0
    font = FontProperties(family=FAMILY, size=size, weight="bold" if bold else "normal")
    path = TextPath((0.0, 0.0), text, prop=font, usetex=False)
    return float(path.get_extents().x1) / POINTS
