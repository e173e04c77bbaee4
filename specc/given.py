"""Values that a user gives on the way: `x=1`, `speed="40 cm/s"`; in SI, inside their domains."""

import re
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from runtime.program import Control, Kind, State
from spec_schema.diagnostics import Diagnostic, SpecError
from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.rewrite import names_in
from spec_schema.faults import ExpressionError, UnitFault
from spec_schema.suggest import did_you_mean, there_are
from spec_schema.units import Unit, parse_unit, quantity_in
from specc.faults import fault, mistake

Value: TypeAlias = float | str
Part: TypeAlias = State | Control


def settings_for(
    parts: Sequence[Part],
    given: Mapping[str, Value],
    what: str,
    elsewhere: Mapping[str, str] | None = None,
) -> dict[str, float]:
    """SI values of `given`, each of one of the `parts`.

    elsewhere: names that belong to another option, with what to write instead.

    Raises:
        SpecError: with every name that is no `what`, and every value that can't be used.
    """
    known = {part.name: part for part in parts}
    found: dict[str, float] = {}
    problems: list[Diagnostic] = []
    for name, value in given.items():
        if name not in known:
            remedy = (elsewhere or {}).get(name) or did_you_mean(name, list(known))
            remedy = remedy or there_are(list(known))
            message = f"no {what} is named '{name}'"
            problems.append(mistake("V341", f"{name}={value}", message, remedy))
            continue
        try:
            found[name] = _inside(known[name], value)
        except ValueError as error:
            problems.append(mistake("V342", f"{name}={value}", str(error), _example(known[name])))
    if problems:
        raise SpecError(problems)
    return found


def seconds(value: Value, name: str = "duration") -> float:
    """A duration, called `name` in messages: a number of seconds, or a quantity of time.

    Raises:
        SpecError: it is none, or not positive.
    """
    named = f"{name}={value}"
    try:
        found = _si(value, parse_unit("s"))
    except ValueError as error:
        raise fault("V342", named, str(error), "write 20, '20 s' or '2 min'") from error
    if not 0.0 < found < float("inf"):
        raise fault("V342", named, "it must be positive", "write 0.1 s, 20 s or 2 min")
    return found


def instant(text: str) -> float:
    """A time of a recording in seconds: `12.3`, `12.3s`, `2 min`; it may be 0 or below.

    Raises:
        SpecError: it is none (V342).
    """
    spaced = re.sub(r"(?<=[\d.])(?=[A-Za-z]+$)", " ", text.strip())
    try:
        return _si(spaced, parse_unit("s"))
    except ValueError as error:
        raise fault("V342", f"time {text}", str(error), "write 12.3, 12.3s or '2 min'") from error


def _inside(part: Part, value: Value) -> float:
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        if value not in part.values:
            raise ValueError(f"'{part.name}' has no value '{value}'")
        return float(part.values.index(str(value)))
    found = _si(value, parse_unit(part.unit.text))
    periodic = isinstance(part, State) and part.kind is Kind.PERIODIC
    if not periodic and not part.low <= found <= part.high:
        low, high = part.low / part.unit.scale, part.high / part.unit.scale
        raise ValueError(f"{value} is outside the domain [{low:g}, {high:g}]{_suffix(part)}")
    return found


def _si(value: Value, unit: Unit) -> float:
    if not isinstance(value, str):
        return float(value) * unit.scale
    try:
        expr = parse(value)
        if not names_in(expr):
            return evaluate(expr, {}) * unit.scale
    except ExpressionError:
        pass
    try:
        return quantity_in(value, unit)
    except UnitFault as error:
        raise ValueError(error.fault.message) from error


def _example(part: Part) -> str:
    if isinstance(part, State) and part.kind is Kind.DISCRETE:
        return f"its values: {', '.join(part.values)}"
    kind = "a plain number" if part.unit.text == "1" else f"a number in {part.unit.text}"
    return f"write {kind}, such as {part.name}={part.high / part.unit.scale:g}"


def _suffix(part: Part) -> str:
    return "" if part.unit.text == "1" else f" {part.unit.text}"
