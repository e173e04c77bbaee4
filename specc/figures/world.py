"""A world on paper: the floor with its light, walls, things where they were and are, robots."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PatchCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize, PowerNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Patch

from runtime.arrays import Array
from specc.figures.footprints import lamps_at, moved, outline, patch, placed, reach_of
from specc.figures.labels import Labels
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.moments import mark_jams, mark_times, mark_touches
from specc.figures.names import keep_clear, name_robots_and_lights, name_things
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import axes_at, heading, new_figure, write_heading
from specc.figures.quantities import seconds
from specc.figures.scene import Glow, Scene, Trails
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.trails import (
    MARGIN,
    draw_trails,
    fresh_since,
    is_by_time,
    part_of,
    shares_of,
    thinned,
    time_colors,
)
from verifier.report.wording import percents

LONG: Final = 6.6
"""Inches of the longer side of the floor."""
LEFT: Final = 0.55
BELOW: Final = 0.5
RIGHT: Final = 2.2
LAMP: Final = "#f0e442"
SHARE: Final = 0.005
"""Of the time; who acts less is not told of."""
MINUTES: Final = 180.0
"""Seconds from which on a run is told in minutes."""
FINE: Final = 500
"""Cells of light along the floor that are shown as they are; of fewer one would see the steps."""
DIM: Final = 0.5
"""The power by which lux become shades: light falls off so fast that a bulb would be a dot."""


def draw_world(scene: Scene, trails: Trails, style: Style = Style.SCREEN) -> Figure:
    """The poster of a run: the world, everybody's way through it, and what was required."""
    palette = PALETTES[style]
    with look(palette):
        left, low, right, high = bounds(scene)
        scale = LONG / max(right - left, high - low)
        size = (scale * (right - left), scale * (high - low))
        width = LEFT + size[0] + RIGHT
        above = [scene.about] if scene.about else []
        text = heading(
            scene.title, [*above, _lasted(scene, trails)], _required(trails), width - 0.4
        )
        foot = BELOW + 0.1 + 0.165 * len(text.below)
        figure = new_figure(width, foot + size[1] + text.height + 0.15, palette)
        axes = axes_at(figure, (LEFT, foot), size)
        floor(axes, scene)
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        labels = Labels(axes, scene.arena)
        since = fresh_since(scene, trails, labels.per_metre)
        entries = [*_things(axes, scene, trails, palette), *_robots(axes, scene, trails, palette)]
        entries += _lamps(axes, scene, trails.things[-1], palette)
        entries += draw_trails(axes, scene, trails, since, palette)
        entries += _tell(axes, scene, trails, (labels, since), palette)
        corner = ((LEFT + size[0] + 0.2) / width, (foot + size[1]) / figure.get_size_inches()[1])
        draw_legend(figure, entries, corner)
        _light(figure, axes, scene, (LEFT + size[0] + 0.2, foot), palette)
        if is_by_time(trails):
            beside = 1.0 if scene.glow is not None else 0.0
            _clock(figure, part_of(trails, since), (LEFT + size[0] + 0.2 + beside, foot), palette)
        top = figure.get_size_inches()[1] - 0.08
        write_heading(figure, text, palette, 0.12, top, foot - BELOW)
    return figure


def _tell(
    axes: Axes, scene: Scene, trails: Trails, how: tuple[Labels, float], palette: Palette
) -> list[Entry]:
    """Marks of what happened, and all words on the floor, which keep off all that is drawn there.

    how: where words are, and from when on ways are drawn in full.
    """
    labels, since = how
    fresh = part_of(trails, since)
    keep_clear(labels, scene, trails)
    for robot in range(len(scene.robots)):
        labels.spare(fresh.robots[:, robot, :2])
    stuck, jams = mark_jams(axes, trails, labels, palette)
    times = mark_times(axes, fresh, labels, palette)
    touched = mark_touches(axes, trails, since, labels, palette)
    name_robots_and_lights(labels, scene, trails, palette)
    name_things(labels, scene, trails, palette)
    for note in (*times, *jams):
        labels.put_by(note)
    return [*touched, *stuck]


def bounds(scene: Scene) -> tuple[float, float, float, float]:
    """Least x and y, largest x and y of the arena, with room for its walls."""
    low, high = scene.arena.min(axis=0), scene.arena.max(axis=0)
    rim = 0.012 * float((high - low).max())
    return low[0] - rim, low[1] - rim, high[0] + rim, high[1] + rim


