"""Pass 2 of a sketch: its numbers, quantities and expressions, checked for their dimensions."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, final

from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.quantities import SECOND, like, per_second
from compiler.scope import Scope, checked
from compiler.sketch.drawing import Arrow, Drawing, Line, Orbit, Pair, Point
from runtime.program import Kind, Role, State
from spec_schema.dimension import Dimension
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import names_in
from spec_schema.expressions.tree import Expr, Number
from spec_schema.faults import ExpressionError, UnitFault
from spec_schema.field_sketch import (
    Sketch,
    SketchedOrbit,
    SketchedPoint,
    SketchedSeparatrix,
)
from spec_schema.places import Path
from spec_schema.units import Unit, quantity_in

BASE: Final[Path] = ("field", "sketch")
PER_SECOND: Final = Unit("1/s", 1.0, (Fraction(0), Fraction(0), Fraction(-1), *(Fraction(0),) * 4))
NOTHING: Final = Number(0.0)


@final
@dataclass(frozen=True, slots=True)
class Reader:
    """What the numbers of a sketch are read with. plane: the two states that it is drawn over."""

    plane: tuple[State, State]
    units: tuple[Unit, Unit]
    scope: Scope
    findings: Findings

    def number(self, value: float | str, unit: Unit, path: Path, what: str) -> Expr:
        """A number in `unit`, a quantity, or an expression of controls and constants; in SI.

        0, and a finding, where it can't be read.
        """
        if not isinstance(value, str):
            return Number(value * unit.scale)
        try:
            expr = parse(value)
        except ExpressionError:
            return self._quantity(value, unit, path, what)
        if not names_in(expr):
            return Number(evaluate(expr, {}) * unit.scale)
        return checked(value, path, self.scope, unit, what, self.findings) or NOTHING

    def _quantity(self, value: str, unit: Unit, path: Path, what: str) -> Expr:
        try:
            return Number(quantity_in(value, unit))
        except UnitFault as error:
            if value.strip()[:1].isdigit() and " " in value.strip():
                self.findings.fault(path, error.fault)
            else:
                checked(value, path, self.scope, unit, what, self.findings)
        return NOTHING

    def pair(self, spot: Sequence[float | str], path: Path, *, rate: bool = False) -> Pair:
        """A place, or with `rate` a vector per second."""
        units = [per_second(unit) if rate else unit for unit in self.units]
        names = [state.name for state in self.plane]
        first, second = (
            self.number(value, unit, (*path, i), f"the {name} of this place")
            for i, (value, unit, name) in enumerate(zip(spot, units, names, strict=True))
        )
        return first, second

    def positive(self, value: float | str, unit: Unit, path: Path, what: str) -> Expr:
        """A number that must be above 0 where it is one; 1 in the place of one that is not."""
        expr = self.number(value, unit, path, what)
        if isinstance(expr, Number) and expr.value <= 0.0:
            if not self.findings.has_errors:
                message = f"{what} must be positive (got {value})"
                self.findings.error(
                    "S212", path, message, f"write a number above 0, in {unit.text}"
                )
            return Number(1.0)
        return expr


def read_sketch(
    sketch: Sketch, declared: Declarations, scope: Scope, findings: Findings
) -> Drawing | None:
    """The drawing; None, and findings, where its plane is none or its numbers can't be read."""
    plane = _plane(sketch, declared, findings)
    if plane is None or any(state.name not in declared.units for state in plane):
        return None
    units = (declared.units[plane[0].name], declared.units[plane[1].name])
    outside = {state.name for state in declared.states}
    known: dict[str, Dimension | None] = {
        name: dimension for name, dimension in scope.dimensions.items() if name not in outside
    }
    before = len(findings.diagnostics)
    reader = Reader(plane, units, Scope(known, {}), findings)
    drawing = Drawing(
        over=(plane[0].name, plane[1].name),
        orbits=tuple(_orbit(o, i, reader) for i, o in enumerate(sketch.orbits)),
        points=tuple(_point(p, i, reader) for i, p in enumerate(sketch.points)),
        lines=tuple(_line(s, i, reader) for i, s in enumerate(sketch.separatrices)),
        arrows=tuple(
            Arrow(
                reader.pair(arrow.at, (*BASE, "arrows", i, "at")),
                reader.pair(arrow.go, (*BASE, "arrows", i, "go"), rate=True),
                (*BASE, "arrows", i),
            )
            for i, arrow in enumerate(sketch.arrows)
        ),
    )
    return drawing if len(findings.diagnostics) == before else None


