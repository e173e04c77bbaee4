"""Curves of a portrait: nullclines, trajectories, separatrices, cycles and switching lines.

What a curve is, its colour and its dashes both say; of cycles the dashes say whether they attract.
"""

from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, Literal, TypeAlias, final

import numpy as np

from runtime.arrays import Array, frozen
from specc.figures.legend import Entry, Look, line_entry
from specc.figures.palettes import Palette
from specc.figures.panel import Panel, draw_heads, places_along
from specc.figures.quantities import rate_of
from verifier.topology.features import Cycle, Portrait, Stability, Switching

Dashes: TypeAlias = tuple[float, tuple[float, ...]] | Literal["-"]

NULLCLINE_DASHES: Final[tuple[Dashes, Dashes]] = ((0.0, (7.0, 2.2)), (0.0, (1.4, 1.6)))

CYCLE_DASHES: Final[MappingProxyType[Stability, Dashes]] = MappingProxyType(
    {
        Stability.STABLE: "-",
        Stability.UNSTABLE: (0.0, (3.2, 1.6)),
        Stability.SADDLE: (0.0, (1.0, 1.3)),
        Stability.SEMI_STABLE: (0.0, (5.0, 1.4, 1.0, 1.4)),
        Stability.NEUTRAL: "-",
    }
)
CYCLE_WIDTH: Final = 2.5
NEUTRAL_WIDTH: Final = 1.3

MANIFOLD_WIDTH: Final = 1.7

HEAD: Final = 0.115
"""The length of an arrowhead on a curve, in inches."""

APART: Final = 2.2
"""How far apart arrowheads stand along a curve, in inches."""

CLEAR: Final = 0.7
"""How far an arrowhead stays from those of other curves of its kind, in inches."""


LEAP_DASHES: Final = (0.0, (0.9, 1.5))
"""Of what happens at once: the state jumps where the mode changes."""

JUMP: Final = "jump"
"""What the legend calls these."""

GUARD_DASHES: Final[tuple[Dashes, ...]] = (
    (0.0, (3.0, 0.6)),
    (0.0, (1.0, 0.6)),
    (0.0, (3.0, 0.6, 0.8, 0.6)),
    (0.0, (6.0, 0.8)),
)
"""Of the lines at which modes are left, in widths of the line."""

GUARD_ALPHA: Final = 0.55

GUARD_WIDTH: Final = 3.6
"""They are broad bands behind the curves, so that what runs or jumps along them is seen."""

NOTHING: Final = frozen(np.empty((0, 2)))


@final
@dataclass(frozen=True, slots=True)
class Stroke:
    """How a curve is drawn: colour, dashes, width in points."""

    color: str
    dashes: Dashes
    width: float

    @property
    def look(self) -> Look:
        """The same for matplotlib."""
        return {"color": self.color, "linestyle": self.dashes, "linewidth": self.width}

    def scaled(self, weight: float) -> "Stroke":
        """The stroke in a small panel."""
        return replace(self, width=weight * self.width)


