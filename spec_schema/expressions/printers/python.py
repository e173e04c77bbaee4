"""Python source over numpy arrays, which numba compiles for scalars as well."""

from dataclasses import dataclass
from typing import final

from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.printers.piece import (
    ARITHMETIC,
    POWER,
    SIGN,
    SUM,
    TERM,
    Piece,
    call,
    joined,
    literal,
)
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name, Number, fold

FUNCTIONS: dict[str, str] = {
    "mod": "np.mod",
    "abs": "np.abs",
    "sign": "np.sign",
    "min": "np.minimum",
    "max": "np.maximum",
    "sqrt": "np.sqrt",
    "hypot": "np.hypot",
    "exp": "np.exp",
    "log": "np.log",
    "sin": "np.sin",
    "cos": "np.cos",
    "tan": "np.tan",
    "asin": "np.arcsin",
    "acos": "np.arccos",
    "atan": "np.arctan",
    "atan2": "np.arctan2",
    "sinh": "np.sinh",
    "cosh": "np.cosh",
    "tanh": "np.tanh",
    "floor": "np.floor",
    "pow": "np.power",
}

GREATEST_POWER = 64
"""A whole exponent up to this is written as an integer, which numba multiplies out."""


@final
@dataclass(frozen=True, slots=True)
class _Part:
    """A value, and the condition that it stands for (empty where it is no truth value)."""

    value: Piece
    condition: str = ""

    @property
    def holds(self) -> str:
        """A Python condition, elementwise: whether the value counts as true."""
        return self.condition or f"{self.value.inside(SUM)} != 0.0"


def to_python(expr: Expr) -> str:
    """The expression as source for numpy (as `np`), its literals exact, names as they are.

    Divisions by zero follow IEEE in numpy; under numba with `error_model="numpy"`.

    >>> from spec_schema.expressions.parse import parse
    >>> to_python(parse("where(x > 0 and y, -x**2/2, sin(1))"))
    'np.where((x > 0.0) & (y != 0.0), -x**2 / 2.0, np.sin(1.0))'
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
            return _Part(Piece(f"np.where({condition.holds}, {a.value.text}, {b.value.text})"))
        case Apply(op="pow", operands=(_, Number(value=n))) if _is_small_whole(n):
            base = operands[0].value.inside(POWER + 1)
            return _Part(Piece(f"{base}**{numeral(n)}", POWER))
        case Apply(op=op):
            truth = _condition(op, operands)
            if truth:
                return _Part(Piece(f"({truth}) * 1.0", TERM), truth)
            return _Part(_operation(op, tuple(part.value for part in operands)))
    raise AssertionError("texts are resolved before code is written")


def _is_small_whole(value: float) -> bool:
    return value.is_integer() and 0 < value <= GREATEST_POWER


def _condition(op: str, operands: tuple[_Part, ...]) -> str:
    if op in COMPARISONS:
        return f" {COMPARISONS[op]} ".join(part.value.inside(SUM) for part in operands)
    if op in {"and", "or"}:
        return (" & " if op == "and" else " | ").join(f"({part.holds})" for part in operands)
    # `~` on a plain bool would be a number, so the condition is compared instead.
    return f"({operands[0].holds}) == False" if op == "not" else ""


def _operation(op: str, operands: tuple[Piece, ...]) -> Piece:
    if op in ARITHMETIC:
        return joined(*ARITHMETIC[op], operands[0], operands[1])
    if op == "neg":
        return Piece(f"-{operands[0].inside(SIGN + 1)}", SIGN)
    if op == "clip":
        raised = call("np.maximum", operands[:2])
        return call("np.minimum", (raised, operands[2]))
    if op == "wrap":
        turned = call(
            "np.mod", (Piece(f"np.pi - {operands[0].inside(TERM)}"), Piece("2.0 * np.pi"))
        )
        return Piece(f"np.pi - {turned.text}", SUM)
    return call(FUNCTIONS[op], operands)
