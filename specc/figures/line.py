"""The portrait of one variable: the rate against the state, or a map's cobweb."""

from itertools import pairwise
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from runtime.arrays import Array
from runtime.program import Unit
from specc.figures.areas import basin_entries, hatch, tint, undecided_label
from specc.figures.axes_of_states import name_x, name_y
from specc.figures.curves import (
    CYCLE_DASHES,
    CYCLE_WIDTH,
    GUARD_ALPHA,
    JUMP,
    LEAP_DASHES,
    guard_entry,
    guard_stroke,
)
from specc.figures.legend import Entry, Look, line_entry
from specc.figures.markers import cross, mark, rest, ring
from specc.figures.palettes import Palette
from specc.figures.quantities import axis_label, rate_of
from specc.figures.style import bare
from verifier.topology.features import Cycle, Portrait, Standing

DIAGONAL: Final = (0.0, (4.0, 2.0))


def draw_line(
    axes: Axes, portrait: Portrait, palette: Palette, *, is_small: bool = False
) -> list[Entry]:
    """Draws into `axes`, which may be one of many; gives what the legend shows."""
    if portrait.every > 0.0:
        drawn = _cobweb(axes, portrait, palette)
    else:
        drawn = _phase_line(axes, portrait, palette, is_small=is_small)
    return [*drawn, *_undecided(axes, portrait, palette)]


def _phase_line(axes: Axes, portrait: Portrait, palette: Palette, *, is_small: bool) -> list[Entry]:
    """The rate over the state; arrows on the line of rest say which way it goes."""
    (state,) = portrait.axes
    scale = state.unit.scale
    nodes, rates = portrait.field.nodes[0] / scale, portrait.field.rates[:, 0] / scale
    color = palette.nullcline
    name_x(axes, state)
    bare(axes)
    axes.set_ylabel(axis_label(rate_of(state.name), _per_second(state.unit)))
    axes.yaxis.get_offset_text().set_horizontalalignment("right")
    axes.axhline(0.0, color=palette.ink, linewidth=0.8, zorder=2)
    axes.plot(nodes, rates, color=color, linewidth=1.8, zorder=3)
    basins = _basins(axes, portrait, palette, is_small=is_small)
    if not basins:
        axes.fill_between(nodes, 0.0, rates, color=color, alpha=0.08, linewidth=0.0, zorder=1)
    moves = _directions(axes, nodes, rates, palette)
    closed = [entry for cycle in portrait.cycles for entry in _loop(axes, cycle, scale, palette)]
    points = _points(axes, portrait, palette, on_diagonal=False)
    resting = np.array([place[0] / scale for place in portrait.rests])
    points += rest(axes, _on_paper(resting, on_diagonal=False), palette)
    goes: Look = {"marker": ">", "markersize": 5.0, "linewidth": 0.8, "color": palette.ink}
    return [
        *points,
        *closed,
        *_switching(axes, portrait, palette),
        line_entry(rate_of(state.name), color=color, linewidth=1.8),
        *([line_entry("where it goes", **goes)] if moves else []),
        *basins,
    ]


def _directions(axes: Axes, nodes: Array, rates: Array, palette: Palette) -> bool:
    """An arrowhead in the middle of each stretch in which the rate keeps its sign; if any does."""
    sign = np.sign(np.nan_to_num(rates))
    edges = np.flatnonzero(np.diff(np.concatenate([[0.0], sign, [0.0]])))
    for a, b in pairwise(edges):
        if sign[a] and b - a > 0.02 * len(nodes):
            middle = 0.5 * (nodes[a] + nodes[b - 1])
            shape = ">" if sign[a] > 0 else "<"
            axes.plot(middle, 0.0, shape, color=palette.ink, markersize=6.0, zorder=4)
    return bool(np.any(sign))


def _loop(axes: Axes, cycle: Cycle, scale: float, palette: Palette) -> list[Entry]:
    """A cycle through modes: in each its rate over the state, dotted where one is left."""
    modes = np.array(cycle.modes)
    values, ends = cycle.points[:, 0] / scale, list[Array]()
    dashes = CYCLE_DASHES[cycle.stability]
    look: Look = {"color": palette.cycle, "linewidth": CYCLE_WIDTH, "linestyle": dashes}
    for part in np.split(np.arange(len(values)), np.flatnonzero(np.diff(modes)) + 1):
        moving = part[np.append(np.diff(cycle.times[part]) > 0.0, True)]
        if len(moving) < 2:
            continue
        rate = np.gradient(values[moving], cycle.times[moving])
        axes.plot(values[moving], rate, zorder=5, **look)
        middle = len(moving) // 2
        shape = ">" if rate[middle] > 0.0 else "<"
        axes.plot(values[moving][middle], rate[middle], shape, color=palette.cycle, zorder=5.1)
        ends += [np.array([values[moving[k]], rate[k]]) for k in (0, -1)]
    leap: Look = {"color": palette.cycle, "linewidth": 1.4, "linestyle": LEAP_DASHES}
    for before, after in zip(ends[1::2], [*ends[2::2], *ends[:1]], strict=True):
        axes.plot(*np.stack([before, after]).T, zorder=5, **leap)
    if not ends:
        return []
    return [line_entry(f"{cycle.stability} cycle", **look), line_entry(JUMP, **leap)]


