"""Pass 5 of a sketch: its field as columns of one table, over coordinates that move with it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Final, final

import numpy as np

from compiler.declare import Declarations
from compiler.lower_parts import code_of
from compiler.plan import Plan, Sheet, Use
from compiler.sketch.algebra import minus, over, split, times
from compiler.sketch.fill import Filled
from compiler.sketch.frame import BEND, Frame, SketchRefusedError
from compiler.tabulate import Sampler
from runtime.arrays import Array
from runtime.program import Coordinate
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Apply, Expr, Name, Number
from spec_schema.places import Path

SLACK: Final = 1e-9
"""By so much a table reaches beyond the values of its coordinate, for the rounding of both."""
SKETCH: Final[Path] = ("field", "sketch")
MOST_AXES: Final = 5
PARTS: Final = 4
"""Into how many parts a control's domain is cut to bound a coefficient."""


@final
@dataclass(frozen=True, slots=True)
class _Column:
    """What one column adds up: a number times component j of part b, for each."""

    component: int
    coefficient: Expr
    parts: tuple[tuple[int, float], ...]


def plan_sketch(filled: Filled, declared: Declarations, origin: str) -> Plan:
    """The sheet of a filled sketch, and its coordinates.

    Raises:
        SketchRefusedError: too many controls move features within the sketch, or a coefficient is
            not finite all over the controls' domains.
    """
    frame = filled.frame
    _refuse_axes(filled)
    columns = _columns(filled)
    driven = [state.name for state in declared.driven]
    uses = tuple(
        Use(
            driven.index(frame.over[column.component]),
            code_of(column.coefficient),
            i,
            _largest(column.coefficient, frame),
        )
        for i, column in enumerate(columns)
    )
    coordinates = _coordinates(frame, declared, origin) if frame.bends else ()
    plane = tuple(c.name for c in coordinates) or frame.over
    sample = _sampler(filled, columns)
    sheet = Sheet((*plane, *filled.controls), len(columns), sample, uses)
    return Plan((sheet,), (), coordinates)


def _refuse_axes(filled: Filled) -> None:
    if len(filled.controls) + 2 > MOST_AXES:
        names = ", ".join(filled.controls)
        raise SketchRefusedError(
            "S265",
            SKETCH,
            f"{len(filled.controls)} controls ({names}) move features against the rest of the "
            f"sketch, and a table has at most {MOST_AXES} axes",
            "let features move together: place them at fixed shares between the outermost ones",
        )


def _columns(filled: Filled) -> tuple[_Column, ...]:
    """Parts with the same coefficient, up to a number, share a column."""
    found: dict[tuple[int, Expr], list[tuple[int, float]]] = {}
    for b, coefficient in enumerate(filled.coefficients):
        for j, half in enumerate(filled.frame.half):
            number, rest = split(times(coefficient, half))
            if number != 0.0:
                found.setdefault((j, rest), []).append((b, number))
    return tuple(_Column(j, rest, tuple(parts)) for (j, rest), parts in found.items())


def _largest(coefficient: Expr, frame: Frame) -> float:
    reads = [name for name in frame.box if name in names_in(coefficient)]
    pieces = product(*(_halves(*frame.box[name]) for name in reads))
    limits = [bounds(coefficient, dict(zip(reads, piece, strict=True))) for piece in pieces]
    largest = max(max(abs(low), abs(high)) for low, high in limits)
    if not math.isfinite(largest):
        values = [abs(evaluate(coefficient, sample)) for sample in frame.samples]
        if not np.isfinite(values).all():
            message = "a rate of the sketch is not finite all over the controls' domains"
            raise SketchRefusedError("S264", SKETCH, message, "shrink the domain of a control")
        largest = 2.0 * max(values)
    return largest


def _halves(low: float, high: float) -> tuple[tuple[float, float], ...]:
    """An interval in parts, on which bounds are sharper."""
    ends = [low + (high - low) * i / PARTS for i in range(PARTS + 1)]
    return tuple(pairwise(ends))


def _sampler(filled: Filled, columns: tuple[_Column, ...]) -> Sampler:
    frame, count = filled.frame, len(filled.coefficients)
    mix = np.zeros((count, 2, len(columns)))
    for k, column in enumerate(columns):
        for b, number in column.parts:
            mix[b, column.component, k] += number
    flat = mix.reshape(2 * count, len(columns))
    middle, half = (
        np.array([evaluate(expr, frame.samples[0]) for expr in pair])
        for pair in (frame.middle, frame.half)
    )

    def sample(points: Array) -> Array:
        plane = points[:, :2]
        q = _straightened(plane) if frame.bends else (plane - middle) / half
        settings: Mapping[str, Array] = {
            name: points[:, 2 + i] for i, name in enumerate(filled.controls)
        }
        found: Array = filled.vectors(q, settings).reshape(len(q), -1) @ flat
        return found

    return sample


def _straightened(u: Array) -> Array:
    """Coordinates q of u = q / sqrt(16 + q**2)."""
    inner = np.clip(u, SLACK - 1.0, 1.0 - SLACK)
    found: Array = BEND * inner / np.sqrt(1.0 - inner**2)
    return found


def _coordinates(frame: Frame, declared: Declarations, origin: str) -> tuple[Coordinate, ...]:
    """The coordinates u = q / sqrt(16 + q**2) for each axis of the plane."""
    taken = set(declared.register)
    found = []
    for axis, state in enumerate(frame.over):
        name = f"{state}_in_sketch"
        while name in taken:
            name += "_"
        taken.add(name)
        q = over(minus(Name(state), frame.middle[axis]), frame.half[axis])
        root = Apply("sqrt", (Apply("add", (Number(BEND**2), Apply("mul", (q, q)))),))
        ends = (_bent(float(frame.reach[axis, side])) for side in (0, 1))
        low, high = next(ends) - SLACK, next(ends) + SLACK
        found.append(Coordinate(name, code_of(Apply("div", (q, root))), low, high, origin))
    return tuple(found)


def _bent(q: float) -> float:
    return math.copysign(1.0, q) if math.isinf(q) else q / math.hypot(BEND, q)
