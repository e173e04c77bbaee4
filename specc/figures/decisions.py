"""What an arbiter decides over two of its reads: areas by choice, labelled with choice and rule."""

import math
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from runtime.arrays import Array
from specc.figures.axes_of_states import name_x, name_y, same_scale
from specc.figures.decision_labels import label_areas
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import (
    BELOW,
    LEFT,
    LINE,
    axes_at,
    heading,
    new_figure,
    panel_size,
    write_heading,
)
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.portraying_arbiters import ArbiterPortrait, ArbiterSweep, FoundOfArbiter
from specc.texts.arbiter_portraits import choice_name, held_phrase, notes_of
from verifier.deciding.plane import Area, Axis, Plane
from verifier.topology.features import AxisRange

MOST: Final = (4.7, 4.3)
FLAT: Final = (5.6, 0.9)
"""Over one quantity."""
PANEL: Final = 2.7
GAP: Final = 0.42
ABOVE: Final = 0.28
BESIDE: Final = 2.5
"""For the legend, in inches as all."""
BAND: Final = "\\\\\\\\"
"""Hatched so is only what depends on what was decided before."""


def draw_decisions(found: FoundOfArbiter, style: Style = Style.SCREEN) -> Figure:
    """The portrait of an arbiter, or its sweep as panels."""
    palette = PALETTES[style]
    swept = found.name if isinstance(found, ArbiterSweep) else ""
    panels = found.portraits if isinstance(found, ArbiterSweep) else (found,)
    first = panels[0]
    columns = min(len(panels), 2 if len(panels) == 4 else 3)
    rows = math.ceil(len(panels) / columns)
    size = _size(first.plane, is_small=len(panels) > 1)
    above = ABOVE if swept else 0.0
    width = columns * size[0] + (columns - 1) * GAP
    height = rows * (size[1] + above) + (rows - 1) * GAP
    held = held_phrase(first, (swept,))
    about = [each for each in (first.arbiter.about, f"At {held}." if held else "") if each]
    small = [*([_sentence(first.why)] if first.why else []), *map(_sentence, notes_of(first))]
    text = heading(first.arbiter.name, about, small, width + BESIDE, _names(first))
    below = BELOW + LINE * len(text.below)
    with look(palette):
        figure = new_figure(LEFT + width + BESIDE, below + height + text.height + 0.1, palette)
        entries: list[Entry] = []
        for k, panel in enumerate(panels):
            row, column = divmod(k, columns)
            left = LEFT + column * (size[0] + GAP)
            up = below + (rows - 1 - row) * (size[1] + above + GAP)
            axes = axes_at(figure, (left, up), size)
            entries += _draw(axes, panel, size, palette)
            if swept:
                axes.set_title(_value_of(panel, swept), loc="left", fontsize=9.0, pad=4)
                is_last = k + columns >= len(panels)
                _share_labels(axes, is_first=column == 0, is_last=is_last)
        corner = np.array([LEFT + width + 0.18, below + height - above]) / figure.get_size_inches()
        draw_legend(figure, entries, (float(corner[0]), float(corner[1])))
        top = below + height + text.height
        write_heading(figure, text, palette, LEFT, top, below - BELOW + 0.05)
    return figure


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."


def _names(found: ArbiterPortrait) -> tuple[str, ...]:
    arbiter = found.arbiter
    return arbiter.register[: len(arbiter.reads) + len(arbiter.controls)]


def _size(plane: Plane, *, is_small: bool) -> tuple[float, float]:
    if len(plane.axes) == 1:
        return (PANEL, FLAT[1]) if is_small else FLAT
    most = (PANEL, 0.92 * PANEL) if is_small else MOST
    x, y = (_range(axis) for axis in plane.axes)
    is_mixed = any(axis.values for axis in plane.axes)
    return panel_size((x, y), most, same_scale=not is_mixed and same_scale((x, y)))


def _range(axis: Axis) -> AxisRange:
    return AxisRange(axis.name, axis.unit, *axis.ends, periodic=False)


def _value_of(panel: ArbiterPortrait, swept: str) -> str:
    """The value that a panel stands for."""
    others = tuple(name for name in panel.plane.held if name != swept)
    return held_phrase(panel, others)


