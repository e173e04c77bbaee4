"""The frame of a sketch: coordinates q = (z - middle) / half in which its features stand still.

A sketch whose places are expressions of controls moves and stretches with them. Its bounding box
does, too, so that most features have the same q whatever the controls: they cost no axis of a
table. Where the frame moves, tables stand over u = q / sqrt(16 + q**2), which stays within (-1, 1).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np

from compiler.declare import Declarations
from compiler.sketch.algebra import minus, over, plus, scaled, with_constants
from compiler.sketch.drawing import Drawing, Pair
from compiler.sketch.witness import at_setting
from runtime.arrays import Array
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.printers.text import to_text
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr, Number
from spec_schema.places import Path
from spec_schema.units import Unit

BEND: Final = 4.0
"""So many half widths of the frame away, u begins to draw the plane together."""
SAMPLES: Final = 24
SEED: Final = 3_201
SAME: Final = 1e-9
"""Normalised places that differ by less are the same."""
NARROW: Final = 0.1
"""A frame that stands still is at least so wide, in widths of the domain."""
WIDE: Final = 6.0
"""Beyond so many half widths a domain is drawn together by u, controls or not."""


class SketchRefusedError(Exception):
    """A sketch that can't become a field: what to tell of it, and where."""

    def __init__(self, code: str, path: Path, message: str, remedy: str) -> None:
        self.code, self.path, self.message, self.remedy = code, path, message, remedy
        super().__init__(message)


@final
@dataclass(frozen=True, eq=False, slots=True)
class Spot:
    """A place in the frame. at: (2,) at the controls' defaults.

    exprs: its coordinates; controls: those that it moves with in the frame, usually none.
    """

    exprs: Pair
    controls: tuple[str, ...]
    at: Array


@final
@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """middle, half: expressions of controls; moving: whether a control is in them.

    reach: (2, 2) lowest and highest q of each axis over the domains. box: what the controls may
    be; units: those that the user writes on each axis; constants: numbers for their names;
    samples: settings of the controls, the defaults first.
    """

    over: tuple[str, str]
    middle: Pair
    half: Pair
    reach: Array
    moving: bool
    box: Mapping[str, tuple[float, float]]
    constants: Mapping[str, Expr]
    samples: tuple[Mapping[str, float], ...]
    units: tuple[Unit, Unit]

    @property
    def bends(self) -> bool:
        """Whether tables stand over u instead of the states."""
        return self.moving or bool(np.any(np.abs(self.reach) > WIDE))

    def spot(self, place: Pair) -> Spot:
        """A place of the plane in the frame."""
        return self._spot((self.inside(place[0], 0), self.inside(place[1], 1)))

    def vector(self, direction: Pair) -> Spot:
        """A vector of the plane in the frame."""
        first, second = (
            over(with_constants(d, self.constants), h)
            for d, h in zip(direction, self.half, strict=True)
        )
        return self._spot((first, second))

    def place(self, q: Array) -> Pair:
        """The place of the plane that is at q (2,) in the frame."""
        first, second = (
            plus(m, scaled(float(value), h))
            for m, h, value in zip(self.middle, self.half, q, strict=True)
        )
        return first, second

    def inside(self, expr: Expr, axis: int) -> Expr:
        """A coordinate of the plane in the frame."""
        return over(minus(with_constants(expr, self.constants), self.middle[axis]), self.half[axis])

    def _spot(self, exprs: Pair) -> Spot:
        at = np.array([evaluate(expr, self.samples[0]) for expr in exprs])
        found = {name for expr in exprs for name in self.moves_with(expr)}
        return Spot(exprs, tuple(name for name in self.box if name in found), at)

    def moves_with(self, expr: Expr) -> list[str]:
        """The controls that the value really depends on: (x1 - x2) / (x1 - x2) has none."""
        return [
            name
            for name in sorted(names_in(expr))
            if any(
                abs(evaluate(expr, {**sample, name: value}) - evaluate(expr, sample)) > SAME
                for sample in self.samples[:4]
                for value in (other[name] for other in self.samples[4:8])
            )
        ]


def spelled(place: Pair, frame: Frame) -> tuple[str, str]:
    """A place in the user's units, at the controls' defaults."""
    first, second = (
        f"{evaluate(with_constants(e, frame.constants), frame.samples[0]) / unit.scale:.3g}"
        for e, unit in zip(place, frame.units, strict=True)
    )
    return first, second


