"""A recording's decisions over time: choices, and below the quantities with their boundaries."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from runtime.arrays import Array, Integers
from runtime.program import Unit
from specc.explaining import Explained
from specc.figures.decisions import tint
from specc.figures.labels import Words
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import (
    BELOW,
    LEFT,
    LINE,
    axes_at,
    heading,
    new_figure,
    write_heading,
)
from specc.figures.quantities import axis_label, number
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.texts.arbiter_portraits import choice_name
from specc.texts.arbiters import word_of
from specc.texts.conditions import PLAIN
from specc.texts.moments import controls_of
from verifier.arbitration.comparisons import infix
from verifier.deciding.reasons import Watched, course_of, watched_in
from verifier.deciding.rulings import NOTHING
from verifier.deciding.stretches import Stretch

WIDTH: Final = 7.2
STRIP: Final = 0.34
ROW: Final = 0.82
GAP: Final = 0.13
BESIDE: Final = 2.1
"""For the legend, in inches as all."""
ROWS: Final = 8
"""Quantities that are drawn, at most."""
NAMED: Final = 7.5
"""Points of the names on the strip."""
LINE_OF_NUMBERS: Final = 0.11
"""Inches that the number of a boundary takes."""
NAME: Final = 0.24
"""Of the range of a quantity, for its name above it."""
MOST_LIMITS: Final = 6
"""Boundaries of a quantity that are drawn; of more, those that mattered most."""
MARGIN: Final = 0.08
"""Of the range of a quantity, above and below it."""


def draw_strip(found: Explained, style: Style = Style.SCREEN) -> Figure:
    """The timeline of an arbiter."""
    palette = PALETTES[style]
    watched = watched_in(found.arbiter, controls_of(found))
    shown, left = watched[:ROWS], watched[ROWS:]
    differs = any(not stretch.agrees for stretch in found.stretches)
    strips = 2 if differs else 1
    height = strips * (STRIP + GAP) + len(shown) * (ROW + GAP)
    small = []
    if any(len(each.numbers) > MOST_LIMITS for each in shown):
        small.append("Of many boundaries those are drawn that were crossed as the choice changed.")
    if left:
        names = ", ".join(infix(each.code) for each in left)
        small.append(f"Not drawn: {names}.")
    if found.arbiter.rules:
        small.append(f"In brackets: the {word_of(found.arbiter)} that decided.")
    own = found.arbiter.name
    title = own if found.name == own else f"{found.name}: {own}"
    text = heading(title, [found.arbiter.about] if found.arbiter.about else [], small, WIDTH)
    below = BELOW + LINE * len(text.below)
    span = found.stretches[0].start, found.stretches[-1].end
    with look(palette):
        figure = new_figure(LEFT + WIDTH + BESIDE, below + height + text.height + 0.1, palette)
        up = below + height
        entries: list[Entry] = []
        for who in ("robot", "spec")[:strips]:
            up -= STRIP
            axes = axes_at(figure, (LEFT, up), (WIDTH, STRIP))
            entries += _draw_choices(axes, found, who if differs else "", span, palette)
            up -= GAP
        for k, each in enumerate(shown):
            up -= ROW
            axes = axes_at(figure, (LEFT, up), (WIDTH, ROW))
            entries += _draw_quantity(axes, found, each, span, palette)
            axes.tick_params(labelbottom=k == len(shown) - 1)
            up -= GAP
        figure.axes[-1].set_xlabel("time [s]")
        figure.axes[-1].tick_params(labelbottom=True)
        corner = np.array([LEFT + WIDTH + 0.18, below + height]) / figure.get_size_inches()
        draw_legend(figure, entries, (float(corner[0]), float(corner[1])))
        write_heading(
            figure, text, palette, LEFT, below + height + text.height, below - BELOW + 0.18
        )
    return figure


def _draw_choices(
    axes: Axes, found: Explained, who: str, span: tuple[float, float], palette: Palette
) -> list[Entry]:
    """What was chosen over time, by the robot or by the spec."""
    entries = []
    axes.set_xlim(span)
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.tick_params(labelbottom=False)
    axes.set_ylabel(who or "choice", rotation=0, ha="right", va="center", fontsize=8.5)
    for stretch in found.stretches:
        choice = stretch.expected if who == "spec" else stretch.chosen
        place = NOTHING if who == "robot" and not stretch.agrees else stretch.place
        entries.append(_block(axes, found, (stretch, choice, place), span, palette))
        if not stretch.agrees:
            entries.append(_alarm(axes, stretch, palette))
    return entries


def _block(
    axes: Axes,
    found: Explained,
    told: tuple[Stretch, int, int],
    span: tuple[float, float],
    palette: Palette,
) -> Entry:
    """A stretch in the ground of its choice, with its name and rule where there is room."""
    stretch, choice, place = told
    hatch = (
        palette.hatches[choice % len(palette.hatches)] if palette.hatches and choice >= 0 else ""
    )
    fill: Look = {"facecolor": tint(palette, choice), "edgecolor": palette.faint, "hatch": hatch}
    width = stretch.end - stretch.start
    axes.add_patch(Rectangle((stretch.start, 0.0), width, 1.0, **fill, linewidth=0.4))
    name = choice_name(found.arbiter, choice)
    room = width / (span[1] - span[0]) * WIDTH * 72.0
    text = name if place < 0 else f"{name} ({place + 1})"
    for words in (text, name, f"({place + 1})" if place >= 0 else ""):
        if words and Words(words, NAMED, "").extent[0] + 4.0 <= room:
            middle = stretch.start + 0.5 * width
            halo = {"facecolor": palette.paper, "alpha": 0.72, "edgecolor": "none", "pad": 0.8}
            axes.text(
                middle, 0.5, words, fontsize=NAMED, ha="center", va="center", bbox=halo,
                color=palette.ink, clip_on=True,
            )  # fmt: skip
            break
    return Entry(name, (Patch(**fill | {"hatch": 2 * hatch}, linewidth=0.5),))


def _alarm(axes: Axes, stretch: Stretch, palette: Palette) -> Entry:
    """Where the robot chose otherwise than the spec."""
    mark: Look = {"facecolor": "none", "edgecolor": palette.alarm, "hatch": "////"}
    axes.axvspan(stretch.start, stretch.end, **mark, linewidth=1.4, zorder=4)
    return Entry("robot and spec differ", (Patch(**mark, linewidth=1.2),))


def _draw_quantity(
    axes: Axes, found: Explained, watched: Watched, span: tuple[float, float], palette: Palette
) -> list[Entry]:
    """A quantity over time on the grounds of the choices, with its boundaries."""
    arbiter, decisions = found.arbiter, found.moments.decisions
    unit, labels = _unit_and_labels(found, watched)
    inside = (decisions.times >= span[0]) & (decisions.times <= span[1])
    times = np.append(decisions.times[inside], span[1])
    values = course_of(arbiter, watched, decisions.register)[inside] / unit.scale
    values = np.append(values, values[-1:])
    limits = np.sort(np.array(watched.numbers)) / unit.scale
    if limits.size > MOST_LIMITS:
        limits = _crossed(limits, values, decisions.chosen[inside])
    for stretch in found.stretches:
        ground = tint(palette, stretch.chosen)
        axes.axvspan(stretch.start, stretch.end, color=ground, lw=0.0, zorder=0)
        if not stretch.agrees:
            _alarm(axes, stretch, palette)
    axes.step(times, values, where="post", color=palette.ink, lw=1.1, zorder=3)
    edge: Look = {"color": palette.cycle, "lw": 0.9, "ls": (0, (4, 2.5))}
    _frame(axes, infix(watched.code), unit, labels, (values, limits), palette)
    axes.set_xlim(span)
    if labels:
        return []
    for limit in limits:
        axes.axhline(limit, **edge, zorder=2)
    for limit, at in zip(limits, _apart(limits, axes), strict=True):
        axes.text(
            1.006, at, number(float(limit)), transform=axes.get_yaxis_transform(),
            fontsize=6.5, color=palette.cycle, va="center",
        )  # fmt: skip
    entries = [line_entry("what was read at each decision", color=palette.ink, lw=1.1)]
    return [*entries, *([line_entry("a boundary of the rules", **edge)] if limits.size else [])]


def _crossed(limits: Array, values: Array, chosen: Integers) -> Array:
    """Of boundaries (k,), in order, those that were crossed most often as the choice changed.

    values (D + 1,), of which the last is told twice. chosen (D,).
    """
    changed = np.flatnonzero(np.diff(chosen)) + 1
    sides = np.sort(np.stack([values[changed - 1], values[changed]]), axis=0)  # (2, changes)
    times = ((limits[:, None] > sides[0]) & (limits[:, None] <= sides[1])).sum(axis=1)
    first = np.argsort(-times, kind="stable")[:MOST_LIMITS]
    crossed: Array = limits[np.sort(first[times[first] > 0])]
    return crossed


def _apart(limits: Array, axes: Axes) -> Array:
    """Where the numbers of boundaries (k,), in order, are written, so that none covers another.

    Each as near to its line as can be, none above the panel.
    """
    low, high = axes.get_ylim()
    step = LINE_OF_NUMBERS / ROW * (high - low)
    places = limits.copy()
    for k in range(1, places.size):
        places[k] = max(places[k], places[k - 1] + step)
    ceiling = high
    for k in reversed(range(places.size)):
        places[k] = min(places[k], ceiling)
        ceiling = places[k] - step
    return places


def _unit_and_labels(found: Explained, watched: Watched) -> tuple[Unit, tuple[str, ...]]:
    """The unit of a quantity, that of what it reads first; the names of discrete values."""
    reads = {read.name: read for read in found.arbiter.reads}
    units = {control.name: control.unit for control in found.arbiter.controls}
    units |= {name: read.unit for name, read in reads.items()}
    names = [token for token in watched.code.tokens if token in units]
    labels = reads[names[0]].values if len(names) == 1 and names[0] in reads else ()
    return (units[names[0]] if names else PLAIN), labels


def _frame(
    axes: Axes,
    name: str,
    unit: Unit,
    labels: tuple[str, ...],
    shown: tuple[Array, Array],
    palette: Palette,
) -> None:
    """Limits, ticks and the name of a quantity, which stands inside: names may be long."""
    halo = {"facecolor": palette.paper, "alpha": 0.72, "edgecolor": "none", "pad": 1.0}
    axes.text(
        0.006, 0.92, axis_label(name, unit), transform=axes.transAxes, fontsize=8.0, va="top",
        color=palette.ink, bbox=halo, zorder=5,
    )  # fmt: skip
    axes.tick_params(labelsize=7.5)
    if labels:
        axes.set_ylim(-0.5, len(labels) - 0.5)
        axes.set_yticks(list(range(len(labels))), labels=list(labels))
        return
    every = np.concatenate([each[np.isfinite(each)] for each in shown])
    low, high = (float(every.min()), float(every.max())) if every.size else (0.0, 1.0)
    room = MARGIN * (high - low) or 0.5
    axes.set_ylim(low - room, high + NAME * (high - low) + room)
    axes.locator_params(axis="y", nbins=4)
