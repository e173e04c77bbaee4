"""Areas of a portrait: basins as light tints, and boxes in which nothing could be decided."""

import textwrap
from collections.abc import Callable
from types import MappingProxyType
from typing import Final

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.patches import Patch, Rectangle

from runtime.arrays import Array, Booleans, Integers
from specc.figures.legend import Entry
from specc.figures.palettes import Palette
from specc.figures.panel import Panel
from verifier.topology.features import AxisRange, Portrait
from verifier.topology.names import attractor_tags

FINER: Final = 8
"""Each cell of the basins is drawn as so many squared, its edge between the centres smoothed."""

BLUR: Final = 0.8
"""The width of the blur that smooths the edge, in cells."""

REACH: Final = 3
"""How far the blur reaches, in cells: what lies farther weighs next to nothing."""

SMALLEST: Final = 0.09
"""An undecided box is drawn at least this large, in inches."""

WIDEST_LABEL: Final = 44
"""Characters in a line of the legend."""

CHIP: Final = 0.42
"""The width of a share above a small panel, in inches."""

CHIPS_ROOM: Final = 0.6
"""The part of a panel's width that shares may take; its name takes the rest."""

RULED: Final = 2
"""The tint whose colour hatching has: darker than the grounds, lighter than the field."""

PERIOD: Final = 24
"""Of a hatching, in finer cells."""

LINE: Final = 3
"""The width of its lines, in finer cells."""

HATCHES: Final[MappingProxyType[str, Callable[[Integers, Integers], Booleans]]] = MappingProxyType(
    {
        "": lambda i, _: i < 0,
        "...": lambda i, j: (i % PERIOD < LINE) & (j % PERIOD < LINE),
        "///": lambda i, j: (i - j) % PERIOD < LINE,
        "---": lambda _, j: j % PERIOD < LINE,
        "xxx": lambda i, j: ((i + j) % PERIOD < LINE) | ((i - j) % PERIOD < LINE),
        "|||": lambda i, _: i % PERIOD < LINE,
    }
)
"""Which finer cells a hatching darkens; the names are matplotlib's."""