def _switching(axes: Axes, portrait: Portrait, palette: Palette) -> list[Entry]:
    """Upright lines where the mode that is shown is left."""
    entries = []
    for number, switching in enumerate(portrait.switching):
        stroke = guard_stroke(palette, switching, number)
        look: Look = stroke.look | {"alpha": GUARD_ALPHA}
        for line in switching.lines:
            axes.axvline(float(line[0, 0]) / portrait.axes[0].unit.scale, zorder=1.5, **look)
        if switching.lines:
            entries.append(guard_entry(switching, stroke))
    return entries


def _cobweb(axes: Axes, portrait: Portrait, palette: Palette) -> list[Entry]:
    """The next value over the value; orbits bounce between the curve and the diagonal."""
    (state,) = portrait.axes
    scale = state.unit.scale
    nodes = portrait.field.nodes[0] / scale
    following = nodes + portrait.field.rates[:, 0] / scale
    name_x(axes, state)
    name_y(axes, state)
    axes.set_ylabel(axis_label(f"next {state.name}", state.unit))
    ends = (state.low / scale, state.high / scale)
    axes.plot(ends, ends, color=palette.faint, linewidth=0.9, linestyle=DIAGONAL, zorder=2)
    axes.plot(nodes, following, color=palette.nullcline, linewidth=1.8, zorder=3)
    for path in portrait.trajectories[:2]:
        axes.plot(*_web(path.points[:, 0] / scale), color=palette.path, linewidth=0.6, zorder=4)
    cycles = [_square(axes, cycle, scale, palette) for cycle in portrait.cycles]
    return [
        *_points(axes, portrait, palette, on_diagonal=True),
        *cycles,
        line_entry(f"next {state.name}", color=palette.nullcline, linewidth=1.8),
        line_entry("stays where it is", color=palette.faint, linestyle=DIAGONAL),
        line_entry("orbit", color=palette.path, linewidth=0.6),
    ]


def _square(axes: Axes, cycle: Cycle, scale: float, palette: Palette) -> Entry:
    """The closed web of a periodic orbit."""
    dashes = "-" if cycle.is_attracting else (0.0, (3.2, 1.6))
    look: Look = {"color": palette.cycle, "linewidth": 1.8, "linestyle": dashes}
    values = cycle.points[:, 0] / scale
    axes.plot(*_web(np.append(values, values[1])), zorder=5, **look)
    return line_entry(f"{cycle.stability} orbit of period {len(values) - 1}", **look)


def _web(values: Array) -> tuple[Array, Array]:
    """The corners of the cobweb of successive `values` (T,)."""
    x = np.repeat(values, 2)
    return x[:-1], x[1:]


def _points(axes: Axes, portrait: Portrait, palette: Palette, *, on_diagonal: bool) -> list[Entry]:
    scale = portrait.axes[0].unit.scale
    invented = [p.standing is Standing.INVENTED for p in portrait.fixed_points]
    at = _on_paper(
        np.array([p.at[0] / scale for p in portrait.fixed_points]), on_diagonal=on_diagonal
    )
    lost = _on_paper(portrait.completeness.lost[:, 0] / scale, on_diagonal=on_diagonal)
    return [
        *mark(axes, at, [p.kind for p in portrait.fixed_points], palette),
        *ring(axes, at[np.array(invented, dtype=bool)], palette),
        *cross(axes, lost, palette),
    ]


def _on_paper(values: Array, *, on_diagonal: bool) -> Array:
    return np.stack([values, values if on_diagonal else np.zeros_like(values)], axis=-1)


def _basins(axes: Axes, portrait: Portrait, palette: Palette, *, is_small: bool) -> list[Entry]:
    """Tinted stretches of the state, one tint an attractor."""
    basins = portrait.basins
    if basins is None or not basins.attractors:
        return []
    (state,) = portrait.axes
    labels = basins.labels
    edges = np.linspace(state.low, state.high, len(labels) + 1) / state.unit.scale
    breaks = [0, *(np.flatnonzero(np.diff(labels)) + 1).tolist(), len(labels)]
    for a, b in pairwise(breaks):
        if labels[a] >= 0:
            axes.axvspan(
                edges[a],
                edges[b],
                facecolor=tint(palette, int(labels[a])),
                hatch=hatch(palette, int(labels[a])),
                edgecolor=palette.slow,
                linewidth=0.0,
                zorder=0,
            )
    return basin_entries(palette, portrait, is_small=is_small)


def _undecided(axes: Axes, portrait: Portrait, palette: Palette) -> list[Entry]:
    (state,) = portrait.axes
    scale = state.unit.scale
    if portrait.completeness.still and portrait.every == 0.0:
        rest: Look = {"color": palette.alarm, "linewidth": 5.0, "alpha": 0.4}
        axes.plot([state.low / scale, state.high / scale], [0.0, 0.0], zorder=2.5, **rest)
        axes.set_ylim(-1.0, 1.0)
        return [line_entry(undecided_label(portrait), **rest)]
    look: Look = {
        "facecolor": "none",
        "edgecolor": palette.alarm,
        "hatch": "//////",
        "linewidth": 0.0,
    }
    for box in portrait.completeness.undecided:
        axes.axvspan(float(box.low[0]) / scale, float(box.high[0]) / scale, zorder=1, **look)
    if not portrait.completeness.undecided:
        return []
    return [Entry(undecided_label(portrait), (Patch(**look),))]


def _per_second(unit: Unit) -> Unit:
    text = "1/s" if unit.text in {"", "1"} else f"{unit.text}/s"
    return Unit(text, unit.scale)
