"""Shapes that would change with the controls: which coordinate does not go along, and what would.

The frame moves and stretches with the outermost places of a sketch. What lies at a fixed share
between them goes along; a curve must, while a point may move by itself.
"""

from collections.abc import Sequence

from compiler.sketch.algebra import with_constants
from compiler.sketch.drawing import Drawing, Pair
from compiler.sketch.frame import Frame, SketchRefusedError
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.rewrite import names_in, simplify
from spec_schema.expressions.tree import Apply, Expr, Number
from spec_schema.places import Path


def refuse_moving(what: str, pair: Pair, path: Path, drawing: Drawing, frame: Frame) -> None:
    """Refuse a place of a curve that does not go along with the frame.

    what: the place in words, such as "this vertex of 'fence'".

    Raises:
        SketchRefusedError: with the coordinate that does not, and what would.
    """
    for axis, name in enumerate(frame.over):
        controls = frame.moves_with(frame.inside(pair[axis], axis))
        if controls:
            low, high = _ends(drawing, frame, axis)
            message = (
                f"the '{name}' of {what} does not go along when {_listed(controls)} change"
                f"{'s' if len(controls) == 1 else ''} the sketch's box, which reaches from "
                f"{_text(low, frame, axis)} to {_text(high, frame, axis)}: the shape would change"
            )
            remedy = _remedy(pair[axis], low, high, frame, axis)
            raise SketchRefusedError("S265", path, message, remedy)


def _ends(drawing: Drawing, frame: Frame, axis: int) -> tuple[Expr, Expr]:
    """The lowest and the highest place of a sketch along an axis, as they were written."""
    now = frame.samples[0]
    exprs = [pair[axis] for _, pair in drawing.spots]
    values = [evaluate(with_constants(expr, frame.constants), now) for expr in exprs]
    return exprs[values.index(min(values))], exprs[values.index(max(values))]


def _remedy(expr: Expr, low: Expr, high: Expr, frame: Frame, axis: int) -> str:
    """What would go along: the place at its present share between the ends."""
    now = frame.samples[0]
    at, first, last = (evaluate(with_constants(e, frame.constants), now) for e in (expr, low, high))
    share = (at - first) / (last - first)
    if not names_in(low) and not names_in(high):
        fixed = _text(Number(at), frame, axis)
        return f"write a number, such as {fixed}: the box stands still along '{frame.over[axis]}'"
    if all(names_in(end) or end == Number(0.0) for end in (low, high)):
        return f"place it at a fixed share of the way: `{_at_share(low, high, share)}`"
    return (
        f"place it at a fixed share of the way (now {share:.3g}), with the ends as constants that "
        "have names"
    )


def _at_share(low: Expr, high: Expr, share: float) -> str:
    """`low + share*(high - low)` with at most three digits."""
    part = Apply("mul", (Number(float(f"{share:.3g}")), Apply("sub", (high, low))))
    return to_text(simplify(Apply("add", (low, part))))


def _text(expr: Expr, frame: Frame, axis: int) -> str:
    """A coordinate as it may be written: an expression, or a number in the axis' unit."""
    if names_in(expr):
        return to_text(expr)
    return f"{evaluate(expr, {}) / frame.units[axis].scale:.4g}"


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
