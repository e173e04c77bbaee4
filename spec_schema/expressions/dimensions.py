"""Whether an expression adds metres to metres: dimensions from the leaves to the root.

A literal is dimensionless, but 0 fits any dimension. What is unknown (a name without dimension,
a 0, what stands above a fault) is None, and None agrees with everything: one mistake, one fault.
"""

import operator
from collections.abc import Callable, Mapping
from fractions import Fraction

from spec_schema.dimension import (
    DIMENSIONLESS,
    Dimension,
    describe,
    power,
    product,
    quotient,
)
from spec_schema.expressions.tree import COMPARISONS, Apply, Expr, Name, Number, fold
from spec_schema.faults import Fault

ALIKE = frozenset({"add", "sub", "mod", "min", "max", "clip", "hypot"})
"""Operations on quantities of one dimension, which their result has, too."""

PLAIN = frozenset(
    {"and", "or", "not", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan"}
    | {"sinh", "cosh", "tanh", "floor", "wrap"}
)
"""Operations on dimensionless numbers."""

EXACT: dict[str, Callable[..., Fraction]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
}
"""What may be written for an exponent, on fractions."""


def dimension_of(
    expr: Expr, names: Mapping[str, Dimension]
) -> tuple[Dimension | None, list[Fault]]:
    """The dimension where the names have those given, and every fault, in the text's order.

    None: unknown, or a 0 that fits any dimension.
    """
    faults: list[Fault] = []

    def visit(node: Expr, operands: tuple[Dimension | None, ...]) -> Dimension | None:
        match node:
            case Number(value=value):
                return None if value == 0 else DIMENSIONLESS
            case Name(name=name):
                return names.get(name)
            case Apply():
                result = _applied(node, operands)
                if isinstance(result, Fault):
                    faults.append(result)
                    return None
                return result
        return None

    return fold(expr, visit), sorted(faults)


def _applied(node: Apply, operands: tuple[Dimension | None, ...]) -> Dimension | Fault | None:
    op = node.op
    if op in ALIKE:
        return _alike(node, operands)
    if op in COMPARISONS or op == "atan2":
        return _alike(node, operands, result=DIMENSIONLESS)
    if op in PLAIN:
        return _plain(node, operands) or DIMENSIONLESS
    if op == "where":
        return _plain(node, operands[:1]) or _alike(node, operands[1:])
    if op == "sign":
        return DIMENSIONLESS
    return _scaled(node, operands)


def _scaled(node: Apply, operands: tuple[Dimension | None, ...]) -> Dimension | Fault | None:
    """What takes any dimension: products, powers, `neg`, `abs`."""
    first, second = operands[0], operands[-1]
    if node.op == "pow":
        return _power(node, first, second)
    if first is None or second is None:
        return None
    match node.op:
        case "mul":
            return product(first, second)
        case "div":
            return quotient(first, second)
        case "sqrt":
            return power(first, Fraction(1, 2))
    return first


def _power(
    node: Apply, base: Dimension | None, exponent: Dimension | None
) -> Dimension | Fault | None:
    unplain = _plain(node, (exponent,))
    if unplain or base is None or base == DIMENSIONLESS:
        return unplain or base
    number = _rational(node.operands[1])
    if number is not None:
        return power(base, number)
    message = f"the exponent of a quantity in {describe(base)} must be a number"
    advice = f"divide the base by a quantity in {describe(base)} first"
    return _fault(node, "S143", message, advice)


def _rational(expr: Expr) -> Fraction | None:
    """The exact value of an expression of numbers, as they are written; None for others."""

    def visit(node: Expr, operands: tuple[Fraction | None, ...]) -> Fraction | None:
        if isinstance(node, Number):
            return Fraction(repr(node.value))
        if not isinstance(node, Apply) or None in operands:
            return None
        numbers = [number for number in operands if number is not None]
        if node.op not in EXACT or (node.op == "div" and not numbers[1]):
            return None
        return EXACT[node.op](*numbers)

    return fold(expr, visit)


def _plain(node: Apply, operands: tuple[Dimension | None, ...]) -> Fault | None:
    """A fault where one of the operands has a dimension."""
    for dimension in operands:
        if dimension is not None and dimension != DIMENSIONLESS:
            what = NEEDS.get(node.op, f"{node.op} needs a number without unit")
            unit = describe(dimension)
            return _fault(node, "S142", f"{what}, got {unit}", f"divide it by a quantity in {unit}")
    return None


def _alike(
    node: Apply, operands: tuple[Dimension | None, ...], result: Dimension | None = None
) -> Dimension | Fault | None:
    """The dimension that the operands have in common (or `result`), or a fault."""
    common: Dimension | None = None
    for dimension in operands:
        if common is not None and dimension is not None and dimension != common:
            return _unlike(node, common, dimension)
        common = dimension if common is None else common
    return common if result is None else result


def _unlike(node: Apply, a: Dimension, b: Dimension) -> Fault:
    template = UNLIKE.get(node.op, "{op} needs quantities of one unit, got {a} and {b}")
    message = template.format(op=node.op, a=_named(a), b=_named(b))
    if DIMENSIONLESS in {a, b} and any(isinstance(part, Number) for part in node.operands):
        unit = describe(b if a == DIMENSIONLESS else a)
        advice = f"a literal has no unit: name it under constants, with unit {unit}"
    else:
        advice = f"they differ by a factor in {describe(quotient(a, b))}"
    return _fault(node, "S141", message, advice)


def _named(dimension: Dimension) -> str:
    return "a plain number" if dimension == DIMENSIONLESS else describe(dimension)


def _fault(node: Apply, code: str, message: str, advice: str) -> Fault:
    start, end = node.mark if node.mark != (0, 0) else (node.start, node.end)
    return Fault(start, end, code, message, advice)


UNLIKE: dict[str, str] = {
    "add": "can't add {a} and {b}",
    "sub": "can't subtract {b} from {a}",
    "mod": "can't divide {a} by {b} and keep the rest",
    "where": "where needs two values of one unit, got {a} and {b}",
    **dict.fromkeys(COMPARISONS, "can't compare {a} with {b}"),
}

NEEDS: dict[str, str] = {
    "where": "where needs a condition",
    "pow": "an exponent has no unit",
    **dict.fromkeys(("and", "or", "not"), "a condition has no unit"),
}