def draw_nullclines(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Where one variable's rate is zero."""
    entries = []
    names = [axis.name for axis in portrait.axes]
    for nullcline in portrait.nullclines:
        if not nullcline.lines:
            continue
        name = nullcline.of
        stroke = Stroke(panel.palette.nullcline, NULLCLINE_DASHES[names.index(name)], 1.3)
        for line in nullcline.lines:
            look = stroke.scaled(panel.weight).look
            panel.axes.plot(*panel.shown(line).T, zorder=3, **look)
        is_map = portrait.every > 0.0
        label = f"next {name} = {name}" if is_map else f"{rate_of(name)} = 0"
        entries.append(line_entry(label, **stroke.look))
    return entries


def draw_trajectories(panel: Panel, portrait: Portrait) -> list[Entry]:
    """A few trajectories; of a map its orbits, as dots."""
    if not portrait.trajectories:
        return []
    color = panel.palette.path
    if portrait.every > 0.0:
        look: Look = {"linestyle": "none", "marker": "o", "color": color, "markeredgewidth": 0.0}
        for path in portrait.trajectories:
            points = panel.shown(path.points)
            panel.axes.plot(*points.T, markersize=2.2 * panel.weight, zorder=4, **look)
        return [line_entry("orbit", markersize=2.8, **look)]
    stroke, heads = Stroke(color, "-", 0.9), list[Array]()
    leap, jumped = Stroke(color, LEAP_DASHES, 0.7), False
    heavy = [c.points for c in portrait.cycles] + [s.points for s in portrait.separatrices]
    clear_of = panel.inches(np.concatenate(heavy)) if heavy else np.empty((0, 2))
    for path in portrait.trajectories:
        pieces, leaps = at_jumps(path.times, path.points)
        for piece in pieces:
            draw_path(panel, piece, stroke, 4.0, heads, clear_of)
        for points in leaps:
            draw_path(panel, points, leap, 4.0, None)
        jumped = jumped or bool(leaps)
    jump = [line_entry(JUMP, **leap.look)] if jumped else []
    return [line_entry("trajectory", **stroke.look), *jump]


def draw_separatrices(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Stable and unstable manifolds of the saddles."""
    palette = panel.palette
    strokes = {
        True: Stroke(palette.stable, "-", MANIFOLD_WIDTH),
        False: Stroke(palette.unstable, (0.0, (6.0, 1.6, 1.2, 1.6)), MANIFOLD_WIDTH),
    }
    heads: list[Array] = []
    for branch in portrait.separatrices:
        draw_path(panel, branch.points, strokes[branch.stable], 5.0, heads)
    present = {branch.stable for branch in portrait.separatrices}
    names = {True: "stable manifold", False: "unstable manifold"}
    return [line_entry(names[s], **strokes[s].look) for s in (True, False) if s in present]


def draw_cycles(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Closed trajectories: stable solid, unstable dashed; of a map, the points of its orbits."""
    if portrait.every == 0.0:
        return [entry for cycle in portrait.cycles for entry in _draw_cycle(panel, cycle)]
    present = [s for s in Stability if any(c.stability is s for c in portrait.cycles)]
    return [
        _draw_orbits_of_map(panel, s, [c for c in portrait.cycles if c.stability is s])
        for s in present
    ]


def _draw_cycle(panel: Panel, cycle: Cycle) -> list[Entry]:
    width = NEUTRAL_WIDTH if cycle.stability is Stability.NEUTRAL else CYCLE_WIDTH
    stroke = Stroke(panel.palette.cycle, CYCLE_DASHES[cycle.stability], width)
    leap = Stroke(panel.palette.cycle, LEAP_DASHES, 0.8 * width)
    heads: list[Array] = []
    pieces, leaps = at_jumps(cycle.times, cycle.points)
    for piece in pieces:
        draw_path(panel, piece, stroke, 6.0, heads)
    for points in leaps:
        draw_path(panel, points, leap, 6.0, heads)
    jump = [line_entry(JUMP, **leap.look)] if leaps else []
    return [line_entry(f"{cycle.stability} cycle", **stroke.look), *jump]


def _draw_orbits_of_map(panel: Panel, stability: Stability, cycles: list[Cycle]) -> Entry:
    """The points of all periodic orbits of one stability, with their periods in steps."""
    palette = panel.palette
    is_stable = stability is Stability.STABLE
    look: Look = {
        "linestyle": "none",
        "marker": "h",
        "markersize": 6.5 if is_stable else 4.5,
        "markeredgecolor": palette.cycle,
        "markerfacecolor": palette.cycle if is_stable else palette.paper,
    }
    points = panel.shown(np.concatenate([cycle.points[:-1] for cycle in cycles]))
    panel.axes.plot(*points.T, zorder=6, **look)
    periods = sorted({len(cycle.points) - 1 for cycle in cycles})
    label = f"{stability} orbit, period {', '.join(map(str, periods))}"
    return line_entry(label, **look)


def at_jumps(times: Array, points: Array) -> tuple[list[Array], list[Array]]:
    """A path (T, m) as pieces between its jumps, and each jump as a line of its own.

    It jumps where its place changes and time stands still: a mode was left, and resets applied.
    """
    reach = np.ptp(points, axis=0)
    leap = np.abs(np.diff(points, axis=0)) > 0.01 * np.where(reach > 0.0, reach, np.inf)
    still = np.diff(times) <= 1e-9 * np.ptp(times)
    jumps = np.flatnonzero(leap.any(axis=-1) & still)
    pieces = [piece for piece in np.split(points, jumps + 1) if len(piece) > 1]
    return pieces, [np.linspace(points[k], points[k + 1], 9) for k in jumps.tolist()]


def draw_switching(panel: Panel, portrait: Portrait) -> list[Entry]:
    """Where the mode that is shown is left: lines of the guards."""
    entries = []
    for number, switching in enumerate(portrait.switching):
        stroke = guard_stroke(panel.palette, switching, number)
        for line in switching.lines:
            look = stroke.scaled(panel.weight).look
            panel.axes.plot(*panel.shown(line).T, zorder=2.5, alpha=GUARD_ALPHA, **look)
        if switching.lines:
            entries.append(guard_entry(switching, stroke))
    return entries


def guard_stroke(palette: Palette, switching: Switching, number: int) -> Stroke:
    """How a guard is drawn, the `number`-th of its mode: the way back looks different."""
    which = 2 * number + (switching.mode > switching.target)
    return Stroke(palette.switch, GUARD_DASHES[which % len(GUARD_DASHES)], GUARD_WIDTH)


def guard_entry(switching: Switching, stroke: Stroke) -> Entry:
    """What the legend says of a guard."""
    itself = switching.mode == switching.target
    way = (
        f"{switching.mode} jumps here"
        if itself
        else f"{switching.mode} switches to {switching.target}"
    )
    return line_entry(way, alpha=GUARD_ALPHA, **stroke.look)


def draw_path(
    panel: Panel,
    points: Array,
    stroke: Stroke,
    zorder: float,
    heads: list[Array] | None,
    clear_of: Array = NOTHING,
) -> None:
    """A path (T, 2) in the direction of time, cut at seams, with arrowheads along it.

    heads: where arrowheads of its kind stand already, in inches; new ones are added, and keep
    away from them; None: it gets none. clear_of: (k, 2) points of heavier curves that would
    hide them, in inches.
    """
    places, directions = [], []
    for piece in panel.pieces(points):
        panel.axes.plot(*panel.shown(piece).T, zorder=zorder, **stroke.scaled(panel.weight).look)
        if heads is None:
            continue
        inches = panel.inches(piece)
        for k in places_along(inches, APART).tolist():
            direction = inches[k + 1] - inches[k - 1]
            is_clear = _is_far(inches[k], clear_of, 1.2 * HEAD)
            if np.any(direction) and is_clear and _is_far(inches[k], heads, CLEAR * panel.weight):
                places.append(inches[k])
                directions.append(direction)
                heads.append(inches[k])
    size = HEAD * panel.weight * (0.7 + 0.2 * stroke.width)
    at, along = np.array(places).reshape(-1, 2), np.array(directions).reshape(-1, 2)
    draw_heads(panel, at, along, size, stroke.color, zorder + 0.1)


def _is_far(place: Array, others: Array | list[Array], distance: float) -> bool:
    gaps = np.reshape(others, (-1, 2)) - place
    return not gaps.size or float(np.hypot(gaps[:, 0], gaps[:, 1]).min()) > distance
