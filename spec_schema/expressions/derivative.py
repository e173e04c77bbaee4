"""The derivative of an expression by the chain rule, piece by piece where it has pieces.

Where a function has a corner or a jump the derivative is that of a piece beside it: `abs` gives
sign(x), so 0 at 0; `min`, `max`, `clip` and `where` that of the chosen operand; `sign`, `floor`,
comparisons and logic give 0; `wrap(x)` and `x % c` that of x. So it is the derivative almost
everywhere, and says nothing of a jump.
"""

from collections.abc import Callable
from typing import TypeAlias

from spec_schema.expressions.algebra import ONE, ZERO, build, is_number
from spec_schema.expressions.tree import Apply, Expr, Name, Number, fold

Rule: TypeAlias = Callable[..., Expr]

TWO = Number(2.0)


def derivative(expr: Expr, name: str) -> Expr:
    """The derivative with respect to `name`, lightly simplified; texts must be resolved.

    >>> from spec_schema.expressions.parse import parse
    >>> from spec_schema.expressions.printers.text import to_text
    >>> to_text(derivative(parse("x**2*sin(x)"), "x"))
    '2*(x*sin(x)) + x**2*cos(x)'
    """

    def visit(node: Expr, rates: tuple[Expr, ...]) -> Expr:
        if isinstance(node, Name):
            return ONE if node.name == name else ZERO
        if not isinstance(node, Apply) or all(is_number(rate, 0.0) for rate in rates):
            return ZERO
        return RULES[node.op](node, *rates)

    return fold(expr, visit)


def _one(outer: Callable[[Expr], Expr]) -> Rule:
    """The chain rule of a function of one operand."""
    return lambda node, rate: build("mul", outer(node.operands[0]), rate)


def _product(node: Apply, da: Expr, db: Expr) -> Expr:
    a, b = node.operands
    return build("add", build("mul", da, b), build("mul", a, db))


def _quotient(node: Apply, da: Expr, db: Expr) -> Expr:
    # (da - (a/b)*db)/b: b**2 would overflow and underflow earlier than a/b does.
    b = node.operands[1]
    return build("div", build("sub", da, build("mul", node, db)), b)


def _modulo(node: Apply, da: Expr, db: Expr) -> Expr:
    turns = build("floor", build("div", *node.operands))
    return build("sub", da, build("mul", turns, db))


def _power(node: Apply, da: Expr, db: Expr) -> Expr:
    a, b = node.operands
    lower = build("pow", a, build("sub", b, ONE))
    by_base = build("mul", build("mul", b, lower), da)
    if is_number(db, 0.0):
        return by_base
    by_exponent = build("mul", build("mul", node, build("log", a)), db)
    return by_exponent if is_number(da, 0.0) else build("add", by_base, by_exponent)


def _hypot(node: Apply, da: Expr, db: Expr) -> Expr:
    a, b = node.operands
    return build("div", build("add", build("mul", a, da), build("mul", b, db)), node)


def _angle(node: Apply, dy: Expr, dx: Expr) -> Expr:
    y, x = node.operands
    turning = build("sub", build("mul", x, dy), build("mul", y, dx))
    return build("div", turning, build("add", _square(x), _square(y)))


def _clip(node: Apply, da: Expr, dlow: Expr, dhigh: Expr) -> Expr:
    a, low, high = node.operands
    inner = build("where", build("lt", a, low), dlow, da)
    raised = build("max", a, low)
    return build("where", build("gt", raised, high), dhigh, inner)


def _chosen(comparison: str) -> Rule:
    def rule(node: Apply, da: Expr, db: Expr) -> Expr:
        return build("where", build(comparison, *node.operands), da, db)

    return rule


def _where(node: Apply, _: Expr, da: Expr, db: Expr) -> Expr:
    return build("where", node.operands[0], da, db)


def _square(a: Expr) -> Expr:
    return build("pow", a, TWO)


def _root_of_rest(a: Expr) -> Expr:
    return build("sqrt", build("sub", ONE, _square(a)))


def _flat(*_: Expr) -> Expr:
    return ZERO


RULES: dict[str, Rule] = {
    "add": lambda _, da, db: build("add", da, db),
    "sub": lambda _, da, db: build("sub", da, db),
    "neg": lambda _, da: build("neg", da),
    "mul": _product,
    "div": _quotient,
    "mod": _modulo,
    "pow": _power,
    "hypot": _hypot,
    "atan2": _angle,
    "min": _chosen("lt"),
    "max": _chosen("gt"),
    "clip": _clip,
    "where": _where,
    "wrap": lambda _, da: da,
    "abs": _one(lambda a: build("sign", a)),
    "sqrt": lambda node, da: build("div", da, build("mul", TWO, node)),
    "exp": lambda node, da: build("mul", node, da),
    "log": lambda node, da: build("div", da, node.operands[0]),
    "sin": _one(lambda a: build("cos", a)),
    "cos": _one(lambda a: build("neg", build("sin", a))),
    "tan": _one(lambda a: build("add", ONE, _square(build("tan", a)))),
    "asin": lambda node, da: build("div", da, _root_of_rest(node.operands[0])),
    "acos": lambda node, da: build("neg", build("div", da, _root_of_rest(node.operands[0]))),
    "atan": lambda node, da: build("div", da, build("add", ONE, _square(node.operands[0]))),
    "sinh": _one(lambda a: build("cosh", a)),
    "cosh": _one(lambda a: build("sinh", a)),
    "tanh": _one(lambda a: build("sub", ONE, _square(build("tanh", a)))),
    **dict.fromkeys(("sign", "floor", "and", "or", "not"), _flat),
    **dict.fromkeys(("lt", "le", "gt", "ge", "eq", "ne"), _flat),
}
"""The derivative of each operation from the node and the derivatives of its operands."""
