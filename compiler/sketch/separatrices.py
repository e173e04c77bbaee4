"""Separatrices as they were drawn, in the frame: which way they advance, where the saddle is."""

from typing import Final

import numpy as np

from compiler.sketch.design import Ridge
from compiler.sketch.drawing import Drawing, Line, Pair
from compiler.sketch.frame import SAME, Frame, SketchRefusedError, spelled
from compiler.sketch.graphs import graph_through
from compiler.sketch.moving import refuse_moving
from compiler.sketch.polygons import distance_to_line
from runtime.arrays import Array
from spec_schema.expressions.evaluate import evaluate

BESIDE: Final = 0.05
"""Half widths of the frame: a saddle that is farther off its line is not on it."""


def ridge_of(line: Line, drawing: Drawing, frame: Frame) -> Ridge:
    """The separatrix in its frame.

    Raises:
        SketchRefusedError: it turns back or changes its shape, or its saddle is not on it.
    """
    for i, pair in enumerate(line.through):
        what = f"this place of '{line.name}'"
        refuse_moving(what, pair, (*line.path, "through", i), drawing, frame)
    through = np.stack([frame.spot(pair).at for pair in line.through])
    if not np.all(np.diff(through @ (through[-1] - through[0])) > 0.0):
        message = f"'{line.name}' turns back on its way from its first point to its last"
        remedy = "let its points advance from one end to the other"
        raise SketchRefusedError("S265", line.path, message, remedy)
    if line.saddle is None:
        saddle = _on_polyline(through, (through[0] + through[-1]) / 2)
        return Ridge(line, through, saddle)
    refuse_moving(
        f"the saddle of '{line.name}'", line.saddle, (*line.path, "saddle"), drawing, frame
    )
    saddle = _saddle_on(line, line.saddle, through, frame)
    return Ridge(line, through, _on_polyline(through, saddle))


def _saddle_on(line: Line, drawn: Pair, through: Array, frame: Frame) -> Array:
    """The saddle that was drawn on a line; refused where it is not on it."""
    spot, path = frame.spot(drawn), (*line.path, "saddle")
    near = graph_through(through).nearest(_on_polyline(through, spot.at))
    off = min(float(np.linalg.norm(spot.at - near)), distance_to_line(through, spot.at))
    if off > BESIDE:
        there = ", ".join(spelled(frame.place(near), frame))
        message = f"the saddle of '{line.name}' is {_apart(spot.at, near, frame)} off its line"
        remedy = f"write `saddle: [{there}]`, or lead the line through it with `through`"
        if frame.moving:
            remedy += " (numbers are for the controls' defaults)"
        raise SketchRefusedError("S265", path, message, remedy)
    return spot.at


def _apart(one: Array, other: Array, frame: Frame) -> str:
    """How far two places are apart at the controls' defaults, along each axis."""
    widths = [evaluate(half, frame.samples[0]) for half in frame.half]
    found = [
        f"{abs(gap * width) / unit.scale:.3g}{'' if unit.text == '1' else ' ' + unit.text}"
        f" along '{name}'"
        for name, unit, gap, width in zip(frame.over, frame.units, other - one, widths, strict=True)
        if abs(gap) > SAME
    ]
    return " and ".join(found)


def _on_polyline(through: Array, saddle: Array) -> Array:
    """The place of the polyline that is right beside the saddle: near that on the curve."""
    chord = (through[-1] - through[0]) / np.linalg.norm(through[-1] - through[0])
    s = (through - through[0]) @ chord
    at = float((saddle - through[0]) @ chord)
    found = [np.interp(at, s, through[:, axis]) for axis in (0, 1)]
    return np.array(found)