def _share_labels(axes: Axes, *, is_first: bool, is_last: bool) -> None:
    """Ticks are labelled at the outer edge only."""
    axes.tick_params(labelsize=7.5, labelleft=is_first, labelbottom=is_last)
    if not is_first:
        axes.set_ylabel("")
    if not is_last:
        axes.set_xlabel("")


def _draw(
    axes: Axes, found: ArbiterPortrait, size: tuple[float, float], palette: Palette
) -> list[Entry]:
    """One panel; gives what the legend shows."""
    plane = found.plane
    _frame(axes, plane, palette)
    scales = np.array([*(axis.unit.scale for axis in plane.axes), 1.0][:2])
    entries = _draw_borders(axes, plane, scales, palette)
    for area in sorted(plane.areas, key=lambda each: plane.rulings[each.ruling].choices[::-1]):
        entries += _draw_area(axes, found, area, scales, palette)
    label_areas(axes, found, scales, np.array(size), palette)
    return entries


def _frame(axes: Axes, plane: Plane, palette: Palette) -> None:
    axes.set_facecolor(palette.paper)
    name_x(axes, _range(plane.axes[0]))
    if len(plane.axes) > 1:
        name_y(axes, _range(plane.axes[1]))
    else:
        axes.set_ylim(0.0, 1.0)
        axes.set_yticks([])
    for axis, drawn in zip((axes.xaxis, axes.yaxis), plane.axes, strict=False):
        if drawn.values:
            axis.set_ticks(list(range(len(drawn.values))), labels=list(drawn.values))
            axis.set_tick_params(length=0)


def _draw_area(
    axes: Axes, found: ArbiterPortrait, area: Area, scales: Array, palette: Palette
) -> list[Entry]:
    """An area in the tint of what is decided where nothing held before."""
    ruling = found.plane.rulings[area.ruling]
    fresh = ruling.choices[-1]
    outline = Path.make_compound_path(*(_closed(ring / scales) for ring in area.rings))
    ground: Look = {"facecolor": tint(palette, fresh), "edgecolor": palette.faint}
    hatch = "" if ruling.is_band else _hatch(palette, fresh)
    axes.add_patch(PathPatch(outline, **ground, hatch=hatch, linewidth=0.0, zorder=1))
    name = choice_name(found.arbiter, fresh)
    sample = 2 * _hatch(palette, fresh)
    entries = [Entry(name, (Patch(**ground, hatch=sample, linewidth=0.5),))]
    if ruling.is_band:
        stripes: Look = {"facecolor": "none", "edgecolor": palette.fast, "hatch": BAND}
        axes.add_patch(PathPatch(outline, **stripes, linewidth=0.0, zorder=1.5))
        stripes["edgecolor"] = palette.faint
        entries.append(Entry("goes on if it held already", (Patch(**stripes, linewidth=0.5),)))
    return entries


def tint(palette: Palette, choice: int) -> str:
    """The ground of a choice; that of none is the paper. Tints repeat after the sixth."""
    return palette.paper if choice < 0 else palette.tints[choice % len(palette.tints)]


def _hatch(palette: Palette, choice: int) -> str:
    """The hatching of a choice where greys alone don't tell choices apart."""
    return palette.hatches[choice % len(palette.hatches)] if palette.hatches and choice >= 0 else ""


def _closed(ring: Array) -> Path:
    return Path(ring, closed=True)


def _draw_borders(axes: Axes, plane: Plane, scales: Array, palette: Palette) -> list[Entry]:
    """Solid where another choice begins, dashed where one that went on ends, thin between rules."""
    looks: dict[str, Look] = {
        "another choice": {"color": palette.ink, "lw": 1.3},
        "a rule that goes on ends": {"color": palette.ink, "lw": 1.0, "ls": (0, (4, 2.5))},
        "another rule, same choice": {"color": palette.faint, "lw": 0.6},
    }
    used = []
    for border in plane.borders:
        a, b = (plane.rulings[k] for k in border.rulings)
        if a.choices[-1] != b.choices[-1]:
            label = "another choice"
        elif a.choices != b.choices:
            label = "a rule that goes on ends"
        else:
            label = "another rule, same choice"
        used.append(label)
        axes.plot(*(border.points / scales).T, **looks[label], zorder=3, solid_capstyle="round")
    return [line_entry(label, **looks[label]) for label in looks if label in used]