def floor(axes: Axes, scene: Scene) -> None:
    """Limits and walls."""
    left, low, right, high = bounds(scene)
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    axes.set_aspect("equal")
    axes.set_facecolor(axes.figure.get_facecolor())
    for side in axes.spines.values():
        side.set_visible(False)
    closed = np.vstack([scene.arena, scene.arena[:1]])
    axes.plot(
        closed[:, 0], closed[:, 1], color=axes.xaxis.label.get_color(), lw=2.2, zorder=4,
        solid_joinstyle="miter",
    )  # fmt: skip


def lux_colors(palette: Palette) -> Colormap:
    """From dark to light, of evenly rising lightness (CIE L*): blue to yellow, or greys."""
    if palette.hatches:
        return LinearSegmentedColormap.from_list("lux", ["#c4c4c4", "#ffffff"])
    if palette.paper == "#ffffff":
        return LinearSegmentedColormap.from_list("lux", ["#9aa3b8", "#d0cfc6", "#fff6c0"])
    return LinearSegmentedColormap.from_list("lux", ["#10151c", "#444950", "#8f8760"])


def _things(axes: Axes, scene: Scene, trails: Trails, palette: Palette) -> list[Entry]:
    """Things at their end; those that were pushed also at their start, faint, and their way."""
    fixed: list[Patch] = []
    loose: list[Patch] = []
    starts: list[Patch] = []
    for index, item in enumerate(scene.things):
        poses = trails.things[:, index]
        parts = outline(item.shape)
        (fixed if item.is_fixed else loose).append(patch([placed(p, poses[-1]) for p in parts]))
        if moved(poses):
            starts.append(patch([placed(p, poses[0]) for p in parts]))
            _pushed(axes, poses[:, :2], palette)
    faint: Look = {"facecolor": "none", "edgecolor": palette.faint, "linestyle": "--", "lw": 0.8}
    solid: Look = {"facecolor": palette.faint, "edgecolor": palette.ink, "lw": 0.8}
    light: Look = {"facecolor": palette.tints[5], "edgecolor": palette.ink, "lw": 0.8}
    kinds = (
        (starts, faint, "where it stood first", 3.0),
        (loose, light, "thing, can be pushed", 3.1),
        (fixed, solid, "thing, fixed", 3.1),
    )
    entries = [line_entry("way of what was pushed", **_pushing(palette))] if starts else []
    for patches, drawn, name, order in kinds:
        if patches:
            axes.add_collection(PatchCollection(patches, **drawn, zorder=order))
            entries.append(Entry(name, (Patch(**drawn),)))
    return entries


def _pushed(axes: Axes, way: Array, palette: Palette) -> None:
    """The way of what was pushed, with an arrow where it ends."""
    kept = way[thinned(way, MARGIN * float(np.abs(np.diff(axes.get_xlim())[0])))]
    axes.plot(kept[:, 0], kept[:, 1], **_pushing(palette), zorder=3.2)
    far = np.flatnonzero(np.hypot(*(kept - kept[-1]).T) > 0.02)
    if len(far):
        (x, y), (to_x, to_y) = kept[far[-1]].tolist(), kept[-1].tolist()
        arrow: Look = {"arrowstyle": "->", "lw": 0.9, "color": palette.ink}
        axes.annotate(
            "", (to_x, to_y), (x, y), zorder=3.3, arrowprops={**arrow, "shrinkA": 0, "shrinkB": 0}
        )


def _pushing(palette: Palette) -> Look:
    return {"color": palette.ink, "lw": 0.9, "ls": (0, (1, 1.5))}


