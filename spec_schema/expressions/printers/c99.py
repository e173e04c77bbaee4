"""C99: an expression over doubles, for a file that includes math.h and has `C99_FUNCTIONS`."""

from dataclasses import dataclass
from typing import final

from spec_schema.expressions.printers.piece import (
    ARITHMETIC,
    SIGN,
    SUM,
    Piece,
    call,
    joined,
    literal,
)
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name, Number, fold

C99_FUNCTIONS = """\
static inline double specc_square(double x) { return x * x; }
static inline double specc_cube(double x) { return x * x * x; }
static inline double specc_fourth(double x) { return (x * x) * (x * x); }
static inline double specc_sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x * 0.0; }
static inline double specc_min(double x, double y) { return x < y || x != x ? x : y; }
static inline double specc_max(double x, double y) { return x > y || x != x ? x : y; }
static inline double specc_clip(double x, double low, double high)
{
    return specc_min(specc_max(x, low), high);
}
static inline double specc_mod(double x, double y)
{
    double rest = fmod(x, y);
    return rest != 0.0 && (rest < 0.0) != (y < 0.0) ? rest + y : rest;
}
static inline double specc_wrap(double x)
{
    double rest = remainder(x, 6.283185307179586);
    return rest <= -3.141592653589793 ? 3.141592653589793 : rest;
}
"""
"""What C's library lacks, with the meaning of `tree.py`."""

FUNCTIONS: dict[str, str] = {
    "abs": "fabs",
    "sign": "specc_sign",
    "min": "specc_min",
    "max": "specc_max",
    "clip": "specc_clip",
    "mod": "specc_mod",
    "wrap": "specc_wrap",
}
"""The functions that C knows by another name."""

POWERS: dict[float, str] = {2.0: "specc_square", 3.0: "specc_cube", 4.0: "specc_fourth"}


@final
@dataclass(frozen=True, slots=True)
class _Part:
    """A value, and the condition that it stands for (empty where it is no truth value)."""

    value: Piece
    condition: str = ""

    @property
    def holds(self) -> str:
        """A C condition: whether the value counts as true."""
        return self.condition or f"{self.value.inside(SIGN)} != 0.0"


def to_c99(expr: Expr) -> str:
    """The expression in C, its literals exact; names stand as they are (`substitute` others).

    >>> from spec_schema.expressions.parse import parse
    >>> to_c99(parse("where(x > 0, -x**2/2, 1)"))
    '(x > 0.0 ? -specc_square(x) / 2.0 : 1.0)'
    """
    return fold(expr, _part).value.text


def _part(node: Expr, operands: tuple[_Part, ...]) -> _Part:
    match node:
        case Number(value=value):
            return _Part(literal(value))
        case Name(name=name):
            return _Part(Piece(name))
        case Apply(op="where"):
            condition, a, b = operands
            return _Part(Piece(f"({condition.holds} ? {a.value.text} : {b.value.text})"))
        case Apply(op="pow", operands=(_, Number(value=n))) if n in POWERS:
            return _Part(call(POWERS[n], (operands[0].value,)))
        case Apply(op=op):
            truth = _condition(op, operands)
            if truth:
                return _Part(Piece(f"(double)({truth})", SIGN), truth)
            return _Part(_operation(op, tuple(part.value for part in operands)))
    raise AssertionError("texts are resolved before code is written")


def _condition(op: str, operands: tuple[_Part, ...]) -> str:
    if op in COMPARISONS:
        return f" {COMPARISONS[op]} ".join(part.value.inside(SUM) for part in operands)
    if op in {"and", "or"}:
        return (" && " if op == "and" else " || ").join(f"({part.holds})" for part in operands)
    return f"!({operands[0].holds})" if op == "not" else ""


def _operation(op: str, operands: tuple[Piece, ...]) -> Piece:
    if op in ARITHMETIC:
        return joined(*ARITHMETIC[op], operands[0], operands[1])
    if op == "neg":
        return Piece(f"-{operands[0].inside(SIGN + 1)}", SIGN)
    return call(FUNCTIONS.get(op, op), operands)
