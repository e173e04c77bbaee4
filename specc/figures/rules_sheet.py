"""The rule sheet: what each rule asks of each input, and what it says; a row for a rule."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from lcs.rules.names import Names
from lcs.rules.parts import rules_of
from lcs.rules.readable import readable
from lcs.rules.table import RuleTable
from lcs.rules.words import Sentence, allowed_values, bound_text, in_words
from runtime.arrays import Array
from specc.figures.legend import Look
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import LINE, axes_at, heading, new_figure, write_heading
from specc.figures.quantities import number, range_shown
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.text_width import text_width

MOST: Final = 64
"""Rules that are drawn; of more, those that decide most."""

COLUMN: Final = 1.05
"""The width of an input's column, in inches; of more than ten a part of it, if bounds have room."""

ROW: Final = 0.19
HEAD: Final = 0.36
"""For the names of the columns, and what each ranges over."""

SIDE: Final = 0.25
SAYS: Final = 1.55
"""For what a rule says, at least."""

CASES: Final = 1.5
SMALL: Final = 7.0
TINY: Final = 6.5
"""Points of the ends of ranges, and of bounds."""

INDENT: Final = 0.04
BAR: Final = 0.84
"""The share of a column that is the input's range."""


def draw_rule_sheet(
    table: RuleTable,
    names: Names,
    title: str,
    *,
    about: Sequence[str] = (),
    examples: Array | None = None,
    style: Style = Style.SCREEN,
) -> Figure:
    """Rows are rules, columns the inputs that any of them asks for, bars the values asked for.

    Args:
        table: the rules; best after compaction.
        names: of inputs and actions.
        title: of the picture.
        about: sentences under the title.
        examples: inputs (T, n), on which the rules that decide most come first and bounds are
            rounded so that no example changes sides.
        style: its colours and type.
    """
    palette = PALETTES[style]
    said = _most(in_words(table, names, examples), table)
    sheet = _sheet(readable(table, examples), names, said, palette)
    text = heading(title, list(about), _notes(sheet, len(table)), sheet.width)
    below = 0.16 + LINE * len(text.below)
    with look(palette):
        size = (2 * SIDE + sheet.width, below + sheet.height + text.height + 0.1)
        figure = new_figure(*size, palette)
        axes = axes_at(figure, (SIDE, below), (sheet.width, sheet.height))
        axes.set_xlim(0.0, sheet.width)
        axes.set_ylim(sheet.height, 0.0)
        axes.set_axis_off()
        _draw_head(axes, sheet)
        _draw_rows(axes, sheet)
        top = below + sheet.height + text.height
        write_heading(figure, text, palette, SIDE, top, below - 0.05)
    return figure


@final
@dataclass(frozen=True, slots=True)
class _Sheet:
    """What is drawn: these rules, as columns of the inputs `asked`; widths in inches.

    column: of an input. says: of what a rule says.
    """

    table: RuleTable
    names: Names
    said: list[Sentence]
    asked: list[int]
    palette: Palette
    column: float
    says: float

    @property
    def bars(self) -> float:
        """The width of all inputs' columns."""
        return self.column * len(self.asked)

    @property
    def width(self) -> float:
        return self.bars + self.says + CASES

    @property
    def height(self) -> float:
        groups = {int(self.table.action[each.rule]) for each in self.said}
        return HEAD + ROW * len(self.said) + 1.4 * ROW * len(groups)


def _sheet(table: RuleTable, names: Names, said: list[Sentence], palette: Palette) -> _Sheet:
    asked = _asked(table, [each.rule for each in said])
    column = max(0.62, min(COLUMN, 10.0 * COLUMN / max(len(asked), 1)))
    column = max([column, *(_room_for(table, names, each.rule, i) for each in said for i in asked)])
    says = max(SAYS, *(0.45 + text_width(each.then, 8.0) for each in said))
    return _Sheet(table, names, said, asked, palette, column, says)