def _robots(axes: Axes, scene: Scene, trails: Trails, palette: Palette) -> list[Entry]:
    """Robots at their start, faint, and at their end, with where they look."""
    for index, item in enumerate(scene.robots):
        parts = outline(item.shape)
        reach = reach_of(parts)
        for row, alpha in ((0, 0.35), (-1, 1.0)):
            pose = trails.robots[row, index]
            axes.add_patch(
                patch(
                    [placed(p, pose) for p in parts],
                    facecolor=palette.nullcline,
                    edgecolor=palette.ink,
                    alpha=alpha,
                    zorder=5.5 if row else 4.5,
                    lw=1.0,
                )
            )
            nose = placed(np.array([[0.0, 0.0], [reach, 0.0]]), pose)
            axes.plot(nose[:, 0], nose[:, 1], color=palette.paper, lw=1.4, zorder=5.6, alpha=alpha)
    drawn: Look = {"facecolor": palette.nullcline, "edgecolor": palette.ink, "lw": 1.0}
    return [Entry("robot (faint: its start)", (Patch(**drawn),))]


def _lamps(axes: Axes, scene: Scene, things: Array, palette: Palette) -> list[Entry]:
    """Lights as stars, where they are at the end."""
    drawn: Look = {
        "marker": "*", "linestyle": "None", "ms": 13.0, "mec": palette.ink,
        "mfc": palette.paper if palette.hatches else LAMP,
        "mew": 0.8, "zorder": 8,
    }  # fmt: skip
    axes.plot(*lamps_at(scene, things).T, **drawn)
    return [line_entry("light", **{**drawn, "ms": 9.0})] if scene.lamps else []


def _light(
    figure: Figure, axes: Axes, scene: Scene, corner: tuple[float, float], palette: Palette
) -> None:
    """The light on the floor, with a bar in lux."""
    if scene.glow is None:
        return
    shown = light_image(axes, scene.last_glow or scene.glow, palette)
    shown.set_clip_path(patch([scene.arena]).get_path(), axes.transData)
    bar: Colorbar = figure.colorbar(
        shown, cax=axes_at(figure, (corner[0], corner[1]), (0.13, 1.25)), extend="max"
    )
    bar.set_label("light at the end [lx]", fontsize=8.5)
    bar.ax.tick_params(labelsize=8)


def light_image(axes: Axes, glow: Glow, palette: Palette) -> AxesImage:
    """The light on the floor as an image that is cut at the arena's box."""
    dx, dy = (float(v[1] - v[0]) if len(v) > 1 else 1.0 for v in (glow.xs, glow.ys))
    extent = (
        float(glow.xs[0]) - dx / 2,
        float(glow.xs[-1]) + dx / 2,
        float(glow.ys[0]) - dy / 2,
        float(glow.ys[-1]) + dy / 2,
    )
    brightest = max(float(np.quantile(glow.lux[-1], 0.98)), 1e-6)
    return axes.imshow(
        glow.lux[-1],
        extent=extent,
        origin="lower",
        cmap=lux_colors(palette),
        norm=PowerNorm(DIM, 0.0, brightest),
        interpolation="none" if max(glow.lux.shape[1:]) >= FINE else "bilinear",
        aspect="equal",
        zorder=0,
    )


def _clock(figure: Figure, trails: Trails, corner: tuple[float, float], palette: Palette) -> None:
    """A bar of the colours of time."""
    ended = float(trails.times[-1])
    unit, name = (60.0, "min") if ended >= MINUTES else (1.0, "s")
    norm = Normalize(float(trails.times[0]) / unit, ended / unit)
    shown = ScalarMappable(norm, time_colors(palette))
    bar: Colorbar = figure.colorbar(shown, cax=axes_at(figure, corner, (0.13, 1.25)))
    bar.set_label(f"time [{name}]", fontsize=8.5)
    bar.ax.tick_params(labelsize=8)


def _lasted(scene: Scene, trails: Trails) -> str:
    """How long it was, from which seed, and what share of the time each behavior had its way."""
    begun, ended = float(trails.times[0]), float(trails.times[-1])
    seed = "" if scene.seed is None else f", seed {scene.seed}"
    lasted = f"{seconds(ended - begun)} of simulated time{seed}"
    shares = shares_of(trails)
    parts = zip(shares.items(), percents([*shares.values()]), strict=True)
    told = [f"{name} {part}" for (name, share), part in parts if share >= SHARE]
    return f"{lasted}. Acting: {', '.join(told)}" if told else lasted


def _required(trails: Trails) -> list[str]:
    """One line for each requirement."""
    marks = {True: "✓ satisfied", False: "✗ violated", None: "? open"}
    return [
        f"{marks[one.holds]}{f' by {one.margin}' if one.margin else ''}: {one.text}"
        for one in trails.outcomes
    ]