def _plane(
    sketch: Sketch, declared: Declarations, findings: Findings
) -> tuple[State, State] | None:
    """The two states of the sketch, which must be all that the behavior drives."""
    known = {state.name: state for state in declared.states}
    wrong = False
    for i, name in enumerate(sketch.over):
        state = known.get(name)
        if state is None or state.role is not Role.BOTH or state.kind is not Kind.CONTINUOUS:
            why = (
                "is no state"
                if state is None
                else f"is {state.kind}"
                if state.kind is not Kind.CONTINUOUS
                else f"is only {state.role}"
            )
            findings.error(
                "S263",
                (*BASE, "over", i),
                f"a sketch can't be drawn over '{name}': it {why}",
                "name two continuous states with `role: both`",
            )
            wrong = True
    for state in declared.driven:
        if not wrong and state.name not in sketch.over:
            findings.error(
                "S204",
                BASE,
                f"the field gives no rate for '{state.name}'",
                "a sketch moves the two states that it is drawn over: write `role: sensed`, or "
                "take another form of field",
                key=True,
            )
            wrong = True
    if wrong:
        return None
    return known[sketch.over[0]], known[sketch.over[1]]


def _orbit(orbit: SketchedOrbit, i: int, reader: Reader) -> Orbit:
    path = (*BASE, "orbits", i)
    through = tuple(reader.pair(s, (*path, "through", k)) for k, s in enumerate(orbit.through))
    period = speed = None
    if orbit.period is not None:
        period = reader.positive(orbit.period, SECOND, (*path, "period"), "the period")
    if orbit.speed is not None:
        speed = _speed(orbit.speed, (*path, "speed"), reader)
    return Orbit(
        name=orbit.name or _numbered("orbit", path, reader),
        through=through,
        is_polygon=orbit.shape == "polygon",
        rounding=orbit.rounding,
        attracts=orbit.attracts,
        strength=reader.positive(orbit.strength, PER_SECOND, (*path, "strength"), "the strength"),
        period=period,
        times=tuple(
            reader.positive(t, SECOND, (*path, "times", k), "the time of an edge")
            for k, t in enumerate(orbit.times or ())
        ),
        speed=speed,
        path=path,
    )


def _speed(value: float | str, path: Path, reader: Reader) -> Expr | None:
    first, second = reader.units
    if first.dimension != second.dimension:
        message = f"a speed along the curve means nothing between {like(first)} and {like(second)}"
        reader.findings.error("S261", path, message, "write `period:` or `times:` instead")
        return None
    return reader.positive(value, per_second(first), path, "the speed")


def _point(point: SketchedPoint, i: int, reader: Reader) -> Point:
    path = (*BASE, "points", i)
    several = isinstance(point.rates, tuple)
    rates = tuple(
        reader.positive(
            rate, PER_SECOND, (*path, "rates", k) if several else (*path, "rates"), "a rate"
        )
        for k, rate in enumerate(point.both_rates)
    )
    directions = None
    if point.directions is not None:
        first, second = (
            reader.pair(d, (*path, "directions", k)) for k, d in enumerate(point.directions)
        )
        directions = (first, second)
    turns = None
    if point.turns != 0.0:
        turns = _turning(point.turns, (*path, "turns"), reader)
    at = reader.pair(point.at, (*path, "at"))
    name = point.name or _numbered(point.is_, path, reader)
    return Point(name, point.is_, at, (rates[0], rates[1]), directions, turns, path)


def _turning(value: float | str, path: Path, reader: Reader) -> Expr:
    per_time = Unit("rad/s", 1.0, PER_SECOND.dimension)
    return reader.number(value, per_time, path, "how fast it turns")


def _line(line: SketchedSeparatrix, i: int, reader: Reader) -> Line:
    path = (*BASE, "separatrices", i)
    first, second = (
        reader.positive(rate, PER_SECOND, (*path, "rates", k), "a rate")
        for k, rate in enumerate(line.rates)
    )
    return Line(
        name=line.name or _numbered("separatrix", path, reader),
        through=tuple(reader.pair(s, (*path, "through", k)) for k, s in enumerate(line.through)),
        saddle=None if line.saddle is None else reader.pair(line.saddle, (*path, "saddle")),
        rates=(first, second),
        path=path,
    )


def _numbered(kind: str, path: Path, reader: Reader) -> str:
    """A name for a feature without one: its number in the list as it is written."""
    return f"{kind} {int(reader.findings.written(path)[-1]) + 1}"