def _most(said: list[Sentence], table: RuleTable) -> list[Sentence]:
    """Those with most cases, where they are many; in the order given."""
    cases = table.right + table.wrong
    kept = set(np.argsort(-cases, kind="stable")[:MOST].tolist())
    return [each for each in said if each.rule in kept]


def _asked(table: RuleTable, rules: list[int]) -> list[int]:
    """The inputs that any of these rules asks for."""
    drawn = rules_of(table, np.array(rules, np.int64))
    is_asked = (drawn.lower > table.low) | (drawn.upper < table.high)
    return [int(i) for i in np.flatnonzero(is_asked.any(axis=0))]


def _notes(sheet: _Sheet, count: int) -> list[str]:
    holds = "A rule holds where each input that it asks for lies within its bar."
    notes = [f"{holds} An empty cell: the input does not matter."]
    if len(sheet.said) < count:
        notes.append(f"Of {count:,} rules the {len(sheet.said)} with most cases are shown.")
    names = [each.name for i, each in enumerate(sheet.names.inputs) if i not in sheet.asked]
    if names:
        notes.append(f"No rule shown asks for {', '.join(names)}.")
    return notes


def _draw_head(axes: Axes, sheet: _Sheet) -> None:
    """The inputs' names, and under each the ends of its range."""
    bold: Look = {"fontsize": 9.0, "fontweight": "bold", "va": "center"}
    small: Look = {"fontsize": SMALL, "color": sheet.palette.faint, "va": "center"}
    for k, i in enumerate(sheet.asked):
        each, left = sheet.names.inputs[i], k * sheet.column
        name = f"{each.name} [{each.unit}]" if each.unit else each.name
        axes.text(left + INDENT, 0.08, name, **bold)
        low, high = range_shown(float(sheet.table.low[i]), float(sheet.table.high[i]))
        ends = (each.values[0], each.values[-1]) if each.values else (number(low), number(high))
        first, last = ends
        axes.text(left + INDENT, 0.25, first, ha="left", **small)
        axes.text(left + INDENT + BAR * sheet.column, 0.25, last, ha="right", **small)
    axes.text(sheet.bars + 0.1, 0.08, "then", **bold)
    axes.text(sheet.bars + sheet.says, 0.08, f"was {sheet.names.right} in", **bold)


def _draw_rows(axes: Axes, sheet: _Sheet) -> None:
    top, before = HEAD, -1
    for each in sheet.said:
        action = int(sheet.table.action[each.rule])
        if action != before:
            top += 0.4 * ROW
            _draw_group(axes, sheet, sheet.names.actions[action], top)
            top, before = top + ROW, action
        _draw_rule(axes, sheet, each, top)
        top += ROW


def _draw_group(axes: Axes, sheet: _Sheet, action: str, top: float) -> None:
    faint = sheet.palette.faint
    axes.plot([0.0, sheet.width], [top, top], color=faint, linewidth=0.7)
    look: Look = {"fontsize": 8.0, "color": faint, "va": "center", "fontstyle": "italic"}
    axes.text(INDENT, top + 0.5 * ROW, f"rules on {action}", **look)


def _draw_rule(axes: Axes, sheet: _Sheet, said: Sentence, top: float) -> None:
    """A rule's bars, what it says, and how often that was right."""
    table, palette, rule = sheet.table, sheet.palette, said.rule
    is_for = table.prediction[rule] == table.prediction.max()
    color = palette.nullcline if is_for else palette.cycle
    for k, i in enumerate(sheet.asked):
        if _is_asked(table, rule, i):
            _draw_bar(axes, sheet, (rule, i), (k * sheet.column + INDENT, top), color)
    middle = top + 0.5 * ROW
    axes.plot(sheet.bars + 0.17, middle, "o" if is_for else "x", color=color, markersize=4.5)
    axes.text(sheet.bars + 0.3, middle, said.then, fontsize=8.0, va="center")
    right, cases = int(table.right[rule]), int(table.right[rule] + table.wrong[rule])
    counted = f"all {cases:,} cases" if right == cases else f"{right:,} of {cases:,} cases"
    look: Look = {"fontsize": 7.5, "color": palette.faint, "va": "center"}
    axes.text(sheet.bars + sheet.says, middle, counted if cases else "never tried", **look)


