"""Rules over two inputs: what is decided where, and which boxes say so; one panel an action."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from lcs.inputs import Input
from lcs.rules.deciding import decide
from lcs.rules.names import Names
from lcs.rules.table import RuleTable
from runtime.arrays import Array, Booleans, Integers
from specc.figures.legend import Entry, Look, draw_legend, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import BELOW, LEFT, LINE, axes_at, heading, new_figure, write_heading
from specc.figures.quantities import number, range_shown
from specc.figures.style import look
from specc.figures.style_names import Style

CELLS: Final = 240
"""Points of a decided region along each input."""

PANEL: Final = 2.6
GAP: Final = 0.62
ABOVE: Final = 0.26
BESIDE: Final = 2.2
"""For the legend, in inches as all."""

COLUMNS: Final = 3
DOTS: Final = 600
"""Examples that are drawn, at most."""

FEW: Final = 20
"""Boxes in a panel: of more none is hatched."""

MARKS: Final = ("o", "s", "^", "x", "v", "D")
TITLE: Final[Look] = {"loc": "left", "fontsize": 9.5, "pad": 4}


@final
@dataclass(frozen=True, eq=False, slots=True)
class Slice:
    """A plane through the inputs: over inputs x and y, indices of columns.

    at (n,): the values of the others; None: all rules are drawn as they lie over x and y, whatever
    they ask of the others, and no decision is shown.
    """

    x: int
    y: int
    at: Array | None


def slice_through(table: RuleTable, names: Names, x: str, y: str, at: Mapping[str, float]) -> Slice:
    """The plane over two inputs by name, where the others have the values given, else their middle.

    Raises:
        KeyError: no input has such a name.
    """
    places = {each.name: i for i, each in enumerate(names.inputs)}
    middle = table.low + (table.high - table.low) / 2.0
    for name, value in at.items():
        middle[places[name]] = value
    return Slice(places[x], places[y], middle)


def draw_rules(
    table: RuleTable,
    names: Names,
    plane: Slice,
    title: str,
    *,
    about: Sequence[str] = (),
    examples: tuple[Array, Integers] | None = None,
    style: Style = Style.SCREEN,
) -> Figure:
    """What is decided, and for each action the boxes of its rules by what they say.

    Args:
        table: the rules.
        names: of inputs and actions.
        plane: which two inputs, and what the others are.
        title: of the picture.
        about: sentences under the title.
        examples: inputs (T, n) and their actions (T,), drawn as dots over what is decided, if they
            lie in the plane, which they do where there are but two inputs.
        style: its colours and type.
    """
    palette = PALETTES[style]
    shown = _shown(table, plane)
    panels = [*([] if plane.at is None else [None]), *range(table.actions)]  # None: the decision
    columns = min(COLUMNS, len(panels))
    rows = math.ceil(len(panels) / columns)
    width = columns * PANEL + (columns - 1) * GAP
    height = rows * (PANEL + ABOVE) + (rows - 1) * GAP
    text = heading(title, [*about, *_where(table, names, plane)], [], width + BESIDE)
    below = BELOW + LINE * len(text.below)
    with look(palette):
        figure = new_figure(LEFT + width + BESIDE, below + height + text.height + 0.1, palette)
        entries: list[Entry] = []
        for k, action in enumerate(panels):
            row, column = divmod(k, columns)
            left = LEFT + column * (PANEL + GAP)
            up = below + (rows - 1 - row) * (PANEL + ABOVE + GAP)
            axes = axes_at(figure, (left, up), (PANEL, PANEL))
            _frame(axes, table, names, plane, palette)
            if action is None:
                axes.set_title("what is decided", **TITLE)
                entries += _draw_decided(axes, table, names, plane, examples, palette)
                _outline(axes, table, shown & _is_for(table), plane, palette)
            else:
                axes.set_title(f"rules on {names.actions[action]}", **TITLE)
                those = shown & (table.action == action)
                entries += _draw_boxes(axes, table, those, plane, palette)
        corner = np.array([LEFT + width + 0.2, below + height - ABOVE]) / figure.get_size_inches()
        draw_legend(figure, entries, (float(corner[0]), float(corner[1])))
        top = below + height + text.height
        write_heading(figure, text, palette, LEFT, top, below - BELOW + 0.05)
    return figure


def _shown(table: RuleTable, plane: Slice) -> Booleans:
    """Which rules meet the plane (R,)."""
    if plane.at is None:
        return np.ones(len(table), np.bool_)
    others = [i for i in range(len(plane.at)) if i not in {plane.x, plane.y}]
    at, lower, upper = plane.at[others], table.lower[:, others], table.upper[:, others]
    is_end = (at == upper) & (upper == table.high[others])
    return np.asarray(((lower <= at) & ((at < upper) | is_end)).all(axis=1))


def _where(table: RuleTable, names: Names, plane: Slice) -> list[str]:
    """What the other inputs are."""
    n = table.lower.shape[1]
    others = [i for i in range(n) if i not in {plane.x, plane.y}]
    if not others:
        return []
    if plane.at is None:
        return ["All rules as they lie over these two inputs, whatever they ask of the others."]
    stated = ", ".join(_value(names.inputs[i], float(plane.at[i])) for i in others)
    return [f"Where {stated}."]


def _value(each: Input, at: float) -> str:
    if each.values:
        return f"{each.name} = {each.values[min(max(round(at), 0), len(each.values) - 1)]}"
    return f"{each.name} = {number(at)}{f' {each.unit}' if each.unit else ''}"


def _frame(axes: Axes, table: RuleTable, names: Names, plane: Slice, palette: Palette) -> None:
    axes.set_facecolor(palette.paper)
    axes.set_xlim(range_shown(float(table.low[plane.x]), float(table.high[plane.x])))
    axes.set_ylim(range_shown(float(table.low[plane.y]), float(table.high[plane.y])))
    for axis, i in ((axes.xaxis, plane.x), (axes.yaxis, plane.y)):
        each = names.inputs[i]
        axis.set_label_text(f"{each.name} [{each.unit}]" if each.unit else each.name)
        if each.values:
            axis.set_ticks(list(range(len(each.values))), labels=list(each.values))


def _is_for(table: RuleTable) -> Booleans:
    """Rules that expect the highest reward."""
    return np.asarray(table.prediction == table.prediction.max())


def _draw_decided(
    axes: Axes,
    table: RuleTable,
    names: Names,
    plane: Slice,
    examples: tuple[Array, Integers] | None,
    palette: Palette,
) -> list[Entry]:
    """The best action as a ground, and examples as dots; entries of the legend."""
    assert plane.at is not None, "a projection shows no decision"
    x, y = (np.linspace(table.low[i], table.high[i], CELLS) for i in (plane.x, plane.y))
    asked = np.tile(plane.at, (CELLS * CELLS, 1))
    asked[:, plane.x], asked[:, plane.y] = np.tile(x, CELLS), np.repeat(y, CELLS)
    best = decide(table, asked).best.reshape(CELLS, CELLS)
    entries = []
    for action in range(-1, table.actions):
        there = (best == action).astype(np.float64)
        if not there.any():
            continue
        color, hatch = _ground(action, palette)
        axes.contourf(x, y, there, levels=[0.5, 1.5], colors=[color], hatches=[hatch])
        label = names.actions[action] if action >= 0 else "some action unknown"
        ground = Patch(facecolor=color, hatch=hatch, edgecolor=palette.faint, linewidth=0.5)
        entries.append(Entry(f"decided: {label}", (ground,)))
    if examples is not None and len(plane.at) == 2:
        entries += _draw_examples(axes, plane, examples, names, palette)
    return entries


def _ground(action: int, palette: Palette) -> tuple[str, str]:
    """The color and the hatch of a decided region; -1: of what is unknown."""
    if action < 0:
        return palette.paper, "////"
    hatches = palette.hatches or ("",)
    return palette.tints[action % len(palette.tints)], hatches[action % len(hatches)]


def _draw_examples(
    axes: Axes, plane: Slice, examples: tuple[Array, Integers], names: Names, palette: Palette
) -> list[Entry]:
    """Examples as marks, one for each action; entries of the legend."""
    entries = []
    some = np.linspace(0, len(examples[0]) - 1, min(len(examples[0]), DOTS)).astype(np.int64)
    inputs, actions = examples[0][some], examples[1][some]
    for action in np.unique(actions):
        x = inputs[actions == action]
        mark = MARKS[int(action) % len(MARKS)]
        dots: Look = {"marker": mark, "ls": "none", "color": palette.ink}
        axes.plot(x[:, plane.x], x[:, plane.y], **dots, markersize=2.2, alpha=0.5)
        label = f"example of {names.actions[int(action)]}"
        entries.append(line_entry(label, **dots, markersize=4.0, alpha=0.7))
    return entries


def _draw_boxes(
    axes: Axes, table: RuleTable, those: Booleans, plane: Slice, palette: Palette
) -> list[Entry]:
    """Boxes of rules by what they expect; overlaps are darker."""
    entries = []
    is_for, count = _is_for(table), int(those.sum())
    depth = float(np.clip(2.0 / max(count, 1), 0.04, 0.22))
    for of, color, hatch, label in (
        (~is_for, palette.cycle, "xx", "a rule says no"),
        (is_for, palette.nullcline, "", "a rule says yes"),
    ):
        edge: Look = {"edgecolor": color, "linewidth": 1.2 if count <= FEW else 0.7}
        fill = edge | {"facecolor": to_rgba(color, depth), "hatch": hatch if count <= FEW else ""}
        boxes = _boxes(table, those & of, plane)
        for box in boxes:
            axes.add_patch(Rectangle(*box, **fill))
        if boxes:
            entries.append(Entry(label, (Patch(**(fill | {"facecolor": to_rgba(color, 0.22)})),)))
    return entries


def _outline(axes: Axes, table: RuleTable, those: Booleans, plane: Slice, palette: Palette) -> None:
    """Only the edges of boxes."""
    for box in _boxes(table, those, plane):
        axes.add_patch(Rectangle(*box, facecolor="none", edgecolor=palette.faint, linewidth=0.8))


def _boxes(
    table: RuleTable, those: Booleans, plane: Slice
) -> list[tuple[tuple[float, float], float, float]]:
    """Corner, width and height of the rules' boxes; the large ones first."""
    axes = [plane.x, plane.y]
    lower, size = table.lower[those][:, axes], (table.upper - table.lower)[those][:, axes]
    order = np.argsort(-size.prod(axis=1), kind="stable")
    return [
        ((float(x), float(y)), float(width), float(height))
        for (x, y), (width, height) in zip(lower[order], size[order], strict=True)
    ]
