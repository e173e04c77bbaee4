"""The field under a portrait: evenly spaced lines shaded by speed; of a map, its steps."""

from itertools import pairwise
from typing import Final

import numpy as np
from matplotlib.collections import LineCollection

from runtime.arrays import Array, Integers
from specc.figures.legend import Entry, line_entry
from specc.figures.panel import Panel, draw_heads, places_along
from specc.figures.streamlines import Sheet, Spacing, evenly_spaced, velocity_at
from verifier.topology.features import Grid

LEVELS: Final = 6
"""Shades of speed: neighbouring stretches of one shade are one line, which keeps files small."""

THIN: Final = 0.55
THICK: Final = 1.0
"""Widths of the slowest and the fastest line, in points."""

HEAD: Final = 0.062
"""The length of an arrowhead, in inches."""

ARROWS: Final = 24
"""How many arrows along each axis show the steps of a map."""


def draw_field(panel: Panel, grid: Grid, drawn: list[Array]) -> list[Entry]:
    """Streamlines, heavier where the flow is faster, beside the curves (T, 2), SI, `drawn`."""
    sheet = Sheet(grid.rates / panel.width * panel.size, panel.size)
    spacing = Spacing(apart=0.12 if panel.is_small else 0.15)
    lines = evenly_spaced(sheet, spacing, [panel.inches(curve) for curve in drawn])
    ranks = _ranks(sheet)
    runs: list[Array] = []
    levels: list[int] = []
    for line in lines:
        for begin, end, level in _runs(_levels(sheet, ranks, line)):
            runs.append(panel.from_inches(line[begin : end + 1]))
            levels.append(level)
    share = np.array(levels) / (LEVELS - 1)
    speeds = panel.palette.speeds
    panel.axes.add_collection(
        LineCollection(
            runs,
            colors=speeds(share),
            linewidths=panel.weight * (THIN + (THICK - THIN) * share),
            zorder=1,
            capstyle="round",
        ),
        autolim=False,
    )
    _field_heads(panel, sheet, ranks, lines)
    label = f"flow, {panel.palette.faster} is faster"
    return [line_entry(label, color=speeds(0.75), linewidth=0.9)]


def _ranks(sheet: Sheet) -> Array:
    """The sorted speeds of the field: half of all places get half the ink."""
    speed = np.hypot(sheet.velocity[..., 0], sheet.velocity[..., 1]).ravel()
    return np.sort(speed[np.isfinite(speed)])


def _levels(sheet: Sheet, ranks: Array, points: Array) -> Integers:
    """The shade, 0 to LEVELS - 1, at points (T, 2) in inches."""
    v = velocity_at(sheet, points)
    rank = np.searchsorted(ranks, np.hypot(v[:, 0], v[:, 1])) / max(1, ranks.size)
    return np.minimum((rank * LEVELS).astype(np.int64), LEVELS - 1)


def _runs(levels: Integers) -> list[tuple[int, int, int]]:
    """Stretches (begin, end, level) of equal level; each ends where the next one begins."""
    edges = [0, *(np.flatnonzero(np.diff(levels)) + 1).tolist(), len(levels) - 1]
    return [(a, b, int(levels[a])) for a, b in pairwise(edges) if b > a]


def _field_heads(panel: Panel, sheet: Sheet, ranks: Array, lines: list[Array]) -> None:
    places, directions = [], []
    for line in lines:
        for k in places_along(line, 1.6).tolist():
            places.append(line[k])
            directions.append(line[k + 1] - line[k - 1])
    if places:
        at = np.array(places)
        colors = panel.palette.speeds(_levels(sheet, ranks, at) / (LEVELS - 1))
        draw_heads(panel, at, np.array(directions), HEAD, [tuple(c) for c in colors], 1.1)


def draw_steps(panel: Panel, grid: Grid) -> list[Entry]:
    """Of a map: from evenly spread places an arrow along the step that is made there."""
    stride = max(1, len(grid.nodes[0]) // ARROWS)
    every = slice(stride // 2, None, stride)
    at = np.stack(np.meshgrid(*grid.nodes, indexing="ij"), axis=-1)[every, every].reshape(-1, 2)
    step = (grid.rates[every, every] / panel.width * panel.size).reshape(-1, 2)
    length = np.hypot(step[:, 0], step[:, 1])
    moving = np.isfinite(length) & (length > 0.0)
    begin, step, length = panel.inches(at[moving]), step[moving], length[moving, None]
    arrow = step / length * np.minimum(length, 0.8 * panel.size.min() / ARROWS)
    rank = np.searchsorted(np.sort(length[:, 0]), length[:, 0]) / max(1, len(length))
    speeds = panel.palette.speeds
    segments = panel.from_inches(np.stack([begin, begin + arrow], axis=1))
    panel.axes.add_collection(
        LineCollection(list(segments), colors=speeds(rank), linewidths=0.7, zorder=1),
        autolim=False,
    )
    if len(begin):
        heads = [tuple(c) for c in speeds(rank)]
        draw_heads(panel, begin + arrow, arrow, HEAD, heads, 1.1)
    label = f"direction of a step, {panel.palette.faster} is longer"
    return [line_entry(label, color=speeds(0.75), linewidth=0.9)]
