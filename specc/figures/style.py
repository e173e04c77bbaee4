"""How pictures look, and how they become bytes: the same bytes for the same numbers.

Colours are Okabe and Ito's (2008), which people with colour-blindness tell apart; whatever a
colour says, a line style or a marker says too.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from typing import Any, Final, Literal, TypeAlias

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from specc.figures.palettes import SCREEN, Palette

INK: Final = "#1b1f24"
FAINT: Final = "#6b7480"
PAPER: Final = "#ffffff"
BLUE: Final = "#0072b2"
VERMILION: Final = "#d55e00"
GREEN: Final = "#009e73"
SKY: Final = "#56b4e9"

Format: TypeAlias = Literal["svg", "png", "pdf"]

Picture: TypeAlias = Figure
"""A drawn figure, for those who pass it on and need not know matplotlib."""

FAMILY: Final = ["DejaVu Sans"]
FONT: Final = {
    "font.family": "sans-serif",
    "font.sans-serif": FAMILY,
    "mathtext.fontset": "dejavusans",
    "font.size": 9.0,
    "axes.titlesize": 11.0,
    "axes.labelsize": 10.0,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.fontsize": 8.5,
}

LOOK: Final[dict[Any, Any]] = {
    **FONT,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.8,
    "axes.unicode_minus": True,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "xtick.major.width": 0.8,
    "ytick.major.width": 0.8,
    "hatch.linewidth": 0.7,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "svg.fonttype": "path",
    "svg.hashsalt": "specc",
    "pdf.fonttype": 42,
    "path.simplify": True,
    # Names come from strangers: a dollar sign in one is a dollar sign.
    "text.parse_math": False,
}

DIGITS: Final = re.compile(rb"(\.\d\d)\d+")
"""Digits behind the second one."""

INKED: Final = ("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color")
"""The settings that follow a palette's ink."""

METADATA: Final[dict[str, dict[str, str | None]]] = {
    "svg": {"Date": None, "Creator": "specc"},
    "pdf": {"CreationDate": None, "Creator": "specc", "Producer": "specc"},
    "png": {"Software": "specc"},
}


@contextmanager
def look(palette: Palette = SCREEN) -> Iterator[None]:
    """Within it figures are made and saved in this style; afterwards nothing has changed."""
    colors: dict[Any, Any] = dict.fromkeys(INKED, palette.ink)
    with mpl.rc_context(LOOK | colors | dict(palette.settings)):
        yield


def rendered(figure: Figure, form: Format, palette: Palette = SCREEN, dpi: int = 180) -> bytes:
    """The picture as a file's bytes, cropped to what is drawn; equal numbers give equal bytes."""
    buffer = BytesIO()
    with look(palette):
        figure.savefig(
            buffer,
            format=form,
            dpi=dpi,
            metadata=METADATA[form],
            bbox_inches="tight",
            pad_inches=0.08,
        )
    data = buffer.getvalue()
    return _shortened(data) if form == "svg" else data


def _shortened(svg: bytes) -> bytes:
    """Outlines in hundredths of a point: finer is only bytes."""
    return re.sub(rb' d="[^"]*"', lambda d: DIGITS.sub(rb"\1", d[0]), svg)


def rendered_svg(figure: Figure) -> str:
    """The picture as SVG text, whole and without a background, for a page that has its own."""
    buffer = BytesIO()
    with look():
        figure.savefig(buffer, format="svg", metadata=METADATA["svg"], transparent=True)
    return buffer.getvalue().decode("utf-8")


def framed(
    figure: Figure, rows: int, columns: int, margins: tuple[float, float, float, float]
) -> GridSpec:
    """A grid of panels within margins in inches: left, right, bottom, top.

    Stated margins cost nothing; matplotlib's automatic layouts draw every figure twice.
    """
    width, height = figure.get_size_inches()
    left, right, bottom, top = margins
    return figure.add_gridspec(
        rows,
        columns,
        left=left / width,
        right=1.0 - right / width,
        bottom=bottom / height,
        top=1.0 - top / height,
    )


def bare(axes: Axes) -> None:
    """Takes away the frame's upper and right side."""
    axes.spines["top"].set_visible(False)
    axes.spines["right"].set_visible(False)
