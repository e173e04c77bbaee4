"""The wiring of an architecture as a picture (figures 3.2 and 3.3 of the thesis).

Levels are floors: base behaviors at the bottom above the body's channels, control modules above.
What a colour says of a wire its dashes say too.
"""

from typing import Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch, Rectangle

from specc.figures.legend import Look, line_entry
from specc.figures.palettes import PALETTES, Palette
from specc.figures.paper import axes_at, new_figure
from specc.figures.style import look
from specc.figures.style_names import Style
from specc.figures.wiring_layout import plan_of
from specc.figures.wiring_plan import (
    CHANNEL,
    NAMED,
    ROW,
    SENSOR,
    SMALL,
    TINY,
    Frame,
    Plan,
    claim_text,
    how_resolved,
    unread_text,
)
from specc.wired import ACTS, Box, Eye, Mouth, Port, Sort, Wired

EDGE: Final = 0.15
HEAD: Final = 0.62
FOOT: Final = 0.45
SIDE: Final = 0.42
RIM: Final = 0.03
"""Inches that edges may stick out."""
STUB: Final = 0.13

SAID: Final = {
    Sort.READING: "a sensor's reading",
    Sort.OUTPUT: "an output",
    Sort.CHOICE: "a choice: acts, and sets",
    Sort.COMMAND: "a command",
}


def draw_wiring(wired: Wired, style: Style = Style.SCREEN) -> Figure:
    """The picture of an architecture."""
    palette = PALETTES[style]
    with look(palette):
        plan = plan_of(wired)
        size = (plan.width, plan.height)
        height = size[1] + HEAD + FOOT
        figure = new_figure(max(size[0] + SIDE, 6.5) + 2 * EDGE, height, palette)
        axes = axes_at(figure, (EDGE - RIM, FOOT - RIM), (size[0] + 2 * RIM, size[1] + 2 * RIM))
        axes.set_xlim(-RIM, size[0] + RIM)
        axes.set_ylim(-RIM, size[1] + RIM)
        axes.set_axis_off()
        _floors(axes, plan, wired, palette)
        _wires(axes, plan, wired, palette)
        free = _stubs(axes, plan, wired, palette)
        for box in wired.boxes:
            _box(axes, plan, box, palette)
        for mouth in wired.mouths:
            _mouth(axes, plan, mouth, palette)
        for eye in wired.eyes:
            _eye(axes, plan, eye, palette)
        _words(figure, wired, free, palette)
    return figure


def line_of(sort: Sort, palette: Palette) -> Look:
    """How wires of a sort are drawn."""
    match sort:
        case Sort.READING:
            return {"color": palette.nullcline, "linewidth": 0.9, "linestyle": "-"}
        case Sort.OUTPUT:
            return {"color": palette.stable, "linewidth": 1.0, "linestyle": (0, (1.2, 1.2))}
        case Sort.CHOICE:
            return {"color": palette.cycle, "linewidth": 1.0, "linestyle": (0, (5, 1.6))}
        case Sort.COMMAND:
            return {"color": palette.ink, "linewidth": 1.4, "linestyle": "-"}


def _floors(axes: Axes, plan: Plan, wired: Wired, palette: Palette) -> None:
    """The levels' grounds, with their names at the right, upright."""
    for level, frame in enumerate(plan.floors):
        tint = palette.tints[level % len(palette.tints)]
        axes.add_patch(
            Rectangle((frame.x, frame.y), frame.width, frame.height, color=tint, zorder=0, lw=0)
        )
        name = "base behaviors" if level == 0 else f"modules, level {level}"
        text = f"{name}\n{_counted(wired, level)}"
        _upright(axes, plan.width, frame.y + 0.5 * frame.height, text, palette)
    if plan.mouths:
        high = next(iter(plan.mouths.values())).height
        _upright(axes, plan.width, 0.5 * high, f"body {wired.body}", palette)


def _counted(wired: Wired, level: int) -> str:
    """How many controls a level offers: each further level should have fewer (thesis, 3.2.3)."""
    boxes = (box for box in wired.boxes if box.level == level)
    count = sum(port.name != ACTS for box in boxes for port in box.controls)
    return "1 control" if count == 1 else f"{count or 'no'} controls"


def _upright(axes: Axes, x: float, y: float, text: str, palette: Palette) -> None:
    axes.text(
        x + 0.06, y, text, rotation=90, ha="left", va="center", fontsize=SMALL + 0.5,
        multialignment="center", linespacing=1.4,
        color=palette.faint, clip_on=False,
    )  # fmt: skip


