"""Conditions as formulas over comparisons, exact for what the machine computes, nan included.

A comparison of two numbers comes out as one of four relations: less, equal, more, or none (one of
them is nan). An `Atom` says which relations are allowed; the opposite of a condition allows the
others. So `not a < b` is not `a >= b` but `a >= b, or no number`, as it is in the machine.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias, final

from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Number, same

LESS: Final = 1
EQUAL: Final = 2
MORE: Final = 4
NONE: Final = 8
EVERY: Final = LESS | EQUAL | MORE | NONE
ALLOWED: Final = {
    "lt": LESS,
    "le": LESS | EQUAL,
    "gt": MORE,
    "ge": MORE | EQUAL,
    "eq": EQUAL,
    "ne": EVERY ^ EQUAL,
}
ZERO: Final = Number(0.0)


@final
@dataclass(frozen=True, slots=True)
class Atom:
    """The relation of `left` to `right` is one of `allowed`."""

    left: Expr
    right: Expr
    allowed: int

    @property
    def key(self) -> tuple[str, str]:
        """What is compared, as text."""
        return to_postfix(self.left), to_postfix(self.right)


@final
@dataclass(frozen=True, slots=True)
class All:
    """All parts hold."""

    parts: tuple["Formula", ...]


@final
@dataclass(frozen=True, slots=True)
class Some:
    """At least one part holds."""

    parts: tuple["Formula", ...]


Formula: TypeAlias = bool | Atom | All | Some


def both(parts: Iterable[Formula]) -> Formula:
    """All of them, without what is plain."""
    return _joined(parts, All, plain=True)


def either(parts: Iterable[Formula]) -> Formula:
    """At least one of them, without what is plain."""
    return _joined(parts, Some, plain=False)


def _joined(parts: Iterable[Formula], join: type[All | Some], *, plain: bool) -> Formula:
    """The parts in one level; plain: what a part adds nothing by being. Its opposite is all."""
    kept: list[Formula] = []
    for part in parts:
        if isinstance(part, bool):
            if part != plain:
                return part
        elif isinstance(part, join):
            kept.extend(part.parts)
        else:
            kept.append(part)
    return kept[0] if len(kept) == 1 else join(tuple(kept)) if kept else plain


def denied(formula: Formula) -> Formula:
    """Where it does not hold."""
    match formula:
        case bool():
            return not formula
        case Atom():
            return Atom(formula.left, formula.right, EVERY ^ formula.allowed)
        case All(parts=parts):
            return either(map(denied, parts))
        case Some(parts=parts):
            return both(map(denied, parts))


def truth(expr: Expr) -> Formula:  # noqa: PLR0911  # one for each way of being true
    """Where an expression is true: not 0 (nan is true)."""
    match expr:
        case Number(value=value):
            return value != 0
        case Apply(op="and", operands=(a, b)):
            return both((truth(a), truth(b)))
        case Apply(op="or", operands=(a, b)):
            return either((truth(a), truth(b)))
        case Apply(op="not", operands=(a,)):
            return denied(truth(a))
        case Apply(op="where", operands=(c, a, b)):
            condition = truth(c)
            chosen = both((condition, truth(a))), both((denied(condition), truth(b)))
            return either(chosen)
        case Apply(op=op, operands=(a, b)) if op in COMPARISONS:
            return compared(a, b, ALLOWED[op])
    return compared(expr, ZERO, EVERY ^ EQUAL)


def compared(left: Expr, right: Expr, allowed: int) -> Formula:
    """A comparison; plain where both sides are numbers, or the same number always."""
    if isinstance(left, Number) and isinstance(right, Number):
        return bool(relation(left.value, right.value) & allowed)
    for one, other, among in ((left, right, allowed), (right, left, mirrored(allowed))):
        cases = _cases(one)
        if cases:
            return either(
                both((where, compared(value, other, among) if value else bool(among & NONE)))
                for where, value in cases
            )
    if same(left, right) and not allowed & EQUAL:
        return Atom(left, right, allowed & NONE) if allowed & NONE else False
    if isinstance(left, Number) or (
        not isinstance(right, Number) and to_postfix(left) > to_postfix(right)
    ):
        return Atom(right, left, mirrored(allowed))
    return Atom(left, right, allowed)


def _cases(expr: Expr) -> list[tuple[Formula, Expr | None]]:
    """What picks one of its operands, as what it is where; None for no number. Else nothing."""
    match expr:
        case Apply(op="where", operands=(c, a, b)):
            return [(truth(c), a), (denied(truth(c)), b)]
        case Apply(op="min", operands=(a, b)):
            return _picked(a, b, LESS | EQUAL)
        case Apply(op="max", operands=(a, b)):
            return _picked(a, b, MORE | EQUAL)
        case Apply(op="clip", operands=(a, low, high)):
            return _cases(Apply("min", (Apply("max", (a, low)), high)))
        case Apply(op="abs", operands=(a,)):
            sign = [compared(a, ZERO, allowed) for allowed in (MORE | EQUAL, LESS, NONE)]
            return [(sign[0], a), (sign[1], Apply("neg", (a,))), (sign[2], None)]
    return []


def _picked(a: Expr, b: Expr, first: int) -> list[tuple[Formula, Expr | None]]:
    """The first of two where its relation to the second is one of `first`."""
    second = EVERY ^ NONE ^ first
    return [
        (compared(a, b, first), a),
        (compared(a, b, second), b),
        (compared(a, b, NONE), None),
    ]


def mirrored(allowed: int) -> int:
    """The relations of right to left."""
    return (
        (allowed & (EQUAL | NONE))
        | (MORE if allowed & LESS else 0)
        | (LESS if allowed & MORE else 0)
    )


def relation(a: float, b: float) -> int:
    """How two numbers compare."""
    if a < b:
        return LESS
    return EQUAL if a == b else MORE if a > b else NONE


def holds(formula: Formula, values: Mapping[str, float]) -> bool:
    """Whether it holds where the names have `values`, as the machine works it out."""
    match formula:
        case bool():
            return formula
        case Atom(left=left, right=right, allowed=allowed):
            return bool(relation(evaluate(left, values), evaluate(right, values)) & allowed)
        case All(parts=parts):
            return all(holds(part, values) for part in parts)
        case Some(parts=parts):
            return any(holds(part, values) for part in parts)