def _room_for(table: RuleTable, names: Names, rule: int, i: int) -> float:
    """The least width of a column in which the bounds of a bar have room beside or in the bar."""
    if not _is_asked(table, rule, i):
        return 0.0
    begin, end = _span(table, names, rule, i)
    wide = _text_room(_bounds(table, names, rule, i))
    shares = (BAR * begin, 1.0 - BAR * end - INDENT / COLUMN, BAR * (end - begin))
    return wide / max(shares)


def _is_asked(table: RuleTable, rule: int, i: int) -> bool:
    return bool(table.lower[rule, i] > table.low[i] or table.upper[rule, i] < table.high[i])


def _span(table: RuleTable, names: Names, rule: int, i: int) -> tuple[float, float]:
    """Where a bar begins and ends, as shares of the input's range."""
    low, high = float(table.low[i]), float(table.high[i])
    lower, upper = float(table.lower[rule, i]), float(table.upper[rule, i])
    if names.inputs[i].values:  # each value has an equal part of the line
        lower, upper = np.ceil(lower), np.ceil(upper) if upper < high else high + 1.0
        high += 1.0
    return (lower - low) / (high - low), (upper - low) / (high - low)


def _text_room(text: str) -> float:
    return text_width(text, TINY) + 0.06


def _draw_bar(
    axes: Axes, sheet: _Sheet, of: tuple[int, int], corner: tuple[float, float], color: str
) -> None:
    """What a rule asks of an input: a bar on a line that is its range, and its bounds."""
    (rule, i), (left, top) = of, corner
    room = BAR * sheet.column
    begin, end = (left + room * at for at in _span(sheet.table, sheet.names, rule, i))
    middle = top + 0.5 * ROW
    axes.plot([left, left + room], [middle] * 2, color=sheet.palette.slow, linewidth=1.0, zorder=1)
    size = max(end - begin, 0.012)
    axes.add_patch(
        Rectangle((begin, top + 0.2 * ROW), size, 0.6 * ROW, color=color, lw=0, zorder=2)
    )
    text = _bounds(sheet.table, sheet.names, rule, i)
    wide = _text_room(text)
    paper = sheet.palette.paper
    look: Look = {"fontsize": TINY, "va": "center_baseline", "ha": "center", "zorder": 3}
    beside = left + sheet.column - INDENT - end  # up to the next column
    if max(begin - left, beside) >= wide or size < wide:
        is_left = begin - left >= beside
        at = begin - wide / 2.0 if is_left else end + wide / 2.0
        box = {"facecolor": paper, "edgecolor": "none", "pad": 0.6}
        axes.text(at, middle, text, color=sheet.palette.ink, bbox=box, **look)
    else:
        axes.text((begin + end) / 2.0, middle, text, color=paper, **look)


def _bounds(table: RuleTable, names: Names, rule: int, i: int) -> str:
    """The bounds of a bar as text: `< 0.5`, `≥ 0.25`, `0.25 to 0.5`; or the values."""
    each = names.inputs[i]
    lower, upper = float(table.lower[rule, i]), float(table.upper[rule, i])
    if each.values:
        return " or ".join(allowed_values(each, lower, upper, float(table.high[i])))
    (least, is_open), (most, is_closed) = bound_text(lower), bound_text(upper)
    if lower <= table.low[i]:
        return f"{'≤' if is_closed else '<'} {most}"
    if upper >= table.high[i]:
        return f"{'>' if is_open else '≥'} {least}"
    return f"{least} to {most}"