def _wires(axes: Axes, plan: Plan, wired: Wired, palette: Palette) -> None:
    """Lanes, uprights, trunks, dots where they join, arrows where they end."""
    first = {}
    for trunk in plan.trunks:
        net = wired.nets[trunk.net]
        drawn = line_of(net.sort, palette)
        axes.plot([trunk.x, trunk.x], [trunk.low, trunk.high], **drawn, zorder=1)
        if trunk.start is not None:
            axes.plot([trunk.start[0], trunk.x], [trunk.start[1]] * 2, **drawn, zorder=1)
            first[trunk.net] = trunk.x
    for run in plan.runs:
        net = wired.nets[run.net]
        drawn = line_of(net.sort, palette)
        axes.plot([run.left, run.right], [run.y, run.y], **drawn, zorder=1)
        for x, y in run.joins:
            axes.plot([x, x], [run.y, y], **drawn, zorder=1)
            if run.left < x < run.right:
                axes.plot(x, run.y, "o", ms=2.6, color=drawn["color"], zorder=2)
        for x, y in run.arrows:
            marker = "^" if y > run.y else "v"
            back = -0.03 if y > run.y else 0.03
            axes.plot(x, y + back, marker, ms=4.6, color=drawn["color"], zorder=3, mew=0)
        if run.net in first:
            name = ".".join(net.source)
            axes.text(
                plan.floors[0].x - 0.08, run.y, name, fontsize=TINY, ha="right", va="center",
                color=drawn["color"], zorder=2,
                bbox={"facecolor": palette.paper, "edgecolor": "none", "pad": 0.6},
            )  # fmt: skip


def _stubs(axes: Axes, plan: Plan, wired: Wired, palette: Palette) -> set[str]:
    """Ends of control interfaces that nobody uses: controls wait, outputs are not read.

    Returns:
        The markers that were drawn: `v` of controls, `^` of outputs.
    """
    used = {place for run in plan.runs for place in run.joins}
    drawn = set()
    for (name, side, port), (x, y) in plan.ports.items():
        box = next((box for box in wired.boxes if box.name == name), None)
        if box is None or (x, y) in used or side != "above" or port == ACTS:
            continue
        is_output = port in {one.name for one in box.outputs}
        if is_output and port in {one.note.lstrip("−") for one in box.tells}:
            continue  # it is read by no node, but drives a channel
        color = palette.stable if is_output else palette.cycle
        axes.plot([x, x], [y, y + STUB], color=color, lw=0.9, zorder=1)
        marker, at = ("^", y + STUB) if is_output else ("v", y + 0.03)
        axes.plot(x, at, marker, ms=4.2, mec=color, mfc=palette.paper, mew=0.8, zorder=3)
        drawn.add(marker)
    return drawn


def _box(axes: Axes, plan: Plan, box: Box, palette: Palette) -> None:
    frame = plan.boxes[box.name]
    _rounded(axes, frame, palette, palette.ink, 1.0)
    middle = frame.x + 0.5 * frame.width
    spread = 0.5 * (frame.height - ROW * (3 + len(box.notes)))
    top = frame.y + frame.height - spread
    axes.text(
        middle, top, box.name, ha="center", va="top", fontsize=NAMED, fontweight="bold", zorder=5
    )
    lines = "\n".join((box.what, box.clock, *box.notes))
    small: Look = {"ha": "center", "va": "top", "fontsize": SMALL, "color": palette.faint}
    axes.text(middle, top - 1.2 * ROW, lines, linespacing=1.25, zorder=5, **small)
    _ports(axes, plan, box.name, "above", (*box.controls, *box.outputs), palette)
    _ports(axes, plan, box.name, "below", (*box.senses, *box.tells), palette)


def _ports(
    axes: Axes, plan: Plan, box: str, side: str, ports: tuple[Port, ...], palette: Palette
) -> None:
    """Names at the edge of a box, with what is noted of them in small."""
    for port in ports:
        x, y = plan.ports[box, side, port.name]
        inward = -1.0 if side == "above" else 1.0
        va = "top" if side == "above" else "bottom"
        axes.text(x, y + inward * 0.05, port.name, ha="center", va=va, fontsize=SMALL, zorder=5)
        if port.note:
            axes.text(
                x, y + inward * (0.05 + 0.95 * ROW), port.note, ha="center", va=va, fontsize=TINY,
                color=palette.faint, zorder=5,
            )  # fmt: skip


