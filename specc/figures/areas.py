"""Areas of a portrait: basins as light tints, and boxes in which nothing could be decided."""

from typing import Final

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.patches import Patch, Rectangle
from scipy.ndimage import gaussian_filter, zoom

from runtime.arrays import Array, Booleans, Integers
from specc.figures.legend import Entry
from specc.figures.panel import Panel
from specc.figures.quantities import number
from verifier.topology.features import Attractor, Basins, Portrait

FINER: Final = 4
"""Each cell of the basins is drawn as so many squared, its edge between the centres smoothed."""

BLUR: Final = 0.8
"""The width of the blur that smooths the edge, in cells."""

SMALLEST: Final = 0.09
"""An undecided box is drawn at least this large, in inches."""

ALL: Final = 0.9995
"""Where one attractor has this share of the domain, a tint would tell nothing."""


def draw_basins(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Each attractor's basin in a tint of its own; nothing where one has it all."""
    basins = portrait.basins
    if basins is None or max((a.share for a in basins.attractors), default=1.0) > ALL:
        return []
    x, y = panel.states
    panel.axes.imshow(
        _picture(panel, basins).swapaxes(0, 1),
        origin="lower",
        extent=(
            x.low / x.unit.scale,
            x.high / x.unit.scale,
            y.low / y.unit.scale,
            y.high / y.unit.scale,
        ),
        aspect="auto",
        interpolation="nearest",
        zorder=0,
    )
    return basin_entries(panel, portrait)


def basin_entries(panel: Panel, portrait: Portrait) -> list[Entry]:
    """What the legend says of the basins, with the share of each."""
    basins = portrait.basins
    if basins is None:
        return []
    faint = panel.palette.faint
    if panel.is_small:
        return [Entry("basins of attraction", (_patch(tint(panel, 0), faint),))]
    entries = [
        Entry(
            f"goes to {attractor_name(portrait, a)}: {share_text(a.share)}",
            (_patch(tint(panel, k), faint),),
        )
        for k, a in enumerate(basins.attractors)
    ]
    if basins.leaves > 0.0:
        patch = _patch(panel.palette.paper, faint)
        entries.append(Entry(f"leaves the domain: {share_text(basins.leaves)}", (patch,)))
    return entries


def attractor_name(portrait: Portrait, attractor: Attractor) -> str:
    """How the legend calls an attractor: by its type and its place, or its period."""
    if attractor.is_cycle:
        return f"the cycle of {number(portrait.cycles[attractor.index].period)} s"
    point = portrait.fixed_points[attractor.index]
    pairs = list(zip(portrait.axes, point.at.tolist(), strict=True))
    # To a thousandth of the axis: 1e-7 m is 0 on a portrait of 4 m.
    steps = [1e-3 * axis.width for axis, _ in pairs]
    rounded = [round(v / step) * step for (_, v), step in zip(pairs, steps, strict=True)]
    values = [number(v / axis.unit.scale) for (axis, _), v in zip(pairs, rounded, strict=True)]
    if len(pairs) == 1:
        return f"{pairs[0][0].name} = {values[0]}"
    return f"({', '.join(values)})"


def share_text(share: float) -> str:
    """A share of the domain in per cent, with one digit behind the point.

    >>> share_text(0.4669)
    '46.7 %'
    """
    return f"{100.0 * share:.1f} %"


def tint(panel: Panel, index: int) -> str:
    """The ground of the basin of an attractor; tints repeat after the sixth."""
    return panel.palette.tints[index % len(panel.palette.tints)]


def _patch(color: str, edge: str) -> Patch:
    return Patch(facecolor=color, edgecolor=edge, linewidth=0.5)


def _picture(panel: Panel, basins: Basins) -> Array:
    """Colours (n1, n2, 4) of the finer cells."""
    present = [int(k) for k in np.unique(basins.labels)]
    fine = _smoothed(basins.labels, present)
    colors = np.array([_ground(panel, label) for label in present])
    return np.asarray(colors[fine])


def _smoothed(labels: Integers, present: list[int]) -> Integers:
    """For each finer cell the index of the label that surrounds it most."""
    weights = [
        zoom(_blurred(labels == label), FINER, order=1, mode="nearest", grid_mode=True)
        for label in present
    ]
    return np.asarray(np.argmax(weights, axis=0))


def _blurred(inside: Booleans) -> Array:
    """Whether a place is inside, as a share: takes the stairs off the edge of a basin."""
    return np.asarray(gaussian_filter(inside.astype(np.float64), BLUR, mode="nearest"))


def _ground(panel: Panel, label: int) -> tuple[float, float, float, float]:
    if label < 0:
        return to_rgba(panel.palette.paper, 0.0)
    return to_rgba(tint(panel, label))


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
                linewidth=0.8,
                zorder=8,
            )
        )
    patch = Patch(facecolor="none", edgecolor=color, hatch="//////", linewidth=0.8)
    return [Entry("undecided: may hold fixed points", (patch,))] if boxes else []