def frame_of(drawing: Drawing, declared: Declarations) -> Frame:
    """The frame around everything that a sketch is drawn through.

    Raises:
        SketchRefusedError: the frame collapses for some controls.
    """
    box = {control.name: (control.low, control.high) for control in declared.controls}
    constants: dict[str, Expr] = {c.name: Number(c.value) for c in declared.constants}
    samples = _samples(declared)
    limits = [
        _axis(drawing, axis, constants, box, samples, declared) for axis in range(len(drawing.over))
    ]
    middle, half = (
        (limits[0][0], limits[1][0]),
        _like(drawing, declared, limits[0][1], limits[1][1]),
    )
    reach = [
        _reach(declared, name, m, h, box)
        for name, m, h in zip(drawing.over, middle, half, strict=True)
    ]
    first, second = (declared.units[name] for name in drawing.over)
    units = (first, second)
    moving = any(names_in(expr) for expr in (*middle, *half))
    return Frame(
        drawing.over, middle, half, np.array(reach), moving, box, constants, samples, units
    )


def _samples(declared: Declarations) -> tuple[Mapping[str, float], ...]:
    rng = np.random.default_rng(SEED)
    defaults = {control.name: control.default for control in declared.controls}
    return (
        defaults,
        *(
            {c.name: float(rng.uniform(c.low, c.high)) for c in declared.controls}
            for _ in range(SAMPLES)
        ),
    )


def _axis(
    drawing: Drawing,
    axis: int,
    constants: Mapping[str, Expr],
    box: Mapping[str, tuple[float, float]],
    samples: Sequence[Mapping[str, float]],
    declared: Declarations,
) -> tuple[Expr, Expr]:
    """The middle and the half width of the frame along one axis."""
    spots = [(path, with_constants(pair[axis], constants)) for path, pair in drawing.spots]
    values = np.array([[evaluate(expr, sample) for _, expr in spots] for sample in samples])
    state = declared.variable(drawing.over[axis])
    if not np.isfinite(values).all():
        k = int(np.argmin(np.isfinite(values).all(axis=0)))
        bad = samples[int(np.argmin(np.isfinite(values[:, k])))]
        message = f"this place is not finite{at_setting([spots[k][1]], bad, declared)}"
        raise SketchRefusedError("S264", spots[k][0], message, "shrink the domain of a control")
    if np.ptp(values, axis=1).max() < SAME * (state.high - state.low):
        return spots[0][1], Number((state.high - state.low) / 4)
    low, high = int(values[0].argmin()), int(values[0].argmax())
    half = scaled(0.5, minus(spots[high][1], spots[low][1]))
    corners = [dict(zip(box, ends, strict=True)) for ends in product(*box.values())]
    narrowest = min((*samples, *corners), key=lambda setting: evaluate(half, setting))
    least = SAME * (state.high - state.low)
    if not bounds(half, box)[0] > 0.0 and evaluate(half, narrowest) <= least:
        ends = [drawing.spots[k][1][axis] for k in (low, high)]
        message = (
            f"the sketch has no width along '{state.name}'"
            f"{at_setting(ends, narrowest, declared)}: its lowest and its highest place, "
            f"{' and '.join(to_text(end) for end in ends)}, meet or change places there"
        )
        remedy = "shrink the domain of a control, so that they never meet"
        raise SketchRefusedError("S264", spots[high][0], message, remedy)
    return scaled(0.5, plus(spots[high][1], spots[low][1])), half


def _like(drawing: Drawing, declared: Declarations, first: Expr, second: Expr) -> Pair:
    """Widths that stand still are not too narrow, and the same on axes with like units."""
    found = []
    for name, half in zip(drawing.over, (first, second), strict=True):
        state = declared.variable(name)
        least = (state.high - state.low) * NARROW
        found.append(Number(max(half.value, least)) if isinstance(half, Number) else half)
    one, two = found
    units = [declared.units[name].dimension for name in drawing.over]
    if isinstance(one, Number) and isinstance(two, Number) and units[0] == units[1]:
        widest = Number(max(one.value, two.value))
        return widest, widest
    return one, two


def _reach(
    declared: Declarations,
    name: str,
    middle: Expr,
    half: Expr,
    box: Mapping[str, tuple[float, float]],
) -> tuple[float, float]:
    """The lowest and the highest q that the state reaches for any controls."""
    state = declared.variable(name)
    ends = [bounds(over(minus(Number(end), middle), half), box) for end in (state.low, state.high)]
    return min(low for low, _ in ends), max(high for _, high in ends)