def _mouth(axes: Axes, plan: Plan, mouth: Mouth, palette: Palette) -> None:
    """A channel; where several nodes reach it, a thick edge and how the conflict is resolved."""
    frame = plan.mouths[mouth.name]
    color = palette.switch if mouth.is_contested else palette.ink
    _rounded(axes, frame, palette, color, 1.8 if mouth.is_contested else 1.0)
    middle = frame.x + 0.5 * frame.width
    axes.text(
        middle, frame.y + 3.1 * ROW, mouth.name, ha="center", va="top", fontsize=CHANNEL,
        fontweight="bold", zorder=5,
    )  # fmt: skip
    axes.text(
        middle, frame.y + 2.0 * ROW, how_resolved(mouth), ha="center", va="top", fontsize=SMALL,
        color=color, zorder=5,
    )  # fmt: skip
    axes.text(
        middle, frame.y + 1.05 * ROW, f"at rest: {mouth.rest}", ha="center", va="top",
        fontsize=TINY, color=palette.faint, zorder=5,
    )  # fmt: skip
    for port in mouth.claims:
        x, y = plan.ports[mouth.name, "above", port.name]
        axes.text(x, y - 0.05, claim_text(port), ha="center", va="top", fontsize=SMALL, zorder=5)


def _eye(axes: Axes, plan: Plan, eye: Eye, palette: Palette) -> None:
    """A sensor; faint and in one line where nobody reads it."""
    frame = plan.eyes[eye.name]
    x, top = frame.x + 0.08, frame.y + frame.height - 0.06
    right = frame.x + frame.width - 0.06
    name: Look = {"fontsize": SENSOR, "fontweight": "bold", "zorder": 5}
    small: Look = {"fontsize": TINY, "color": palette.faint, "zorder": 5}
    if not eye.readings:
        _rounded(axes, frame, palette, palette.faint, 0.5)
        middle = frame.y + 0.5 * frame.height
        axes.text(x, middle, eye.name, va="center", color=palette.faint, **name)
        axes.text(right, middle, unread_text(eye), ha="right", va="center", **small)
        return
    _rounded(axes, frame, palette, palette.nullcline, 1.0)
    axes.text(x, top, eye.name, va="top", **name)
    lines = f"{eye.what}\n{eye.clock}"
    axes.text(x, top - 1.15 * ROW, lines, va="top", linespacing=1.2, **small)
    for reading in eye.readings:
        y = plan.exits[eye.name, reading][1]
        axes.text(right, y, reading, ha="right", va="center", fontsize=SMALL, zorder=5)


def _rounded(axes: Axes, frame: Frame, palette: Palette, color: str, width: float) -> None:
    axes.add_patch(
        FancyBboxPatch(
            (frame.x, frame.y),
            frame.width,
            frame.height,
            boxstyle="round,pad=0,rounding_size=0.06",
            facecolor=palette.paper,
            edgecolor=color,
            linewidth=width,
            zorder=4,
        )
    )


def _words(figure: Figure, wired: Wired, free: set[str], palette: Palette) -> None:
    """The title, what it does, and what lines mean; free: the markers of what nobody uses."""
    width, height = figure.get_size_inches()
    x = EDGE / width
    figure.text(x, 1.0 - 0.08 / height, wired.name, fontsize=12.5, fontweight="bold", va="top")
    figure.text(x, 1.0 - 0.33 / height, wired.about, fontsize=8.5, color=palette.faint, va="top")
    present = {net.sort for net in wired.nets}
    entries = [line_entry(SAID[sort], **line_of(sort, palette)) for sort in Sort if sort in present]
    hollow: Look = {"linestyle": "None", "ms": 4.2, "mfc": palette.paper}
    if "v" in free:
        entries.append(line_entry("control, at its value", marker="v", mec=palette.cycle, **hollow))
    if "^" in free:
        entries.append(line_entry("output, unread", marker="^", mec=palette.stable, **hollow))
    figure.legend(
        handles=[entry.handles[0] for entry in entries],
        labels=[entry.label for entry in entries],
        loc="lower left",
        bbox_to_anchor=(x, 0.06 / height),
        borderaxespad=0.0,
        ncols=len(entries),
        fontsize=SMALL,
        columnspacing=1.2,
    )
