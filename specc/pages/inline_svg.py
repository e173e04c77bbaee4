"""Figures as SVG that stands within a page: its colours follow the page's light or dark look."""

import re
from typing import Final

from markupsafe import Markup

from specc.figures.style import BLUE, FAINT, GREEN, INK, PAPER, VERMILION, Picture, rendered_svg

COLORS: Final = {
    INK: "var(--ink)",
    FAINT: "var(--faint)",
    PAPER: "var(--paper)",
    BLUE: "var(--blue)",
    VERMILION: "var(--vermilion)",
    GREEN: "var(--green)",
}
"""The style sheet gives each of them two values."""


def inline_svg(figure: Picture, name: str, label: str) -> Markup:
    """`figure` as an `<svg>` element; `name` keeps its ids apart from those of other figures.

    `label` says what it shows to those who can't see it.
    """
    text = rendered_svg(figure)
    svg = text[text.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", svg, flags=re.DOTALL)
    svg = re.sub(r'\bid="', f'id="{name}-', svg)
    svg = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", svg)
    for color, variable in COLORS.items():
        svg = svg.replace(color, variable)
    # The page sets the size; the view box keeps the proportions.
    svg = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", svg, count=1)
    svg = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", svg, count=1)
    opening = Markup('<svg role="img" aria-label="{}"').format(label)
    # The rest is matplotlib's own output: numbers, and texts that it has turned into paths.
    return opening + Markup(svg.removeprefix("<svg"))  # noqa: S704