def draw_basins(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Each attractor's basin in a tint of its own."""
    basins = portrait.basins
    if basins is None:
        return []
    x, y = panel.states
    present = [int(k) for k in np.unique(basins.labels)]
    fine = _smoothed(basins.labels, present)
    picture = np.array([_ground(panel, label) for label in present])[fine]
    for k, label in enumerate(present):
        if label >= 0 and panel.palette.hatches:
            marks = (fine == k) & HATCHES[hatch(panel.palette, label)](*np.indices(fine.shape))
            picture[marks] = to_rgba(panel.palette.tints[RULED])
    panel.axes.imshow(
        picture.swapaxes(0, 1),
        origin="lower",
        extent=(*_ends(x), *_ends(y)),
        aspect="auto",
        interpolation="nearest",
        zorder=0,
    )
    return basin_entries(panel.palette, portrait, is_small=panel.is_small)


def basin_entries(palette: Palette, portrait: Portrait, *, is_small: bool) -> list[Entry]:
    """What the legend says of the basins, with the share of each; panels say their own."""
    basins = portrait.basins
    if basins is None:
        return []
    nothing = Patch(facecolor=palette.paper, edgecolor=palette.faint, linewidth=0.5)
    if is_small:
        some = [Entry("basin of attraction, and its share", (basin_patch(palette, 0),))]
        return some + ([Entry("leaves the domain", (nothing,))] if basins.leaves > 0.0 else [])
    entries = [
        Entry(label, (basin_patch(palette, k),)) for k, label in enumerate(basin_labels(portrait))
    ]
    if basins.leaves > 0.0:
        entries.append(Entry(f"leaves the domain: {share_text(basins.leaves)}", (nothing,)))
    return entries


def basin_labels(portrait: Portrait) -> list[str]:
    """What the legend calls each basin; a long name goes on in a second line."""
    found = portrait.basins.attractors if portrait.basins else ()
    return [
        textwrap.fill(
            f"goes to {tag}: {share_text(each.share)}".replace("-", "−"),
            WIDEST_LABEL,
            break_long_words=False,
        )
        for each, tag in zip(found, attractor_tags(portrait), strict=True)
    ]


def draw_shares(panel: Panel, portrait: Portrait) -> None:
    """Above a small panel at the right: the share of each basin on its tint, white for leaving."""
    basins = portrait.basins
    if basins is None:
        return
    palette = panel.palette
    chips = [(each.share, tint(palette, k)) for k, each in enumerate(basins.attractors)]
    chips += [(basins.leaves, palette.paper)] if basins.leaves > 0.0 else []
    room = int(CHIPS_ROOM * float(panel.size[0]) / CHIP)
    for k, (share, ground) in enumerate(reversed(chips[:room])):
        panel.axes.annotate(
            share_text(share),
            (1.0, 1.0),
            xytext=(-3.0 - 72.0 * CHIP * k, 6.5),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            fontsize=6.5,
            bbox={"facecolor": ground, "edgecolor": palette.faint, "linewidth": 0.4, "pad": 1.8},
            annotation_clip=False,
        )


def share_text(share: float) -> str:
    """A share of the domain in per cent, with one digit behind the point.

    >>> share_text(0.4669)
    '46.7 %'
    """
    return f"{100.0 * share:.1f} %"


def tint(palette: Palette, index: int) -> str:
    """The ground of the basin of an attractor; tints repeat after the sixth."""
    return palette.tints[index % len(palette.tints)]


def hatch(palette: Palette, index: int) -> str:
    """The hatching of the basin of an attractor, where greys alone don't tell them apart."""
    return palette.hatches[index % len(palette.hatches)] if palette.hatches else ""


def basin_patch(palette: Palette, index: int) -> Patch:
    """How a legend shows the ground of a basin."""
    return Patch(
        facecolor=tint(palette, index),
        hatch=2 * hatch(palette, index),
        edgecolor=palette.faint,
        linewidth=0.5,
    )


def _ends(state: AxisRange) -> tuple[float, float]:
    return state.low / state.unit.scale, state.high / state.unit.scale


def _smoothed(labels: Integers, present: list[int]) -> Integers:
    """For each finer cell the index of the label that surrounds it most."""
    down, across = (_finer(count) for count in labels.shape)
    return np.asarray(np.argmax([down @ (labels == k) @ across.T for k in present], axis=0))


def _finer(count: int) -> Array:
    """What each of `count` cells in a row gives each finer one: (count * FINER, count).

    A blur takes the stairs off the edge of a basin; between the centres of cells it is linear.
    The outermost cells go on beyond the end. Of numpy alone: scipy.ndimage takes 0.1 s to load.
    """
    cells = np.arange(count)
    reach = np.arange(-REACH, REACH + 1)
    bell = np.exp(-0.5 * (reach / BLUR) ** 2)
    blur = np.zeros((count, count))
    for step, share in zip(reach, bell / bell.sum(), strict=True):
        np.add.at(blur, (cells, np.clip(cells + step, 0, count - 1)), share)
    centres = (np.arange(count * FINER) + 0.5) / FINER - 0.5
    return np.stack([np.interp(centres, cells, each) for each in blur.T], axis=-1)


def _ground(panel: Panel, label: int) -> tuple[float, float, float, float]:
    if label < 0:
        return to_rgba(panel.palette.paper, 0.0)
    return to_rgba(tint(panel.palette, label))


def draw_undecided(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Hatched boxes that may hold fixed points that nobody proved; tiny ones are enlarged."""
    boxes = portrait.completeness.undecided
    color = panel.palette.alarm
    for box in boxes:
        low, high = panel.inches(box.low), panel.inches(box.high)
        half = np.maximum(0.5 * (high - low), 0.5 * SMALLEST)
        middle = 0.5 * (low + high)
        corner = panel.from_inches(middle - half)
        size = panel.from_inches(middle + half) - corner
        panel.axes.add_patch(
            Rectangle(
                (float(corner[0]), float(corner[1])),
                float(size[0]),
                float(size[1]),
                hatch="//////",
                facecolor="none",
                edgecolor=color,
                linewidth=0.0 if portrait.completeness.still else 0.8,
                zorder=8,
            )
        )
    patch = Patch(facecolor="none", edgecolor=color, hatch="//////", linewidth=0.8)
    return [Entry(undecided_label(portrait), (patch,))] if boxes else []


def undecided_label(portrait: Portrait) -> str:
    """What the legend says of boxes that hold no isolated fixed point that was proved."""
    if portrait.completeness.still:
        return "filled with fixed points"
    return "undecided: may hold fixed points"
