"""What a learner of several steps does in the square, and what it expects there."""

from itertools import pairwise
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import FancyBboxPatch, Patch, Polygon, Rectangle

from lcs.arrays import Array, Integers
from lcs.problems.steps import Plane
from lcs.steps.learner import StepsLearner
from specc.figures.palettes import PALETTES, Palette
from specc.figures.style import bare, framed, look
from specc.figures.style_names import Style

FINE: Final = 200
"""Places along each side whose action is drawn."""
ARROWS: Final = 16
"""Arrows along each side."""
STARTS: Final = ((0.05, 0.05), (0.08, 0.62), (0.30, 0.62), (0.25, 0.90), (0.90, 0.05))
LONGEST: Final = 120


def draw_policy(
    learner: StepsLearner,
    world: Plane,
    chance: np.random.Generator,
    *,
    style: Style = Style.SCREEN,
) -> Figure:
    """The best action everywhere with some ways that it leads, and the worth with its boxes."""
    palette = PALETTES[style]
    centres = (np.arange(FINE) + 0.5) / FINE
    x, y = np.meshgrid(centres, centres)
    actions, worth = learner.decide(np.column_stack((x.ravel(), y.ravel())))
    with look(palette):
        figure = Figure(figsize=(10.0, 4.8), facecolor=palette.paper)
        grid = framed(figure, 1, 2, (0.6, 0.55, 0.55, 0.75))
        grid.update(wspace=0.24)
        does, expects = (figure.add_subplot(grid[k]) for k in range(2))
        _draw_actions(does, actions.reshape(FINE, FINE), learner, palette)
        _draw_ways(does, learner, world, chance, palette)
        _draw_worth(expects, worth.max(axis=1).reshape(FINE, FINE), learner, palette)
        for axes, title in ((does, "Best action"), (expects, "Expected return, discounted")):
            _draw_square(axes, world, palette)
            axes.set_title(title, loc="left", pad=8.0)
        entries = _legend(world, np.unique(actions), len(learner.bodies.first) - 1, palette)
        figure.legend(handles=entries, loc="upper left", ncols=len(entries), columnspacing=1.4)
    return figure


def _draw_actions(axes: Axes, actions: Integers, learner: StepsLearner, palette: Palette) -> None:
    tints = palette.tints[: learner.actions]
    axes.imshow(
        actions,
        origin="lower",
        extent=(0.0, 1.0, 0.0, 1.0),
        cmap=ListedColormap(tints),
        vmin=-0.5,
        vmax=len(tints) - 0.5,
        interpolation="nearest",
    )
    ticks = (np.arange(ARROWS) + 0.5) / ARROWS
    x, y = (part.ravel() for part in np.meshgrid(ticks, ticks))
    is_open = x + y <= 1.9
    best, _ = learner.decide(np.column_stack((x, y))[is_open])
    toward = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])[best]
    axes.quiver(
        x[is_open],
        y[is_open],
        *toward.T,
        pivot="mid",
        color=palette.faint,
        scale=34.0,
        width=0.0035,
        headwidth=4.5,
    )


def _draw_ways(
    axes: Axes,
    learner: StepsLearner,
    world: Plane,
    chance: np.random.Generator,
    palette: Palette,
) -> None:
    for start in STARTS:
        way = _way(learner, world, np.array(start), chance)
        color = palette.cycle
        axes.plot(*way.T, color=color, linewidth=1.3, marker=".", markersize=3.0, zorder=4)
        axes.plot(*way[0], color=color, marker="o", markersize=6.0, mec=palette.paper, zorder=5)


def _way(learner: StepsLearner, world: Plane, x: Array, chance: np.random.Generator) -> Array:
    """The places (T, 2) that the best actions lead through."""
    way = [x]
    for _ in range(LONGEST):
        action = int(learner.decide(x[None])[0][0])
        x, _, ends = world.step(x, action, chance)
        way.append(x)
        if ends:
            break
    return np.array(way)


def _draw_worth(axes: Axes, worth: Array, learner: StepsLearner, palette: Palette) -> None:
    """The less is expected, the further from the paper's color; so edges of boxes are seen."""
    colors = LinearSegmentedColormap.from_list("worth", [palette.nullcline, palette.paper])
    drawn = axes.imshow(
        worth, origin="lower", extent=(0.0, 1.0, 0.0, 1.0), cmap=colors, interpolation="nearest"
    )
    bar = axes.figure.colorbar(drawn, ax=axes, fraction=0.046, pad=0.03)
    bar.outline.set_visible(False)
    bodies = learner.bodies
    first, last = next(pairwise(bodies.first))
    lower, upper = np.clip(bodies.lower[first:last], 0, 1), np.clip(bodies.upper[first:last], 0, 1)
    for low, high in zip(lower, upper, strict=True):
        axes.add_patch(
            Rectangle(low, *(high - low), fill=False, edgecolor=palette.ink, linewidth=0.25)
        )


def _draw_square(axes: Axes, world: Plane, palette: Palette) -> None:
    square = world.square
    corner = [(1.0, square.goal - 1.0), (1.0, 1.0), (square.goal - 1.0, 1.0)]
    axes.add_patch(
        Polygon(corner, facecolor=palette.paper, edgecolor=palette.ink, hatch="////", zorder=3)
    )
    for a, b in square.puddles:
        (x, y), (wide, high) = np.minimum(a, b), np.abs(b - a)
        axes.add_patch(
            FancyBboxPatch(
                (x, y),
                wide,
                high,
                boxstyle=f"round,pad={square.radius}",
                fill=False,
                edgecolor=palette.stable,
                linewidth=1.4,
                zorder=3,
            )
        )
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    axes.set_aspect("equal")
    axes.set_xlabel("x")
    axes.set_ylabel("y")
    bare(axes)


def _legend(world: Plane, taken: Integers, families: int, palette: Palette) -> list[Patch | Line2D]:
    paper, ink = palette.paper, palette.ink
    entries: list[Patch | Line2D] = [
        Patch(
            facecolor=palette.tints[a],
            edgecolor=palette.faint,
            linewidth=0.5,
            label=world.labels[a],
        )
        for a in taken
    ]
    entries.append(Line2D([], [], color=palette.cycle, marker=".", label="ways it leads"))
    entries.append(Patch(facecolor=paper, edgecolor=ink, hatch="////", label="goal"))
    if len(world.square.puddles):
        entries.append(Patch(facecolor=paper, edgecolor=palette.stable, label="edge of a puddle"))
    boxes = "boxes of rules" if families == 1 else f"boxes of rules (1 of {families} layers)"
    entries.append(Patch(facecolor=paper, edgecolor=ink, linewidth=0.4, label=boxes))
    return entries
